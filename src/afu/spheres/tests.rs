//! The core as a whole, cycle by cycle, against the search in software.

use std::collections::VecDeque;

use super::super::{Afu, Spec};
use crate::config::{Config, Input, Results, Search as Sizes, Shell};
use crate::hdl::Evaluator;
use crate::query::{ContactRecord, Fields};
use crate::record::{Contacts, Layout, Line};
use crate::spheres::{Search, Sphere, SphereSet, Spheres, hilbert_order, reorder};

fn config(search: Sizes) -> Config {
    Config {
        input: Input::Spheres,
        results: Results::Hits,
        contact: Fields::HIT,
        shell: Shell::Line,
        search,
        ..Config::default()
    }
}

/// What a job gave.
#[derive(Debug, Default, PartialEq, Eq)]
struct Outcome {
    hits: Vec<[u32; 2]>,
    /// The contacts, as far as the configuration has them.
    contacts: Vec<ContactRecord>,
    candidates: u64,
    invalid: u64,
    first_invalid: u32,
    error: u128,
}

/// The cycle in which a job is stopped.
#[derive(Clone, Copy, Debug)]
enum Stop {
    Abort(u64),
    Reset(u64),
}

/// A core with memory at its line port: lines are answered after a few cycles.
struct Bench {
    unit: Evaluator,
    layout: Layout,
    epoch: u128,
    /// Stages, and the cycles in which each had something to do and no room for it.
    waits: Vec<(&'static str, u64)>,
    /// Of so many cycles the memory takes a write in one.
    write_pace: u64,
}

impl Bench {
    fn new(config: &Config) -> Self {
        let afu = Afu::generate(Spec::from(config.clone())).expect("an AFU");
        let unit = Evaluator::new(afu.top(), &[]).expect("an evaluator");
        Self { unit, layout: afu.layout(), epoch: 0, waits: Vec::new(), write_pace: 1 }
    }

    fn run(&mut self, mode: u128, first: &[Sphere], second: &[Sphere]) -> Outcome {
        self.run_until(mode, first, second, None)
    }

    /// As `run`, but stopped.
    fn run_until(&mut self, mode: u128, first: &[Sphere], second: &[Sphere], stop: Option<Stop>) -> Outcome {
        let mut lines: Vec<[u64; 8]> = Vec::new();
        let sets = if mode == 2 {
            vec![second]
        } else if mode == 1 {
            vec![first, second]
        } else {
            vec![first]
        };
        for set in sets {
            for row in set.chunks(16) {
                let mut words = vec![0_u64; 32];
                for (place, sphere) in row.iter().enumerate() {
                    words[2 * place] = u64::from(sphere.0[0]) | u64::from(sphere.0[1]) << 32;
                    words[2 * place + 1] = u64::from(sphere.0[2]) | u64::from(sphere.0[3]) << 32;
                }
                lines.extend(words.chunks(8).map(|line| <[u64; 8]>::try_from(line).expect("a line")));
            }
        }
        let unit = &mut self.unit;
        self.epoch = (self.epoch + 1) % 16;
        for (port, value) in [("count", first.len() as u128), ("others", second.len() as u128), ("mode", mode)] {
            unit.set(port, value);
        }
        unit.set("destination_lines", 1 << 20);
        unit.set("destination", 1 << 20);
        unit.set("epoch", self.epoch);
        unit.set("rd_req_ready", 1);
        unit.set("start", 1);
        unit.step();
        unit.set("start", 0);
        let mut reads: VecDeque<(u64, u128, u128)> = VecDeque::new();
        let mut acknowledged: VecDeque<(u64, u128)> = VecDeque::new();
        let mut written = Vec::new();
        let mut cycles = 0;
        while unit.get("done") == 0 {
            match stop {
                Some(Stop::Reset(cycle)) if cycle == cycles => {
                    unit.reset();
                    return Outcome::default();
                }
                Some(Stop::Abort(cycle)) if cycle == cycles => unit.set("abort_job", 1),
                _ => {}
            }
            let takes_write = cycles % self.write_pace == 0;
            unit.set("wr_req_ready", takes_write.into());
            let response = reads.front().filter(|(due, ..)| *due <= cycles).copied();
            unit.set("rd_rsp_valid", response.is_some().into());
            if let Some((_, address, tag)) = response {
                reads.pop_front();
                unit.set("rd_rsp_tag", tag);
                unit.set_words("rd_rsp_data", &lines[address as usize]);
            }
            let response = acknowledged.front().filter(|(due, _)| *due <= cycles).copied();
            unit.set("wr_rsp_valid", response.is_some().into());
            if let Some((_, tag)) = response {
                acknowledged.pop_front();
                unit.set("wr_rsp_tag", tag);
            }
            if unit.get("rd_req_valid") == 1 {
                reads.push_back((cycles + 20, unit.get("rd_req_address"), unit.get("rd_req_tag")));
            }
            if unit.get("wr_req_valid") == 1 && takes_write {
                assert_eq!(unit.get("wr_req_address"), (1 << 20) + written.len() as u128);
                written.push(unit.get_words("wr_req_data"));
                acknowledged.push_back((cycles + 5, unit.get("wr_req_tag")));
            }
            for (stage, cycles) in &mut self.waits {
                let mut is = |what: &str| {
                    let pin = unit.probe(&format!("{stage}.{what}")).expect("a name in the stage");
                    unit.read(pin) == 1
                };
                *cycles += u64::from(is("active") && !is("steps"));
            }
            unit.step();
            cycles += 1;
            assert!(cycles < 3_000_000, "the job hangs");
        }
        unit.set("abort_job", 0);
        let contacts = unit.get("contacts") as usize;
        let error = unit.get("error");
        if error != 0 {
            let counts = ["contacts", "candidates", "invalid", "first_invalid"];
            let told = counts.map(|port| unit.get(port));
            (0..100).for_each(|_| unit.step());
            assert_eq!(counts.map(|port| unit.get(port)), told, "a job that has ended counts nothing");
            return Outcome { error, ..Outcome::default() };
        }
        let line = |words: &Vec<u64>| -> Option<Line> {
            Some(std::array::from_fn(|place| (words[place / 2] >> (32 * (place % 2))) as u32))
        };
        let lines: Vec<_> = written.iter().map(line).collect();
        assert_eq!(lines.len() as u64, self.layout.destination_lines(contacts as u64));
        let stored = Contacts::new(&self.layout, &lines);
        assert!(stored.rest_is_zero(contacts), "a last line ends with zeros");
        let (numbers, contacts): (Vec<_>, Vec<_>) = (0..contacts).map(|hit| stored.hit(hit).expect("a hit")).unzip();
        Outcome {
            hits: numbers.into_iter().map(|numbers| [numbers & 0xFFFF, numbers >> 16]).collect(),
            contacts,
            candidates: unit.get("candidates") as u64,
            invalid: unit.get("invalid") as u64,
            first_invalid: unit.get("first_invalid") as u32,
            error,
        }
    }
}

/// What the software finds.
fn expected(config: &Config, first: &[Sphere], second: Option<&[Sphere]>) -> Outcome {
    let search = Search::new(config.profile.arithmetic(), config.search.box_bits).expect("a search");
    let found = search.find(&mut config.profile.reference(config.contact), first, second).expect("found");
    let layout = Spec::from(config.clone()).layout();
    let all = first.iter().chain(second.unwrap_or_default());
    let invalid = all.clone().position(|sphere| !sphere.is_valid());
    Outcome {
        hits: found.hits.iter().map(|hit| hit.spheres).collect(),
        contacts: found.hits.iter().map(|hit| Contacts::new(&layout, &[]).as_stored(hit.contact)).collect(),
        candidates: found.counts.candidates,
        invalid: found.counts.invalid,
        first_invalid: invalid.map_or(u32::MAX, |place| place as u32),
        error: 0,
    }
}

fn check(bench: &mut Bench, config: &Config, first: &[Sphere], second: Option<&[Sphere]>) {
    let got = bench.run(second.is_some().into(), first, second.unwrap_or_default());
    let want = expected(config, first, second);
    let differs = got.hits.iter().zip(&want.hits).position(|(got, want)| got != want);
    assert_eq!((got.hits.len(), differs), (want.hits.len(), None), "the first hit that differs");
    let differs = got.contacts.iter().zip(&want.contacts).position(|(got, want)| got != want);
    let both = differs.map(|hit| (hit, want.hits[hit], got.contacts[hit], want.contacts[hit]));
    assert_eq!(both, None, "the first contact that differs, of contact {}", config.contact);
    assert_eq!(got, want);
}

fn sorted(spheres: Spheres) -> Spheres {
    let sort = |set: Vec<Sphere>| reorder(&set, &hilbert_order(&set));
    Spheres { first: sort(spheres.first), second: spheres.second.map(sort) }
}

#[test]
fn a_set_is_searched_as_the_software_does() {
    for (lanes, deciders) in [(16, 4), (16, 1), (32, 16), (64, 8), (256, 2)] {
        let config = config(Sizes { table: 2048, lanes, deciders, ..Sizes::default() });
        let mut bench = Bench::new(&config);
        let diamond = sorted(SphereSet::Diamond(10).spheres(1)).first;
        check(&mut bench, &config, &diamond, None);
        let gas = SphereSet::Gas(900, 200).spheres(2).first;
        check(&mut bench, &config, &gas, None);
    }
}

/// Contacts beside the numbers: with SCPUs for one per cycle, for fewer, and for those that share operators.
#[test]
fn contacts_are_resolved_in_the_order_of_their_hits() {
    for (contact, lanes, deciders, scpus, interval) in [
        ("hit,depth,normal,position", 16, 4, 1, 1),
        ("depth", 64, 2, 10, 3),
        ("normal", 16, 1, 1, 4),
        ("depth", 32, 4, 2, 2),
        ("hit,depth,normal,position", 256, 16, 2, 5),
        // Two and four side by side; of these SCPUs two, and one, are not built.
        ("hit,depth,normal,position", 16, 4, 2, 1),
        ("depth,normal", 128, 8, 12, 5),
        ("depth", 64, 8, 5, 1),
    ] {
        let config = Config {
            contact: contact.parse().expect("fields"),
            scpus,
            interval,
            ..config(Sizes { table: 512, lanes, deciders, ..Sizes::default() })
        };
        let mut bench = Bench::new(&config);
        for pace in [1, 9] {
            bench.write_pace = pace;
            check(&mut bench, &config, &odd(300, 1), None);
            // Every pair touches, and half of the centres coincide.
            check(&mut bench, &config, &[Sphere::new([1.0, 2.0, 3.0, 0.5]); 40], None);
            check(&mut bench, &config, &odd(200, 2), Some(&odd(150, 3)));
        }
        // What a job leaves behind when it is stopped does not come out in the next one.
        for cycle in (0..900).step_by(97) {
            bench.run_until(0, &odd(200, 4), &[], Some(Stop::Abort(cycle)));
            check(&mut bench, &config, &odd(60, 5), None);
        }
    }
}

/// Spheres at random, some of them invalid, some infinite in size, some in one place.
fn odd(count: usize, seed: u64) -> Vec<Sphere> {
    use rand::{Rng, SeedableRng};
    let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut unit = || (random.next_u32() >> 8) as f32 / (1 << 24) as f32;
    let mut sphere = |place: usize| match place % 37 {
        5 => Sphere::new([f32::NAN, 0.0, 0.0, 1.0]),
        11 => Sphere::new([0.0, 0.0, 0.0, -1.0]),
        23 => Sphere::new([f32::MAX, -f32::MAX, 0.0, f32::MAX]),
        7 | 8 => Sphere::new([0.5, 0.5, 0.5, 0.0]),
        _ => Sphere::new([unit() * 6.0, unit() * 6.0, unit() * 6.0, unit() * 0.5]),
    };
    (0..count).map(&mut sphere).collect()
}

/// With one and with two spheres that are loaded in a cycle.
const BOTH_LOADERS: [(u32, u32); 2] = [(32, 2), (64, 4)];

#[test]
fn small_odd_and_full_sets_come_out_right() {
    for (lanes, deciders) in BOTH_LOADERS {
        let config = config(Sizes { table: 512, lanes, deciders, ..Sizes::default() });
        let mut bench = Bench::new(&config);
        for count in [0, 1, 15, 16, 17, 40, 255, 256, 257, 300, 511, 512] {
            check(&mut bench, &config, &odd(count, count as u64), None);
        }
        // The first invalid sphere is any of a row.
        for place in 0..16 {
            let mut set = [Sphere::new([1.0, 2.0, 3.0, 0.5]); 20];
            set[place] = Sphere::new([f32::NAN; 4]);
            check(&mut bench, &config, &set, None);
        }
        // Every pair touches.
        check(&mut bench, &config, &[Sphere::new([1.0, 2.0, 3.0, 0.5]); 70], None);
        check(&mut bench, &config, &[Sphere::new([0.0, 0.0, 0.0, f32::MAX]); 33], None);
        // None does.
        let apart: Vec<_> = (0..100).map(|place| Sphere::new([place as f32, 0.0, 0.0, 0.25])).collect();
        check(&mut bench, &config, &apart, None);
    }
}

#[test]
fn two_sets_are_compared_and_the_table_stays() {
    for (lanes, deciders) in [(16, 8), (64, 2)] {
        two_sets(&config(Sizes { table: 512, lanes, deciders, ..Sizes::default() }));
    }
}

fn two_sets(config: &Config) {
    let mut bench = Bench::new(config);
    for (first, second) in [(0, 0), (0, 20), (20, 0), (1, 1), (16, 33), (17, 16), (300, 200), (512, 700)] {
        let (first, second) = (odd(first, 3), odd(second, 4));
        check(&mut bench, config, &first, Some(&second));
        // The second set alone is sent; the first is still there.
        for seed in [5, 6] {
            let probes = odd(50, seed);
            let got = bench.run(2, &[], &probes);
            let want = expected(config, &first, Some(&probes));
            assert_eq!((got.hits, got.candidates), (want.hits, want.candidates));
        }
    }
    // A set by itself empties the table of the one before.
    let set = odd(100, 9);
    check(&mut bench, config, &set, None);
    let got = bench.run(2, &[], &set);
    assert_eq!(got.hits, expected(config, &set, Some(&set)).hits);
}

#[test]
fn slow_writes_hold_everything_back_and_lose_nothing() {
    let config = config(Sizes { table: 512, lanes: 256, deciders: 16, ..Sizes::default() });
    let mut bench = Bench::new(&config);
    let set = vec![Sphere::new([1.0, 2.0, 3.0, 0.5]); 150];
    for pace in [40, 7, 1] {
        bench.write_pace = pace;
        check(&mut bench, &config, &set, None);
    }
    // Writes that are slower than all else hold every stage back whose queue the rows inside can fill: with few lanes,
    // because then a row takes many steps.
    let config = self::config(Sizes { table: 512, lanes: 16, deciders: 4, ..Sizes::default() });
    let mut bench = Bench { write_pace: 40, ..Bench::new(&config) };
    bench.waits = ["group_rows", "near", "box_pairs", "hits"].map(|stage| (stage, 0)).to_vec();
    check(&mut bench, &config, &[Sphere::new([1.0, 2.0, 3.0, 0.5]); 512], None);
    assert!(bench.waits.iter().all(|(_, cycles)| *cycles > 100), "{:?}", bench.waits);
    // With two SCPUs, hits wait for these, and rows for their hits. With many lanes, 32 rows wait.
    let config =
        Config { contact: Fields::ALL, scpus: 2, ..self::config(Sizes { lanes: 256, deciders: 16, ..config.search }) };
    let mut bench = Bench { write_pace: 40, ..Bench::new(&config) };
    bench.waits = vec![("hits", 0)];
    let apart = |place: usize| Sphere::new([(place / 3) as f32, 0.0, 0.0, 0.5]);
    for set in [(0..512).map(apart).collect(), vec![Sphere::new([1.0, 2.0, 3.0, 0.5]); 100]] {
        check(&mut bench, &config, &set, None);
    }
    assert!(bench.waits[0].1 > 100, "{:?}", bench.waits);
}

/// Whenever a job is aborted or the AFU is reset, the next job is right.
#[test]
fn aborts_and_resets_at_every_cycle_leave_nothing_behind() {
    let config = config(Sizes { table: 512, lanes: 32, deciders: 2, ..Sizes::default() });
    let mut bench = Bench::new(&config);
    let (short, crowd) = (odd(50, 1), vec![Sphere::new([1.0, 2.0, 3.0, 0.5]); 40]);
    let mut aborted = 0;
    for cycle in 0.. {
        let ended = bench.run_until(0, &crowd, &[], Some(Stop::Abort(cycle)));
        check(&mut bench, &config, &short, None);
        if ended.error == 0 {
            break;
        }
        assert_eq!(ended.error, u128::from(crate::record::JobError::Aborted.code()));
        aborted += 1;
    }
    assert!(aborted > 300, "{aborted} cycles");
    for cycles in 0..aborted {
        bench.run_until(0, &crowd, &[], Some(Stop::Reset(cycles)));
        check(&mut bench, &config, &short, None);
    }
}

#[test]
fn unknown_modes_and_too_large_sets_are_refused() {
    let config = config(Sizes { table: 512, ..Sizes::default() });
    let mut bench = Bench::new(&config);
    for mode in 3..16 {
        let got = bench.run(mode, &[], &[]);
        assert_eq!(got.error, u128::from(crate::record::JobError::Mode.code()));
    }
    // One sphere too many, in the first set or in the second.
    for (mode, first, second) in [(0, 513, 0), (1, 513, 3), (1, 3, 65_537), (2, 0, 65_537)] {
        let got = bench.run(mode, &vec![Sphere::default(); first], &vec![Sphere::default(); second]);
        assert_eq!(got.error, u128::from(crate::record::JobError::Table.code()));
    }
    check(&mut bench, &config, &odd(40, 1), None);
}
