//! Runs every reader on files that are nearly right. It must return an error or a value, and never panic, hang or use
//! more memory than the file justifies. The mutations are seeded; `READERS_SEED` and `READERS_COUNT` (per kind) change
//! their seed and number.
#![cfg(feature = "cosim")]

mod kinds;
mod mutate;

use contact_afu::query::Query;
use std::alloc::{GlobalAlloc, Layout, System};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

use contact_afu::pairs;
use kinds::kinds;
use mutate::mutated;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// An allocator that counts the bytes in use and their peak.
struct Counted;
static USED: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: passes all calls on to the system's allocator.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let used = USED.fetch_add(layout.size(), Relaxed) + layout.size();
        MOST.fetch_max(used, Relaxed);
        // SAFETY: guaranteed by the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        USED.fetch_sub(layout.size(), Relaxed);
        // SAFETY: guaranteed by the caller.
        unsafe { System.dealloc(place, layout) }
    }
}

#[global_allocator]
static COUNTED: Counted = Counted;

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name}: a number")))
}

#[test]
fn no_file_makes_a_reader_panic_hang_or_take_memory() {
    let (seed, count) = (setting("READERS_SEED", 1), setting("READERS_COUNT", 1_000));
    let room = tempfile::tempdir().unwrap();
    let mut files = 0;
    for kind in kinds(room.path()) {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let path = room.path().join(kind.name);
        let mut accepted = 0;
        let inputs = (0..count).map(|_| {
            let seed = &kind.seeds[random.random_range(0..kind.seeds.len())];
            mutated(kind.form, seed, &mut random)
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
        files += count;
        println!("{}: {accepted} of {count} accepted", kind.name);
    }
    println!("{files} files");
}

/// A file that declares more than it contains gives an error, without memory being allocated for the missing data.
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
                for read in [
                    |path: &Path| pairs::read_pairs(Query::SphereSphere, path).is_ok(),
                    |path: &Path| pairs::read_contacts(path).is_ok(),
                ] {
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
    // The same header with the actual shape is accepted.
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 8), }\n";
    let length = (header.len() as u16).to_le_bytes();
    fs::write(&path, [&b"\x93NUMPY\x01\x00"[..], &length[..], header.as_bytes(), &[0; 64][..]].concat()).unwrap();
    assert_eq!(pairs::read_pairs(Query::SphereSphere, &path).unwrap().len(), 2);
}
