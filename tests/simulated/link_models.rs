//! Models of real links: the AFU's throughput as a share of the link limit, and the cycles of a small job.

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Shell};
use contact_afu::link::{Description, LinkModel, Order};
use contact_afu::pairs::Set;
use contact_afu::verify::{Bench, account};

fn link(name: &str) -> LinkModel {
    name.parse::<Description>().unwrap().at(Config::default().clock_mhz).unwrap()
}

fn without_tail(name: &str) -> LinkModel {
    let mut link = link(name);
    (link.read.tail, link.write.tail) = (0, 0);
    link
}

#[test]
fn ninety_thousand_pairs_take_what_harp1_allows() {
    let bench = Bench::new(&Config::default()).unwrap();
    let verdict = bench.run(&Set::Random(90_000).pairs(1), &link("harp1"), 1).unwrap();
    assert!(verdict.is_good());
    let outcome = &verdict.outcome;
    // 32 bytes in and 32 out per pair, at 6.5 GB/s: 9.85 ns per pair.
    let allowed = 64.0 * 90_000.0 / 6.5;
    // The shell's own lines (polls, counters, status) add less than half a percent to the link limit. The share of the
    // link limit counts only pairs.
    let own = 5.0 * outcome.limit_cycles / allowed;
    assert!((1.0..1.005).contains(&own), "{own}");
    let reached = allowed / (5.0 * outcome.cycles as f64);
    assert!((0.95..=1.0).contains(&reached), "{reached}");
}

/// Over 850 ns, 64 reads in flight carry 4.8 GB/s of 6.4. With 256 both links are the limit.
#[test]
fn with_256_reads_in_flight_far_memory_is_the_limit() {
    for (name, interval) in [("harp2", 5), ("pcie3x8", 10)] {
        let config = Config { shell: Shell::Line, outstanding: 256, interval, ..Config::default() };
        let verdict = Bench::new(&config).unwrap().run(&Set::Random(90_000).pairs(1), &link(name), 1).unwrap();
        assert!(verdict.is_good());
        let reached = verdict.outcome.limit_cycles / verdict.outcome.cycles as f64;
        assert!((0.95..=1.0).contains(&reached), "{name}: {reached}");
    }
}

/// Behind AXI4 the models of two hosts' links, of a card's memory and of a Zynq's port are the limit too.
#[test]
fn behind_axi_memory_is_the_limit() {
    for (bus, interval, links) in [(512, 5, &["harp2", "pcie3x8", "ddr4"][..]), (128, 20, &["zynqmp"])] {
        let config = Config { shell: Shell::Axi, bus, outstanding: 256, interval, ..Config::default() };
        let bench = Bench::new(&config).unwrap();
        for name in links {
            let verdict = bench.run(&Set::Random(90_000).pairs(1), &link(name), 1).unwrap();
            assert!(verdict.is_good());
            let reached = verdict.outcome.limit_cycles / verdict.outcome.cycles as f64;
            println!("{name}: {reached}");
            assert!((0.95..=1.0).contains(&reached), "{name}: {reached}");
        }
    }
}

/// The same bits whatever is in flight, over links that reorder, stall and delay.
#[test]
fn the_number_in_flight_changes_no_bit() {
    for (shell, outstanding) in
        [(Shell::Line, 16), (Shell::Line, 128), (Shell::Line, 256), (Shell::Spl2, 16), (Shell::Axi, 16)]
    {
        let config = Config { scpus: 3, shell, outstanding, ..Config::default() };
        let bench = Bench::new(&config).unwrap();
        for link in [LinkModel::hostile(), link("pcie3x8")] {
            for pairs in [1, 999] {
                let verdict = bench.run(&Set::Hard(pairs).pairs(3), &link, 7).unwrap();
                assert!(verdict.is_good(), "{shell}, {outstanding} in flight, {pairs} pairs over {link}");
            }
        }
    }
}

#[test]
fn a_small_job_is_the_sum_of_its_parts() {
    let config = Config { shell: Shell::Line, ..Config::default() };
    let afu = Afu::generate(Spec::from(config.clone())).unwrap();
    let bench = Bench::new(&config).unwrap();
    for mut link in ["ideal", "harp1", "harp2", "pcie3x8"].map(without_tail) {
        link.order = Order::InOrder;
        for pairs in [0, 1, 2, 3, 20, 41] {
            let parts = account(&afu, &link, pairs).unwrap_or_else(|| panic!("{pairs} pairs over {link}"));
            let sum: u64 = parts.iter().map(|part| part.cycles).sum();
            let measured = bench.run(&Set::Random(pairs.into()).pairs(2), &link, 1).unwrap().outcome.cycles;
            assert_eq!(sum, measured, "{pairs} pairs over {link}: {parts:#?}");
        }
    }
}

#[test]
fn what_is_no_sum_of_parts_is_not_told_as_one() {
    let afu = |shell: Shell| Afu::generate(Spec::from(Config { shell, ..Config::default() })).unwrap();
    assert_eq!(account(&afu(Shell::Spl2), &without_tail("harp1"), 2), None, "a shell that polls");
    let afu = afu(Shell::Line);
    assert_eq!(account(&afu, &link("harp1"), 2), None, "a tail");
    assert_eq!(account(&afu, &without_tail("pcie3x8"), 20), None, "reads in any order wait for one another");
    assert_eq!(account(&afu, &LinkModel::hostile(), 2), None, "stalls");
    assert_eq!(account(&afu, &without_tail("harp1"), 1000), None, "writes meet reads");
}

/// The link model comes from a file: a lost read leads to a job that does not finish, and the error says so.
#[test]
fn a_file_of_a_link_is_taken() {
    let run = |link: &str, code: i32| {
        let mut afu = assert_cmd::Command::cargo_bin("afu").unwrap();
        let done = afu.args(["cosim", "--shell", "line", "--pairs", "random:100", "--link", link]).assert().code(code);
        String::from_utf8(done.get_output().stderr.clone()).unwrap()
    };
    let lost = run(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/links/lossy.toml"), 1);
    assert!(lost.contains("waiting for the data of a read"), "{lost}");
    run("harp1", 0);
    let unknown = run("harp3", 2);
    assert!(unknown.contains("harp1, harp2, pcie3x8, zynqmp, ddr4, or a .toml or .json file"), "{unknown}");
    let missing = run("missing.toml", 2);
    assert!(missing.starts_with("afu: missing.toml: "), "{missing}");
}
