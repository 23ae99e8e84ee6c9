//! The oldest supported Verilator gives the same bits and cycles as the newest.

use std::env;
use std::path::Path;
use std::process::Command;

use contact_afu::cosim::verilate::Tool;

use crate::bench::{Case, config, driver, generated};

/// What a child process prints before its result.
const MARK: &str = "small job: ";

/// Runs a small job through a model of whichever Verilator this process finds; returns all lines and figures as one
/// line.
fn run() -> String {
    let config = config(3, "e8f3z", "depth");
    let case = Case::random(&config, 501, 4);
    let afu = generated(&config).instance(0).unwrap();
    let outcome = driver(&afu, "hostile", 4).run(&case.job()).unwrap();
    case.check(&outcome, "a small job");
    format!("{outcome:?}")
}

#[test]
fn debian_s_verilator_gives_the_same_bits_and_cycles() {
    let old = Path::new("/usr/bin/verilator");
    assert!(old.exists(), "needs a second Verilator: run scripts/setup --test");
    let cache = Path::new(env!("CARGO_TARGET_TMPDIR")).join("models-of-the-old-verilator");
    let child = Command::new(env::current_exe().unwrap())
        .args(["--exact", "verilators::in_a_process_of_its_own", "--ignored", "--nocapture"])
        .env("AFU_VERILATOR", old)
        .env("AFU_CACHE", &cache)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&child.stdout);
    let errors = String::from_utf8_lossy(&child.stderr);
    let line = text.lines().find_map(|line| line.split_once(MARK)).map(|(_, line)| line);
    let line = line.unwrap_or_else(|| panic!("{text}{errors}"));
    let (version, result) = line.split_once(" | ").unwrap();
    assert_ne!(version, Tool::find().unwrap().version(), "two Verilators are needed to compare them");
    assert_eq!(result, run());
}

#[test]
#[ignore = "the test above runs it, with another Verilator"]
fn in_a_process_of_its_own() {
    println!("{MARK}{} | {}", Tool::find().unwrap().version(), run());
}
