//! The line port, driven by a cocotb bench that is based only on PORTS.md.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use contact_afu::config::{Config, RecordFormat, Results, Shell};

use super::{generate, root, write};

fn bench(package: &Path) -> Output {
    let python = root().join(".venv/bin/python");
    let mut command = Command::new(python);
    command.arg(root().join("tb/cocotb/run.py")).arg(package);
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
