//! The AFU as generated now against the reference kernel, over every preset link.

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Multipliers, RecordFormat, Results, Shell};
use contact_afu::cosim::axi::Machine;
use contact_afu::host::Transport;
use contact_afu::link::axi::Handshake;
use contact_afu::link::spl2::Spl2Model;
use contact_afu::link::{Description, Direction, LinkModel, Stalls};
use contact_afu::pairs::Set;
use contact_afu::patience::{self, Work};
use contact_afu::query::PairRecord;
use contact_afu::record::Capability;
use contact_afu::verify::{Bench, Verdict};

fn good(verdict: &Verdict, what: &str) {
    let first = verdict.mismatches.first();
    assert!(
        verdict.is_good(),
        "{what}: {} mismatches, first {first:?}; {:?}",
        verdict.mismatches.len(),
        verdict.failed_checks
    );
}

#[test]
fn the_diamond_comes_back_right_and_at_the_link_s_speed() {
    let bench = Bench::new(&Config::shipped()).expect("a model");
    let pairs = Set::Diamond(10).pairs(0);
    let verdict = bench.run(&pairs, &LinkModel::ideal(), 1).expect("it finishes");
    good(&verdict, "diamond");
    assert_eq!(verdict.flows(bench.config()), [0, 9_420, 0, 2_934]);
    assert!(verdict.outcome.efficiency() > 0.95, "{:?}", verdict.outcome.cycles);
    let verdict = bench.run(&Set::Random(20_000).pairs(3), &LinkModel::ideal(), 1).expect("it finishes");
    good(&verdict, "random");
}

/// Spheres with a common radius: records and the hardware's ports do not contain it, and the bits are the same.
#[test]
fn one_radius_is_in_no_record_and_changes_no_bit() {
    let sphere = |i: u32, f: f32| [(i % 5) as f32 * f, (i % 3) as f32, (i % 2) as f32, 0.375];
    let pairs: Vec<_> = (0..150).map(|i| PairRecord::from_spheres(sphere(0, 0.0), sphere(i, 0.25))).collect();
    for (profile, contact, shell) in
        [("e8f3z", "depth,normal,position", Shell::Spl2), ("wide", "hit", Shell::Axi), ("exact", "depth", Shell::Line)]
    {
        let [profile, contact] = [profile.to_owned(), contact.to_owned()];
        let config = Config {
            scpus: 3,
            profile: profile.parse().expect("a profile"),
            contact: contact.parse().expect("fields"),
            radius: Some(0.375),
            shell,
            ..Config::default()
        };
        let bench = Bench::new(&config).expect("a model");
        let verdict = bench.run(&pairs, &LinkModel::shuffled(), 1).expect("it finishes");
        good(&verdict, &profile);
        assert!((10..140).contains(&verdict.outcome.contacts), "{profile}: {}", verdict.outcome.contacts);
        let mut other = pairs.clone();
        other[7].0[7] = 0.5_f32.to_bits();
        let error = bench.run(&other, &LinkModel::ideal(), 1).expect_err("another radius").to_string();
        assert!(
            error.starts_with("pair 7: expected r2 = 0.375, the radius of all spheres (--radius), found 0.5"),
            "{error}"
        );
    }
}

/// Records of 16 bits, four pairs per line: records for all pairs or only for contacts, a common radius, contacts of
/// one bit, shared operators. Results equal those of the reference for the same words bit for bit.
#[test]
fn records_of_16_bits_come_back_as_the_reference_has_them() {
    let random = Set::Random(701).pairs(9);
    let diamond = Set::Diamond(5).pairs(1);
    for (scpus, interval, record, contact, results, shell, radius) in [
        (1, 1, RecordFormat::F16, "depth,normal,position", Results::All, Shell::Line, Some(0.5)),
        (3, 1, RecordFormat::F16, "hit", Results::All, Shell::Line, None),
        (5, 3, RecordFormat::F16, "depth,normal,position", Results::All, Shell::Line, None),
        (10, 1, RecordFormat::Bf16, "depth,normal,position", Results::Hits, Shell::Spl2, None),
        (7, 2, RecordFormat::Bf16, "depth,position", Results::All, Shell::Axi, None),
    ] {
        let profile = "e8f3z".parse().expect("a format");
        let contact = contact.parse().expect("fields");
        let config = Config { scpus, interval, record, contact, results, shell, radius, profile, ..Config::default() };
        let bench = Bench::new(&config).expect("a model");
        let what = format!("{scpus} SCPUs at interval {interval}, {record}");
        let verdict = bench.run(&diamond, &LinkModel::shuffled(), 1).expect("it finishes");
        good(&verdict, &format!("{what}, the diamond"));
        // With SPL2 the shell reads additional lines.
        let lines = verdict.outcome.bytes_read / 64;
        let pairs = diamond.len().div_ceil(4) as u64;
        assert!(shell == Shell::Spl2 || lines == pairs, "four pairs a line: {lines} lines");
        if radius.is_none() {
            let verdict = bench.run(&random, &LinkModel::shuffled(), 2).expect("it finishes");
            good(&verdict, &format!("{what}, at random"));
            assert!(verdict.outcome.contacts > 20 && verdict.outcome.invalid > 20, "{:?}", verdict.outcome.contacts);
        }
    }
}

/// Roots and reciprocals by digit recurrence instead of tables: more cycles, and the same bits.
#[test]
fn spared_multiplier_blocks_change_no_bit() {
    let pairs = Set::Random(3_001).pairs(5);
    let latency = [Multipliers::Use, Multipliers::Spare].map(|multipliers| {
        let profile = "e8f7z".parse().expect("a format");
        let config = Config { scpus: 1, profile, multipliers, shell: Shell::Line, ..Config::default() };
        let bench = Bench::new(&config).expect("a model");
        let verdict = bench.run(&pairs, &LinkModel::ideal(), 1).expect("it finishes");
        good(&verdict, &multipliers.to_string());
        assert!(verdict.outcome.contacts > 500, "{}", verdict.outcome.contacts);
        verdict.outcome.cycles
    });
    assert!(latency[0] != latency[1], "the hardware is another: {latency:?} cycles");
}

/// Returns only contacts, with the paper's platform and behind AXI4: the number of lines written is the number of
/// contacts.
#[test]
fn hits_come_back_through_every_shell() {
    for shell in [Shell::Spl2, Shell::Axi] {
        let profile = "e8f3z".parse().expect("a format");
        let config = Config { scpus: 3, profile, results: Results::Hits, shell, ..Config::default() };
        let bench = Bench::new(&config).expect("a model");
        for (pairs, seed) in [(501, 1), (0, 2), (1, 3)] {
            let verdict =
                bench.run(&Set::Random(pairs).pairs(seed), &LinkModel::shuffled(), seed).expect("it finishes");
            good(&verdict, &format!("hits through {shell}"));
            assert_eq!(verdict.numbers.len(), verdict.outcome.contacts as usize);
            assert_eq!(verdict.outcome.lines.iter().flatten().count(), verdict.numbers.len());
        }
    }
}

/// A configuration for the timeout tests: small SCPUs with one-bit results.
fn slow(scpus: u32, interval: u32) -> Config {
    let (profile, contact) = ("e8f3z".parse().expect("a format"), "hit".parse().expect("fields"));
    Config { scpus, interval, profile, contact, ..Config::default() }
}

#[test]
fn a_right_afu_is_never_given_up_at_the_line_port() {
    never_given_up(Shell::Line);
}

#[test]
fn a_right_afu_is_never_given_up_below_spl2() {
    never_given_up(Shell::Spl2);
}

#[test]
fn a_right_afu_is_never_given_up_behind_axi() {
    never_given_up(Shell::Axi);
}

/// Twelve AFUs on links that make them wait: the driver never times out while they work, and always terminates.
///
/// The first AFU once timed out with SPL2: "did not finish after 24610 cycles".
fn never_given_up(shell: Shell) {
    let named = |name: &str| name.parse::<Description>().expect("a link").at(200.0).expect("a clock");
    let ideal = LinkModel::ideal;
    let one_at_a_time = Direction { in_flight: 1, lines_per_cycle: 0.05, ..Direction::steady(300, 500) };
    let creeping = LinkModel { read: one_at_a_time, write: one_at_a_time, lines_per_cycle: 0.06, ..ideal() };
    let blocked = Direction { stalls: Stalls { chance: 0.5, longest: 200 }, ..Direction::steady(9, 0) };
    let stalling = LinkModel { read: blocked, write: blocked, ..ideal() };
    let bf16 = |config: Config| Config { record: RecordFormat::Bf16, ..config };
    let hits = |config: Config| Config { results: Results::Hits, ..config };
    let paper = Config { profile: "paper".parse().expect("a profile"), multipliers: Multipliers::Spare, ..slow(1, 31) };
    let cases = [
        (bf16(Config { clock_mhz: 150.0, ..paper }), ideal(), 1024),
        (slow(1, 64), ideal(), 900),
        (slow(3, 64), LinkModel::late(), 1501),
        (bf16(slow(2, 64)), named("harp1"), 1024),
        (slow(10, 5), LinkModel::hostile(), 3000),
        (slow(11, 5), LinkModel::shuffled(), 3001),
        (slow(19, 5), named("pcie3x8"), 5000),
        (slow(1, 1), creeping, 300),
        (slow(5, 1), LinkModel::hostile(), 4000),
        (slow(3, 1), stalling, 1000),
        (hits(slow(3, 7)), LinkModel::late(), 5000),
        (Config { radius: Some(0.25), ..hits(bf16(slow(1, 31))) }, named("harp2"), 1000),
    ];
    // Each AFU is a model to build. Behind AXI4, half of them show what differs there: the channels' own stalls.
    let every = if shell == Shell::Axi { 2 } else { 1 };
    for (config, link, count) in cases.into_iter().step_by(every) {
        let config = Config { shell, ..config };
        let pairs: Vec<_> = match config.radius {
            None => Set::Random(count).pairs(1),
            // No pairs touch, so nothing is written.
            Some(r) => vec![PairRecord::from_spheres([0.0, 0.0, 0.0, r], [9.0, 0.0, 0.0, r]); count as usize],
        };
        let what = format!("{} over {link}", config.flags().join(" "));
        let bench = Bench::new(&config).expect("a model");
        let verdict = bench.run(&pairs, &link, 1).unwrap_or_else(|error| panic!("{what}: {error}"));
        good(&verdict, &what);

        let afu = Afu::generate(Spec::from(config)).expect("an AFU");
        let (said, layout) = (Capability::from_bits(afu.capability()), afu.layout());
        let (reads, writes) = (layout.source_lines(count), layout.destination_lines(count));
        let work = Work { pairs: count, reads, writes, ..Work::default() };
        let patience = match shell {
            Shell::Spl2 => patience::spl2(&said, &link, &Spl2Model::default(), &work),
            Shell::Axi => {
                let afu = bench.model().instance(1).expect("a model");
                Machine::new(&afu, link.clone(), Handshake::Free, 1).expect("a link").patience(&said, &work)
            }
            Shell::Line => patience::line(&said, &link, &work),
        };
        println!("{what}: {} cycles, {patience:?}", verdict.outcome.cycles);
        let times = patience.whole as f64 / verdict.outcome.cycles as f64;
        assert!((1.0..60.0).contains(&times), "{what}: {} cycles, {patience:?}", verdict.outcome.cycles);
    }
}
