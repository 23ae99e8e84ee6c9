//! The package in its users' tools: its file list from another folder, two AFUs in one design, its own test bench,
//! FuseSoC.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use contact_afu::afu::Afu;
use contact_afu::config::{Config, RecordFormat, Results, Shell};

use super::{generate, root, run_yosys, succeeded, verilators, write};

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// The output of an AFU's own test bench, with modules found by name, and whether it succeeded.
fn own_bench(package: &Path, afu: &Afu, elsewhere: &Path) -> (bool, String) {
    let bench = afu.bench_name();
    let compiled = Command::new("iverilog")
        .current_dir(elsewhere)
        .args(["-g2005", "-Wall", "-Wno-timescale", "-o", "bench", "-s", &bench, "-y"])
        .arg(package)
        .arg(package.join(format!("sim/{bench}.v")))
        .output()
        .expect("needs Icarus: run scripts/setup --test");
    succeeded(&bench, &compiled);
    let ran = Command::new("vvp").current_dir(elsewhere).args(["-n", "bench"]).output().unwrap();
    (ran.status.success(), text(&ran))
}

fn line() -> Config {
    Config { scpus: 2, shell: Shell::Line, ..Config::default() }
}

fn spoil(package: &Path, file: &str, old: &str, new: &str) {
    let path = package.join(file);
    let whole = fs::read_to_string(&path).unwrap();
    assert_eq!(whole.matches(old).count(), 1, "{file}: one `{old}`");
    fs::write(&path, whole.replace(old, new)).unwrap();
}

const PACKER: [&str; 3] = ["contact_afu_packer.v", " line <= {", " line <= 512'd4 ^ {"];

#[test]
fn the_package_s_own_bench_passes() {
    let elsewhere = tempfile::tempdir().unwrap();
    for config in [
        Config::shipped(),
        Config { results: Results::Hits, ..Config::default() },
        Config { results: Results::Hits, record: RecordFormat::F16, interval: 3, ..line() },
        Config { contact: "hit".parse().unwrap(), prefix: Some("left".into()), ..line() },
        Config { contact: "depth".parse().unwrap(), radius: Some(0.75), ..line() },
        Config { profile: "exact".parse().unwrap(), ..line() },
    ] {
        let afu = generate(config.clone());
        let (package, _) = write(&afu);
        let (good, said) = own_bench(package.path(), &afu, elsewhere.path());
        assert!(
            good && said.trim_end().lines().last().is_some_and(|last| last.starts_with("PASS")),
            "{config:?}: {said}"
        );
    }
}

#[test]
fn the_package_s_own_bench_fails() {
    let elsewhere = tempfile::tempdir().unwrap();
    for config in [Config::default(), line()] {
        let afu = generate(config.clone());
        let (package, _) = write(&afu);
        spoil(package.path(), PACKER[0], PACKER[1], PACKER[2]);
        let (good, said) = own_bench(package.path(), &afu, elsewhere.path());
        assert!(!good && said.contains("\nFAIL: ") && !said.contains("PASS"), "{config:?}: {said}");
    }
}

/// Uses the file list as its header describes for each tool.
#[test]
fn the_file_list_works_from_any_folder() {
    let room = tempfile::tempdir().unwrap();
    let [package, elsewhere] = ["package", "elsewhere"].map(|name| room.path().join(name));
    fs::create_dir(&elsewhere).unwrap();
    let (written, _) = write(&generate(line()));
    fs::rename(written.path(), &package).unwrap();
    let header = fs::read_to_string(package.join("contact_afu.f")).unwrap();
    for mut verilator in verilators() {
        assert!(header.contains("//   verilator -F FOLDER/contact_afu.f "));
        let arguments = ["--lint-only", "-Wall", "--top-module", "contact_afu", "-F", "../package/contact_afu.f"];
        succeeded("Verilator", &verilator.current_dir(&elsewhere).args(arguments).output().unwrap());
    }
    assert!(header.contains("//   yosys -p \"read_verilog FOLDER/contact_afu.v; hierarchy -libdir FOLDER -check"));
    let script = "read_verilog ../package/contact_afu.v; hierarchy -libdir ../package -check -top contact_afu";
    succeeded("Yosys", &run_yosys(&elsewhere, script));
    assert!(header.contains("//   iverilog -s contact_afu -y FOLDER FOLDER/contact_afu.v "));
    let icarus = |folder: &Path, arguments: &[&str]| {
        let mut command = Command::new("iverilog");
        command.current_dir(folder).args(["-g2005", "-Wall", "-Wno-timescale", "-t", "null", "-s", "contact_afu"]);
        succeeded("Icarus", &command.args(arguments).output().unwrap());
    };
    icarus(&elsewhere, &["-y", "../package", "../package/contact_afu.v"]);
    icarus(&package, &["-f", "contact_afu.f"]);
}

/// A module with both AFUs and all their ports.
fn both(afus: &[Afu]) -> String {
    let (mut ports, mut instances) = (Vec::new(), String::new());
    for afu in afus {
        let top = afu.top_name();
        let mut list = vec![("input", 1, "clk")];
        if afu.top().has_reset_port() {
            list.push(("input", 1, "rst"));
        }
        let direction = |output| if output { "output" } else { "input" };
        list.extend(afu.top().ports.iter().map(|port| (direction(port.output), port.width, port.name.as_str())));
        for (direction, width, name) in &list {
            ports.push(format!("  {direction} wire [{}:0] {top}_{name}", width - 1));
        }
        let connected: Vec<_> = list.iter().map(|(_, _, name)| format!("    .{name} ({top}_{name})")).collect();
        instances += &format!("  {top} #(.SCPUS(2)) u_{top} (\n{}\n  );\n", connected.join(",\n"));
    }
    format!("module both (\n{}\n);\n{instances}endmodule\n", ports.join(",\n"))
}

#[test]
fn two_afus_with_prefixes_are_one_design() {
    let room = tempfile::tempdir().unwrap();
    let left = Config { prefix: Some("left".into()), ..Config::default() };
    let right = Config { prefix: Some("right".into()), profile: "half".parse().unwrap(), ..line() };
    let afus = [left, right].map(generate);
    let mut files = vec!["both.v".to_owned()];
    fs::write(room.path().join("both.v"), both(&afus)).unwrap();
    for afu in &afus {
        for (name, text) in afu.files() {
            let is_known = name.ends_with(".md") || name == "manifest.json";
            let prefix = afu.spec().config.prefix.clone().unwrap() + "_";
            assert!(is_known || name.starts_with(&prefix) || name.starts_with(&format!("sim/{prefix}")), "{name}");
            let path = room.path().join(&name);
            assert!(is_known || !path.exists(), "{name} is in both");
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        files.extend(afu.verilog().into_iter().map(|(name, _)| name));
    }
    for mut verilator in verilators() {
        let verilator = verilator.current_dir(room.path()).args(["--lint-only", "-Wall", "--top-module", "both"]);
        succeeded("Verilator", &verilator.arg("-Wno-DECLFILENAME").args(&files).output().unwrap());
    }
    let script = format!("read_verilog {}; hierarchy -check -top both; proc; check -assert", files.join(" "));
    succeeded("Yosys", &run_yosys(room.path(), &script));
    let icarus = Command::new("iverilog")
        .current_dir(room.path())
        .args(["-g2005", "-Wall", "-Wno-timescale", "-t", "null", "-s", "both"])
        .args(&files)
        .output()
        .unwrap();
    succeeded("Icarus", &icarus);
    // Each run also contains every module of both AFUs.
    for afu in &afus {
        let (good, said) = own_bench(room.path(), afu, room.path());
        assert!(good, "{said}");
    }
    // Without prefixes their modules conflict.
    let plain = ["paper", "half"].map(|profile| generate(Config { profile: profile.parse().unwrap(), ..line() }));
    let [first, second] = plain.map(|afu| afu.verilog().into_iter().map(|(name, _)| name).collect::<Vec<_>>());
    assert!(first.iter().filter(|name| second.contains(name)).count() > 8);
}

/// Runs FuseSoC's own command without this machine's settings.
fn fusesoc(room: &Path, package: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(root().join(".venv/bin/fusesoc"));
    for home in ["HOME", "XDG_CONFIG_HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME"] {
        command.env(home, room.join("home"));
    }
    command.current_dir(room).arg("--cores-root").arg(package).args(arguments);
    command.output().expect("needs FuseSoC: run scripts/setup --test")
}

#[test]
fn fusesoc_runs_the_sim_target() {
    let axi = Config { shell: Shell::Axi, bus: 128, profile: "half".parse().unwrap(), ..Config::default() };
    for config in [Config { interval: 5, ..Config::default() }, Config { clock_mhz: 312.5, ..line() }, axi] {
        let (room, afu) = (tempfile::tempdir().unwrap(), generate(config));
        let (package, _) = write(&afu);
        let run = |arguments: &[&str]| fusesoc(room.path(), package.path(), arguments);
        let passed = run(&["run", "--target=sim", &afu.vlnv(), "--SCPUS=2"]);
        assert!(passed.status.success() && text(&passed).contains("PASS: 13 pairs"), "{}", text(&passed));
        spoil(package.path(), PACKER[0], PACKER[1], PACKER[2]);
        let failed = run(&["run", "--target=sim", "--clean", &afu.vlnv()]);
        assert!(!failed.status.success() && text(&failed).contains("FAIL: "), "{}", text(&failed));
        // The constraints are passed to the tool that reads them.
        let set_up = run(&["run", "--setup", "--target=default", "--tool=vivado", &afu.vlnv()]);
        assert!(set_up.status.success(), "{}", text(&set_up));
        let mut script = Command::new("grep");
        script.args(["-rlE", "read_xdc.*contact_afu.xdc", "build"]).current_dir(room.path());
        assert!(script.output().unwrap().status.success());
    }
}

/// A core's name identifies its AFU: no two AFUs share a name.
#[test]
fn a_core_is_named_after_its_configuration() {
    let name = |config: &Config| generate(config.clone()).vlnv();
    assert!(name(&Config::shipped()).starts_with("contact-afu:afu:afu_top:"));
    let other = Config { profile: "paper+zero".parse().unwrap(), prefix: Some("left".into()), ..Config::shipped() };
    assert!(name(&other).starts_with("contact-afu:afu:left_afu_top-profile-paper-zero:"), "{}", name(&other));
    let slow = Config { clock_mhz: 62.5, ..Config::shipped() };
    assert!(name(&slow).starts_with("contact-afu:afu:afu_top-clock-62_5:"), "{}", name(&slow));
}
