//! Everything that reads a file, given files that are nearly right: an error or a value, never a panic, a hang or memory
//! beyond what the file bears out. The mutations are seeded; `READERS_SEED` and `READERS_COUNT` give other and more.

use std::alloc::{GlobalAlloc, Layout, System};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

use contact_afu::link::{Description, Link, LinkModel};
use contact_afu::scene::{Plan, Scene};
use contact_afu::{config, pairs};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Bytes in use, and the most since it was last set to them.
struct Counted;
static USED: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: passes everything on to the system's allocator.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let used = USED.fetch_add(layout.size(), Relaxed) + layout.size();
        MOST.fetch_max(used, Relaxed);
        // SAFETY: as the caller says.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        USED.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as the caller says.
        unsafe { System.dealloc(place, layout) }
    }
}

#[global_allocator]
static COUNTED: Counted = Counted;

/// A kind of file: its name, something right in it, and what reads it; true if it is accepted.
struct Kind {
    name: &'static str,
    seeds: Vec<Vec<u8>>,
    read: fn(&Path) -> bool,
}

fn link(path: &Path) -> bool {
    let Ok(text) = fs::read_to_string(path) else { return false };
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let Ok(described) = Description::parse(name, &text) else { return false };
    [1.0, 200.0, 1e6].into_iter().filter_map(|mhz| described.at(mhz).ok()).all(|model| Link::new(model, 1).is_ok())
}

fn kinds() -> Vec<Kind> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let room = tempfile::tempdir().unwrap();
    let some = pairs::load("random:6", 3).unwrap();
    let written = |name: &str, write: &dyn Fn(&Path)| {
        let path = room.path().join(name);
        write(&path);
        fs::read(path).unwrap()
    };
    let contacts: Vec<_> = some.iter().map(|pair| contact_afu::kernel::ContactRecord(pair.0)).collect();
    let file = |name: &str| fs::read(root.join(name)).unwrap();
    let models = [LinkModel::hostile(), LinkModel::late()].iter().map(|m| serde_json::to_vec(m).unwrap()).collect();
    vec![
        Kind {
            name: "pairs.csv",
            seeds: vec![written("a.csv", &|path| pairs::write_pairs(path, &some).unwrap())],
            read: |path| pairs::read_pairs(path).is_ok(),
        },
        Kind {
            name: "pairs.npy",
            seeds: vec![written("a.npy", &|path| pairs::write_pairs(path, &some).unwrap())],
            read: |path| pairs::read_pairs(path).is_ok(),
        },
        Kind {
            name: "contacts.csv",
            seeds: vec![written("c.csv", &|path| {
                let real = contact_afu::kernel::Reference::new(
                    config::Config::default().profile.format(),
                    config::Config::default().contact,
                );
                pairs::write_contacts(path, &real.run_all(&some)).unwrap();
            })],
            read: |path| pairs::read_contacts(path).is_ok(),
        },
        Kind {
            name: "contacts.npy",
            seeds: vec![written("c.npy", &|path| pairs::write_contacts(path, &contacts).unwrap())],
            read: |path| pairs::read_contacts(path).is_ok(),
        },
        Kind {
            name: "scene.toml",
            seeds: ["diamond", "billiards", "column", "touching", "gas"]
                .map(|name| file(&format!("examples/scenes/{name}.toml")))
                .to_vec(),
            read: |path| Scene::read(path).is_ok_and(|scene| Plan::of(&scene).is_ok()),
        },
        Kind { name: "manifest.json", seeds: vec![file("rtl/manifest.json")], read: |path| config::read(path).is_ok() },
        Kind { name: "link.json", seeds: models, read: link },
        Kind {
            name: "link.toml",
            seeds: vec![file("src/link/presets/harp1.toml"), file("examples/links/lossy.toml")],
            read: link,
        },
    ]
}

/// What breaks readers: the ends of ranges, nesting, other types, what is no text.
const WORDS: [&[u8]; 24] = [
    b"-1",
    b"0",
    b"1e400",
    b"-1e-400",
    b"nan",
    b"inf",
    b"18446744073709551616",
    b"4294967295",
    b"\"",
    b"\n",
    b"\r\n",
    b",",
    b"[",
    b"{",
    b"}",
    b"]",
    b"null",
    b"true",
    b"\xff\xfe",
    b"\0",
    b"(9223372036854775807, 8)",
    b"\xef\xbb\xbf",
    b"1.7976931348623157e308",
    b"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
];

/// One to four changes: bytes, words, numbers replaced, pieces cut, doubled or moved.
fn mutated(seed: &[u8], random: &mut Xoshiro256PlusPlus) -> Vec<u8> {
    let mut text = seed.to_vec();
    for _ in 0..random.random_range(1..5) {
        let at = random.random_range(0..=text.len());
        let end = (at + random.random_range(0..40)).min(text.len());
        let word = WORDS[random.random_range(0..WORDS.len())];
        match random.random_range(0..7) {
            0 if at < text.len() => text[at] ^= 1 << random.random_range(0..8),
            1 => text.truncate(at),
            2 => drop(text.splice(at..at, word.iter().copied())),
            3 => drop(text.splice(at..end, word.iter().copied())),
            4 => drop(text.drain(at..end)),
            5 => {
                let piece = text[at..end].repeat(random.random_range(1..20));
                text.splice(at..at, piece);
            }
            _ => {
                // The next number, whatever it is, becomes another word.
                let is_digit = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-');
                if let Some(begin) = text[at..].iter().position(is_digit).map(|begin| at + begin) {
                    let end = begin + text[begin..].iter().take_while(|byte| is_digit(byte)).count();
                    text.splice(begin..end, word.iter().copied());
                }
            }
        }
    }
    text
}

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name}: a number")))
}

#[test]
fn no_file_makes_a_reader_panic_hang_or_take_memory() {
    let (seed, count) = (setting("READERS_SEED", 1), setting("READERS_COUNT", 1_500));
    let room = tempfile::tempdir().unwrap();
    for kind in kinds() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let path = room.path().join(kind.name);
        let mut accepted = 0;
        let inputs = (0..count).map(|_| {
            let seed = &kind.seeds[random.random_range(0..kind.seeds.len())];
            mutated(seed, &mut random)
        });
        for (number, input) in kind.seeds.iter().cloned().chain(inputs).enumerate() {
            fs::write(&path, &input).unwrap();
            let (before, began) = (USED.load(Relaxed), Instant::now());
            MOST.store(before, Relaxed);
            let good = std::panic::catch_unwind(|| (kind.read)(&path));
            let (took, bytes) = (began.elapsed(), MOST.load(Relaxed).saturating_sub(before));
            let what = || {
                let kept = std::env::temp_dir().join(kind.name);
                let _ = fs::write(&kept, &input);
                format!("{} {number} of READERS_SEED={seed}, kept as {}", kind.name, kept.display())
            };
            assert!(good.is_ok(), "panic: {}", what());
            assert!(number >= kind.seeds.len() || matches!(good, Ok(true)), "right, but refused: {}", what());
            assert!(bytes < 100 * input.len() + (1 << 20), "{bytes} bytes for {}: {}", input.len(), what());
            assert!(took < Duration::from_secs(5), "{took:?}: {}", what());
            accepted += u64::from(matches!(good, Ok(true)));
        }
        assert!(accepted > 0 && accepted < count, "{}: {accepted} of {count} accepted", kind.name);
    }
}

/// A file that declares more than it holds: an error, and no memory for what is not there.
#[test]
fn declared_sizes_are_not_believed() {
    let room = tempfile::tempdir().unwrap();
    let path = room.path().join("huge.npy");
    let mut tried = 0;
    for rows in ["1", "3", "4294967295", "1152921504606846976", "2305843009213693952", "18446744073709551615", "-1"] {
        for (kind, columns) in [("<f4", 8), ("<u4", 8), ("<u4", 9)] {
            let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({rows}, {columns}), }}\n");
            for declared in [header.len(), 65_535] {
                let mut text = b"\x93NUMPY\x01\x00".to_vec();
                text.extend((declared as u16).to_le_bytes());
                text.extend(header.bytes().chain([0; 64]));
                fs::write(&path, &text).unwrap();
                for read in
                    [|path: &Path| pairs::read_pairs(path).is_ok(), |path: &Path| pairs::read_contacts(path).is_ok()]
                {
                    let before = USED.load(Relaxed);
                    MOST.store(before, Relaxed);
                    let accepted = read(&path);
                    let bytes = MOST.load(Relaxed).saturating_sub(before);
                    assert!(!accepted && bytes < 1 << 20, "{rows} rows of {kind}: accepted {accepted}, {bytes} bytes");
                    tried += 1;
                }
            }
        }
    }
    assert_eq!(tried, 7 * 3 * 2 * 2);
    // The same header with what it declares is right.
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 8), }\n";
    let length = (header.len() as u16).to_le_bytes();
    fs::write(&path, [&b"\x93NUMPY\x01\x00"[..], &length[..], header.as_bytes(), &[0; 64][..]].concat()).unwrap();
    assert_eq!(pairs::read_pairs(&path).unwrap().len(), 2);
}
