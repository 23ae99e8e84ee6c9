//! `afu sweep`: a table with one row per number of SCPUs, written row by row and resumed.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn afu(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("afu").expect("the program is built").current_dir(folder).args(arguments).assert()
}

/// A sweep behind AXI4: the narrow bus is what limits two SCPUs.
#[test]
fn a_sweep_behind_axi_is_limited_by_its_bus() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let sweep = ["sweep", "--scpus", "1,4", "--pairs", "diamond:5", "--profile", "e8f3z", "--contact", "hit,depth"];
    let shell = ["--shell", "axi", "--bus", "128", "--out", "out", "--json", "-"];
    let done = afu(room.path(), &[&sweep[..], &shell].concat()).success();
    let json: Value = serde_json::from_slice(&done.get_output().stdout).expect("JSON alone");
    let rows = json["rows"].as_array().expect("rows");
    assert!(rows.iter().all(|row| row["mismatches"] == 0), "{json}");
    let cycles: Vec<f64> = rows.iter().filter_map(|row| row["cycles_per_pair"].as_f64()).collect();
    // Two pairs are a line, and a line is four beats of 128 bits.
    assert!(cycles.len() == 2 && cycles.iter().all(|cycles| (2.0..2.3).contains(cycles)), "{cycles:?}");
}

#[test]
fn a_sweep_has_a_row_for_each_size_and_is_resumed() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let sweep = |list: &str| {
        afu(room.path(), &["sweep", "--scpus", list, "--pairs", "diamond:5", "--out", "out", "--json", "-"]).success()
    };
    let rows = |assert: &assert_cmd::assert::Assert| -> Vec<Value> {
        let json: Value = serde_json::from_slice(&assert.get_output().stdout).expect("JSON alone");
        assert_eq!(json["schema"], "contact-afu/sweep/2");
        json["rows"].as_array().expect("rows").clone()
    };
    let first = sweep("1");
    let first_rows = rows(&first);
    assert_eq!((&first_rows[0]["scpus"], &first_rows[0]["mismatches"]), (&1.into(), &0.into()));
    let cycles = first_rows[0]["cycles_per_pair"].as_f64().expect("a number");
    assert!((1.0..1.2).contains(&cycles), "one SCPU takes a pair a cycle: {cycles}");

    let second = sweep("1,2");
    let second_rows = rows(&second);
    assert_eq!(second_rows[0], first_rows[0], "the first row is kept, build time and all");
    let said = String::from_utf8(second.get_output().stderr.clone()).expect("UTF-8");
    assert!(said.contains("1 of 2 rows come from an earlier run"), "{said}");
    let cycles = second_rows[1]["cycles_per_pair"].as_f64().expect("a number");
    // Half a cycle, and in a job this small as much as two tenths more for its handshake through memory, and because
    // the delay lines are filled first.
    assert!((0.5..0.7).contains(&cycles), "two take two: {cycles}");

    let csv = fs::read_to_string(room.path().join("out/sweep.csv")).expect("written");
    assert!(csv.starts_with("scpus,interval,pairs,") && csv.lines().count() == 3, "{csv}");

    let page = fs::read_to_string(room.path().join("out/report.html")).expect("written");
    let reached = page.split("<g data-series=\"interval 1\">").nth(1).and_then(|rest| rest.split("</g>").next());
    assert_eq!(reached.expect("the line of what was reached").matches("<circle").count(), 2, "a point per row");
    for words in ["link limit", "interval 1, N/1 per cycle", "million pairs per second"] {
        assert!(page.contains(words), "{words}");
    }
    assert!(!page.contains("LUT per SCPU") && !page.contains("NaN"), "nothing was counted");
    assert!(fs::read_to_string(room.path().join("out/throughput.svg")).expect("written").contains("link limit"));

    let manifest = || fs::read(room.path().join("out/manifest.json")).expect("written");
    let before = manifest();
    let read: Value = serde_json::from_slice(&before).expect("JSON");
    assert_eq!(read["swept"], serde_json::json!({"scpus": [1, 2], "interval": [1]}));
    for (arguments, words) in [
        (["--scpus", "1,2", "--pairs", "random:1000"], "holds a sweep of diamond:5, not random:1000"),
        (["--scpus", "1", "--pairs", "diamond:5"], "rows that are not asked for now (SCPUs: 2 at interval 1)"),
    ] {
        let refused = afu(room.path(), &[&["sweep", "--out", "out"][..], &arguments].concat()).code(2);
        let said = String::from_utf8(refused.get_output().stderr.clone()).expect("UTF-8");
        assert!(said.contains(words) && said.contains("--force") && said.lines().count() == 1, "{said}");
        assert_eq!(manifest(), before, "it goes no further");
    }
    afu(room.path(), &["sweep", "--scpus", "1", "--pairs", "random:1000", "--out", "out", "--force"]).success();
    let forced: Value = serde_json::from_slice(&manifest()).expect("JSON");
    assert_eq!((&forced["pairs"], &forced["rows"][0]["pairs"]), (&"random:1000".into(), &1000.into()));

    // The same by two shards: one has the point.
    let options = ["sweep", "--scpus", "1", "--pairs", "random:1000", "--store", "store", "--shard"];
    for shard in ["1/2", "2/2"] {
        afu(room.path(), &[&options[..], &[shard]].concat()).success();
    }
    let merged = afu(room.path(), &["merge", "--store", "store", "--out", "merged"]).success();
    assert!(String::from_utf8_lossy(&merged.get_output().stdout).contains("random:1000 over link ideal, seed 1"));
    let results = ["manifest.json", "sweep.csv", "report.html", "throughput.svg"];
    for file in results {
        let read = |folder: &str| fs::read(room.path().join(folder).join(file)).expect("written");
        assert_eq!(read("merged"), read("out"), "{file}");
    }
    let seconds = fs::read_to_string(room.path().join("merged/host.csv")).expect("written");
    assert!(seconds.starts_with("scpus,interval,build_seconds,simulation_seconds\n1,1,"), "{seconds}");
    assert_eq!(fs::read_dir(room.path().join("merged")).expect("there").count(), results.len() + 1);
}

#[test]
fn wrong_sweeps_are_exit_2_and_leave_no_folder() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for arguments in [
        &["--scpus", "4..1"][..],
        &["--scpus", "1,65"],
        &["--scpus", ""],
        &["--interval", "1,65"],
        &["--pairs", "absent.csv"],
        &["--link", "none"],
    ] {
        afu(room.path(), &[&["sweep", "--out", "out"][..], arguments].concat()).code(2);
        assert_eq!(fs::read_dir(room.path()).expect("there").count(), 0, "{arguments:?}");
    }
    fs::create_dir(room.path().join("theirs")).expect("made");
    fs::write(room.path().join("theirs/file"), "x").expect("written");
    afu(room.path(), &["sweep", "--scpus", "1", "--out", "theirs"]).code(2);
}
