use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::query::PairRecord;
use contact_afu::verify::Bench;

/// The pairs for a seed: from none to some hundred, odd and even counts, half of them hard.
fn pairs(seed: u64) -> Vec<PairRecord> {
    let count = [0, 1, 2, 3, 17, 64, 129, 300][(seed % 8) as usize] + seed / 8 % 5;
    let mut pairs = Set::Hard(count / 2).pairs(seed);
    pairs.extend(Set::Random(count - count / 2).pairs(seed));
    pairs
}

/// Runs a job and checks every bit, count and byte; returns the number of cycles.
fn job(name: &str, bench: &Bench, link: &LinkModel, seed: u64) -> u64 {
    let pairs = pairs(seed);
    let verdict = bench.run(&pairs, link, seed).unwrap_or_else(|error| panic!("{name}, seed {seed}: {error}"));
    assert!(verdict.is_good(), "{name}, seed {seed}: {:?} {:?}", verdict.mismatches.first(), verdict.failed_checks);
    assert_eq!(verdict.contacts.len(), pairs.len(), "{name}, seed {seed}");
    verdict.outcome.cycles
}

fn seeds(from: u64, count: u64) {
    for (name, bench) in super::benches() {
        let mut delayed = 0;
        for seed in from..from + count {
            let hostile = job(name, &bench, &LinkModel::hostile(), seed);
            if seed % 8 == 7 {
                delayed += u64::from(4 * hostile > 5 * job(name, &bench, &LinkModel::ideal(), seed));
            }
        }
        assert!(
            delayed >= count / 8,
            "{name}: the link is hostile: {delayed} long jobs of {count} took a quarter more"
        );
        println!("{name}: {count} seeds from {from}");
    }
}

#[test]
fn nothing_is_lost_over_hostile_links() {
    seeds(0, 64);
}

/// `HOSTILE_SEEDS` jobs per profile (1000), from seed `HOSTILE_FROM` on (1000).
#[test]
#[ignore = "minutes: 1000 links per profile"]
fn nothing_is_lost_over_many_hostile_links() {
    let setting = |name: &str, default| match std::env::var(name) {
        Ok(text) => text.parse().unwrap_or_else(|_| panic!("{name}: a number")),
        Err(_) => default,
    };
    seeds(setting("HOSTILE_FROM", 1_000), setting("HOSTILE_SEEDS", 1_000));
}
