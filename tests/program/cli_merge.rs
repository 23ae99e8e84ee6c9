//! Studies that several processes work on, and `afu merge`.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Stdio;
use std::thread;
use std::time::Duration;

use assert_cmd::Command;
use contact_afu::tools::Program;

/// Counts cells, two or three seconds per unit.
const STUDY: [&str; 9] =
    ["synth", "--operator", "greater,halve,add", "--no-route", "--profile", "half", "--clock", "150", "--store"];

/// The program, with a folder for netlists that no other test shares.
fn afu(room: &Path) -> Command {
    let mut command = Command::cargo_bin("afu").expect("the program is built");
    command.current_dir(room).env("AFU_CACHE", room.join("cache"));
    command
}

fn stderr(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).expect("UTF-8")
}

/// The names and bytes of the files of a folder, in order, without folders.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all: Vec<_> = fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.is_file())
        .map(|path| (path.file_name().expect("a name").to_string_lossy().into_owned(), fs::read(&path).expect("read")))
        .collect();
    all.sort();
    all
}

#[test]
fn one_shard_several_and_none_give_the_same_bytes() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let whole = [&STUDY[..8], &["--out", "whole"]].concat();
    afu(room.path()).args(whole).assert().success();
    let mut of_four = 0;
    for of in [1, 4] {
        let store = format!("store{of}");
        for shard in 1..=of {
            let shard = format!("{shard}/{of}");
            let told = afu(room.path()).args(STUDY).args([&store, "--shard", &shard]).assert().success();
            let said = stderr(&told);
            if of == 4 {
                of_four += said.lines().count();
                assert!(said.lines().all(|line| line.starts_with(&format!("shard {shard}: "))), "{said}");
            } else {
                let lines: Vec<&str> = said.lines().collect();
                assert!(lines[0].starts_with("shard 1/1: 1 of 3 points done, 2 left, about "), "{said}");
                assert_eq!(lines[2], "shard 1/1: 3 of 3 points done, 0 left");
            }
            assert!(told.get_output().stdout.is_empty(), "a shard has no results");
        }
        let out = format!("merged{of}");
        afu(room.path()).args(["merge", "--store", &store, "--out", &out]).assert().success();
        assert_eq!(files(&room.path().join(&out)), files(&room.path().join("whole")), "{of} shards");
    }
    assert_eq!(of_four, 3, "each point is in one of four shards, and told of once");
    assert_eq!(files(&room.path().join("whole")).len(), 3, "a page, a table, the figures");

    // A longer list moves no point: what is there is found, and one point is left.
    let longer = ["synth", "--operator", "greater,halve,mul,add", "--no-route", "--profile", "half", "--clock", "150"];
    let told = afu(room.path()).args(longer).args(["--store", "store4", "--limit", "1"]).assert().success();
    assert_eq!(stderr(&told), "4 of 4 points done, 0 left\n");
    let told = afu(room.path()).args(["merge", "--store", "store4", "--out", "both"]).assert().code(2);
    let said = stderr(&told);
    assert!(said.contains("there are 2 studies; choose one:"), "{said}");
    let name = said
        .lines()
        .find(|line| line.ends_with("--operator greater,halve,mul,add --no-route --profile half --clock 150"));
    let name = name.and_then(|line| line.split_whitespace().nth(1)).expect("a line per study, with its command");
    afu(room.path()).args(["merge", "--store", "store4", "--out", "both", "--study", name]).assert().success();
}

/// A Yosys that fails for one operator, two times.
fn unlucky_yosys(room: &Path) -> std::path::PathBuf {
    let yosys = Program::yosys().expect("the tests' set-up has Yosys");
    let fake = room.join("yosys");
    let (times, real) = (room.join("times"), yosys.command().get_program().to_owned());
    let text = format!(
        "#!/bin/sh\ncase \"$*\" in *halve*) if [ \"$(cat '{times}' | wc -l)\" -lt 2 ]; then\n\
         echo once >>'{times}'; echo 'out of luck' >&2; exit 1\nfi;; esac\nexec '{}' \"$@\"\n",
        real.display(),
        times = times.display(),
    );
    fs::write(times, "").expect("written");
    fs::write(&fake, text).expect("written");
    fs::set_permissions(&fake, fs::Permissions::from_mode(0o755)).expect("set");
    fake
}

#[test]
fn a_point_that_fails_is_recorded_with_its_error_and_tried_again() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let fake = unlucky_yosys(room.path());
    let study = || {
        let mut command = afu(room.path());
        command.env("AFU_YOSYS", &fake).args(STUDY).args(["store", "--shard", "1/1"]);
        command
    };
    let merge = |out: &str| afu(room.path()).args(["merge", "--store", "store", "--out", out]).assert();

    let none = afu(room.path()).args(["merge", "--store", "store", "--out", "none"]).assert().code(2);
    assert!(stderr(&none).contains("there is no study; `afu sweep`"), "{}", stderr(&none));
    study().args(["--limit", "1"]).assert().success();
    let early = merge("early").code(1);
    let said = stderr(&early);
    assert!(said.starts_with("missing: halve half, ecp5 at 150 MHz\nmissing: add half"), "{said}");
    assert!(
        said.ends_with(
            "afu: 3 points: 2 missing, 0 failed; to measure them: \
             afu synth --operator greater,halve,add --no-route --profile half --clock 150 --store store\n"
        ),
        "{said}"
    );
    let page = fs::read_to_string(room.path().join("early/report.html")).expect("written");
    assert!(page.contains("Missing: </b>halve half, ecp5 at 150 MHz; add half"), "{page}");
    let needs = afu(room.path()).args(["merge", "--store", "store", "--needs", "2"]).assert().success();
    let needs = String::from_utf8_lossy(&needs.get_output().stdout).into_owned();
    // A busy machine takes longer: the minutes are those of the seconds that were measured.
    let figure = |name: &str| -> f64 {
        let value = needs.split_whitespace().find_map(|part| part.strip_prefix(name)?.strip_prefix('='));
        value.and_then(|value| value.parse().ok()).unwrap_or_else(|| panic!("{name}: {needs}"))
    };
    assert!(needs.starts_with("points=3 measured=1 mean_seconds="), "{needs}");
    let [mean, longest, shard] = ["mean_seconds", "longest_seconds", "shard_seconds"].map(figure);
    assert!(mean > 0.0 && mean == longest, "one point was measured: {needs}");
    // Two shards have the two points that are left: one each, or one of them both. Their seconds are rounded.
    assert!((mean - 1.0..=2.0 * mean + 1.0).contains(&shard), "{needs}");
    let minutes = |shard: f64| ((1.5 * shard + longest) / 60.0).ceil() + 1.0;
    assert!((minutes(shard - 0.51)..=minutes(shard + 0.51)).contains(&figure("time_minutes")), "{needs}");

    for tried in ["", " (tried 2 times)"] {
        let failed = format!("halve half, ecp5 at 150 MHz{tried}: Yosys failed on halve half:\nout of luck\n");
        let said = stderr(&study().assert().code(1));
        assert!(said.ends_with(&format!("afu: {failed}")), "{said}");
        let told = merge("some").code(1);
        assert!(stderr(&told).starts_with(&format!("failed: {failed}afu: 3 points: 0 missing, 1 failed; ")));
        assert!(String::from_utf8_lossy(&told.get_output().stdout).contains("add half, ecp5"), "the others are there");
    }
    study().assert().success();
    merge("all").success();
    assert_eq!(fs::read_to_string(room.path().join("times")).expect("written").lines().count(), 2);
    assert!(fs::read_dir(room.path().join("store")).expect("there").all(|entry| {
        let path = entry.expect("an entry").path();
        path.is_dir() || path.extension().is_some_and(|of| of == "json")
    }));
}

/// What a killed process leaves behind is a claim that says nothing new.
#[test]
fn a_point_of_a_killed_process_is_taken_up() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let yosys = Program::yosys().expect("the tests' set-up has Yosys");
    let slow = room.path().join("yosys");
    let (begun, real) = (room.path().join("begun"), yosys.command().get_program().to_owned());
    let text = format!(
        "#!/bin/sh\ncase \"$*\" in *read_verilog*) echo $$ >>'{}'; exec sleep 600;; esac\nexec '{}' \"$@\"\n",
        begun.display(),
        real.display()
    );
    fs::write(&slow, text).expect("written");
    fs::set_permissions(&slow, fs::Permissions::from_mode(0o755)).expect("set");
    let program = assert_cmd::cargo::cargo_bin!("afu");
    let mut killed = std::process::Command::new(program);
    killed.current_dir(room.path()).env("AFU_CACHE", room.path().join("cache")).env("AFU_YOSYS", &slow);
    let mut killed = killed.args(STUDY).arg("store").stderr(Stdio::null()).stdout(Stdio::null()).spawn().expect("runs");
    while !begun.exists() {
        thread::sleep(Duration::from_millis(50));
    }
    // What it works on is left to it.
    let live = afu(room.path()).args(STUDY).args(["store", "--shard", "1/1"]).assert().success();
    assert!(stderr(&live).contains("2 of 3 points done, 1 left"), "{}", stderr(&live));
    afu(room.path()).args(["merge", "--store", "store", "--out", "out"]).assert().code(1);

    killed.kill().and_then(|()| killed.wait()).expect("killed");
    for process in fs::read_to_string(&begun).expect("written").lines() {
        // The process that slept belongs to nobody now.
        let _ = std::process::Command::new("kill").arg(process).status();
    }
    afu(room.path()).args(STUDY).args(["store", "--shard", "1/1", "--lease", "2"]).assert().success();
    afu(room.path()).args(["merge", "--store", "store", "--out", "out"]).assert().success();
}

#[test]
fn wrong_options_of_a_shared_study_are_exit_2() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for (arguments, words) in [
        (&["synth", "--shard", "1/2"][..], "--store <DIR>"),
        (&["synth", "--store", "s", "--shard", "3/2"], "expected K/M with 1 ≤ K ≤ M"),
        (&["synth", "--store", "s", "--shard", "1/2", "--out", "o"], "cannot be used with"),
        (&["synth", "--store", "s", "--shard", "1/2", "--json", "-"], "cannot be used with"),
        (&["sweep", "--lease", "5", "--out", "o"], "--store <DIR>"),
        (&["sweep"], "--out <DIR>"),
        (&["merge", "--store", "s"], "--out <DIR>"),
        (&["merge", "--store", "s", "--needs", "0"], "0 is not in 1..="),
        (&["merge", "--store", "s", "--out", "o", "--study", "abc"], "there is no study abc"),
    ] {
        let said = stderr(&afu(room.path()).args(arguments).assert().code(2));
        assert!(said.contains(words), "{arguments:?}: {said}");
        assert_eq!(fs::read_dir(room.path()).expect("there").count(), 0, "{arguments:?}");
    }
}
