//! Measuring hardware: the wrapper trims nothing, the measured netlist gives the twin's bits, and the command line
//! works as documented. Needs Yosys and nextpnr-ecp5: `scripts/setup --test`.

use assert_cmd::Command;
use contact_afu::config::Profile;
use contact_afu::hdl::DelayModel;
use contact_afu::operator::{Architecture, Operator, Values};
use contact_afu::synth::{Figures, Options, Placer, Target, Trimmed, Unit, synthesise};

fn afu(arguments: &[&str], environment: &[(&str, &str)]) -> std::process::Output {
    let mut command = Command::cargo_bin("afu").expect("the program is built");
    command.args(["synth"]).args(arguments).envs(environment.iter().copied()).output().expect("it runs")
}

fn unit(operator: Operator, profile: &str, clock_mhz: f64) -> Unit {
    let profile: Profile = profile.parse().expect("a profile");
    Unit::operator(operator, &profile, Values::Any, &DelayModel::default(), clock_mhz).expect("it can be cut")
}

#[test]
fn what_is_missing_is_exit_3_with_its_command_and_bad_words_are_exit_2() {
    for variable in ["AFU_YOSYS", "AFU_NEXTPNR_ECP5"] {
        let output = afu(&["--operator", "add", "--profile", "half"], &[(variable, "no-such-program")]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(3), "{said}");
        assert!(said.contains(variable) && said.contains("install it with: ./scripts/setup --test"), "{said}");
    }
    for arguments in [
        &["--operator", "power"][..],
        &["--target", "tin"],
        &["--operator", "add", "--seeds", "x"],
        &["--scpus", "0"],
        &["--placer", "sa"],
        &["--placer", "static", "--no-route"],
        &["--placer", "floorplan", "--target", "ice40"],
    ] {
        assert_eq!(afu(arguments, &[]).status.code(), Some(2), "{arguments:?}");
    }
}

/// A former fault: memories requested look-up tables, which an iCE40 cannot use as memory, and Yosys failed.
#[test]
fn an_scpu_is_counted_for_a_family_without_memories_of_look_up_tables() {
    let arguments = ["--kernel", "--profile", "half", "--contact", "hit", "--target", "ice40", "--no-route"];
    let output = afu(&arguments, &[]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn an_operator_is_placed_and_routed() {
    let cache = tempfile::tempdir().expect("a temporary folder");
    let folder = cache.path().to_str().expect("UTF-8");
    let run = |placer: &[&str]| {
        let arguments = ["--operator", "add", "--profile", "half", "--clock", "150", "--seeds", "1", "--json", "-"];
        let output = afu(&[&arguments[..], placer].concat(), &[("AFU_CACHE", folder)]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{said}");
        (serde_json::from_slice::<Figures>(&output.stdout).expect("figures alone on standard output"), said)
    };
    let (figures, said) = run(&[]);
    let clock = figures.clock_mhz.expect("routed");
    assert!(clock > 75.0 && figures.seeds.len() == 1 && figures.seeds[0].clock_mhz == clock, "{figures:?}");
    let cycles = figures.latency_cycles.expect("a pipeline");
    assert_eq!(figures.latency_ns, Some(1000.0 * f64::from(cycles) / clock));
    assert!((100..1000).contains(&figures.area.luts) && figures.area.ffs > 16, "{figures:?}");
    // The wrapper's registers: two chains and two ranks, for the bits of both operands and of the result.
    assert_eq!((figures.wrapper.ffs, figures.trimmed), (2 * 32 + 2 * 16, Trimmed::default()));
    let path: f64 = figures.critical.iter().map(|hop| hop.logic_ns + hop.routing_ns).sum();
    assert!((path - 1000.0 / clock).abs() < 0.3, "the path of {path} ns is what limits {clock} MHz");
    assert!(figures.critical.iter().any(|hop| hop.stage.is_some()), "{:?}", figures.critical);
    assert!(said.contains("add half, ecp5: critical path"), "{said}");
    assert_eq!(figures.placer, Some(Placer::Heap));
    assert_eq!(run(&["--placer", "heap"]).0, figures, "kept and found again");
    let (other, said) = run(&["--placer", "static"]);
    assert!(said.contains("add half, ecp5, placer static: critical path"), "{said}");
    assert_eq!((other.placer, other.area.ffs), (Some(Placer::Static), figures.area.ffs));
    assert_ne!(other.critical, figures.critical, "cells stand elsewhere");
    // Without blocks there is nothing to plan.
    let (planned, _) = run(&["--placer", "floorplan"]);
    assert_eq!((planned.placer, planned.seeds), (Some(Placer::Floorplan), other.seeds));
}

/// nextpnr refuses a site that the device does not have.
#[test]
fn multipliers_and_tables_are_placed_by_a_floorplan() {
    let cache = tempfile::tempdir().expect("a temporary folder");
    let folder = cache.path().to_str().expect("UTF-8");
    let arguments = ["--operator", "recip", "--profile", "wide", "--clock", "200", "--seeds", "1"];
    let output = afu(&[&arguments[..], &["--placer", "floorplan"]].concat(), &[("AFU_CACHE", folder)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let netlists: Vec<serde_json::Value> = (std::fs::read_dir(cache.path().join("synth")).expect("a store"))
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "netlist"))
        .map(|path| serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON"))
        .collect();
    let mut sites: Vec<(String, String)> = Vec::new();
    for cell in netlists.iter().flat_map(|netlist| netlist["modules"]["bench"]["cells"].as_object().expect("cells")) {
        if let Some(site) = cell.1["attributes"]["BEL"].as_str() {
            sites.push((cell.1["type"].as_str().expect("a type").to_owned(), site.to_owned()));
        }
    }
    assert!(sites.iter().any(|(kind, site)| kind == "MULT18X18D" && site.contains("/MULT18_")), "{sites:?}");
    assert!(sites.iter().all(|(kind, site)| (kind == "DP16KD") == site.contains("/EBR")), "{sites:?}");
    let different: std::collections::BTreeSet<_> = sites.iter().collect();
    assert_eq!(different.len(), sites.len(), "a site has one block: {sites:?}");
}

/// An operator with two architectures, and one with a single architecture, which is listed once.
#[test]
fn architectures_stand_side_by_side() {
    let cache = tempfile::tempdir().expect("a temporary folder");
    let arguments = ["--compare", "--operator", "recip,halve", "--profile", "e6f9z", "--no-route", "--json", "-"];
    let output = afu(&arguments, &[("AFU_CACHE", cache.path().to_str().expect("UTF-8"))]);
    let all: Vec<Figures> = serde_json::from_slice(&output.stdout).expect("a list of figures");
    let found: Vec<_> = all.iter().map(|figures| (figures.unit.as_str(), figures.architecture)).collect();
    let (table, recurrence) = (Some(Architecture::Table), Some(Architecture::Recurrence));
    assert_eq!(found, [("recip", table), ("recip", recurrence), ("halve", None)]);
    assert!(all[0].area.dsps > 0 && all[1].area.dsps == 0 && all[0].latency_cycles < all[1].latency_cycles, "{all:?}");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("recip e6f9z by table, ecp5") && said.contains("recip e6f9z by recurrence, ecp5"), "{said}");
}

#[test]
fn every_target_counts_and_trims_nothing() {
    for target in Target::ALL {
        let options = Options { target, seeds: Vec::new(), placer: Placer::default() };
        let figures = synthesise(&unit(Operator::AtMost, "half", 200.0), &options, |_| ()).expect("counted");
        assert!(figures.area.luts > 5 && figures.clock_mhz.is_none(), "{figures:?}");
        assert_eq!(figures.trimmed, Trimmed::default(), "{target}");
    }
}
