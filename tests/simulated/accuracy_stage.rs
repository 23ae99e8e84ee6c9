//! The times of `afu accuracy` come from the Verilog: an additional stage in it changes them.

use contact_afu::accuracy::trade::{Cycles, cycles};
use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Shell};
use contact_afu::cosim::Trace;
use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::verify::Bench;
use std::fs;

/// Adds a pipeline stage behind the responses of the line port.
fn with_a_stage(verilog: &str) -> String {
    let ports = [("valid", 1), ("tag", 10), ("data", 512), ("error", 1)];
    let mut text = verilog.to_owned();
    let mut stage = String::from(");\n");
    for (port, width) in ports {
        let from = format!("(rd_rsp_{port})");
        assert_eq!(text.matches(&from).count(), 1, "the collector's port {port}");
        text = text.replace(&from, &format!("(late_{port})"));
        stage +=
            &format!("  reg [{}:0] late_{port};\n  always @(posedge clk) late_{port} <= rd_rsp_{port};\n", width - 1);
    }
    text.replacen(");\n", &stage, 1)
}

#[test]
fn a_stage_more_is_a_cycle_more() {
    let config =
        Config { scpus: 1, shell: Shell::Line, profile: "paper".parse().expect("a profile"), ..Config::default() };
    let room = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in Afu::generate(Spec::from(config.clone())).expect("an AFU").files() {
        let text = if name == "contact_afu.v" { with_a_stage(&text) } else { text };
        let path = room.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, text).expect("written");
    }
    let pairs = Set::Diamond(5).pairs(1);
    let count = |bench: &Bench| -> Cycles {
        cycles(bench, &pairs, &LinkModel::late(), 1, String::new()).expect("jobs that end")
    };
    let plain = count(&Bench::new(&config).expect("a model"));
    let staged = count(&Bench::of_folder(room.path(), None, Trace::Off).expect("a model"));
    assert_eq!((plain.mismatches, staged.mismatches), (0, 0));
    assert_eq!(staged.lone, plain.lone + 1);
    let jobs = |cycles: &Cycles| (cycles.compute * pairs.len() as f64).round() as u64;
    assert_eq!(jobs(&staged), jobs(&plain) + 1, "and of a job of many pairs too");
    assert!(staged.link >= plain.link);
}
