//! `afu sweep`: a table with one row per number of SCPUs, written row by row and resumed.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("afu").expect("the program is built");
    command.current_dir(folder).args(arguments);
    command
}

fn afu(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    command(folder, arguments).assert()
}

/// A sweep behind AXI4: the narrow bus is what limits two SCPUs. Verilator's runtime is compiled once, and is all that
/// the user's folder keeps.
#[test]
fn a_sweep_behind_axi_is_limited_by_its_bus() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let sweep = ["sweep", "--scpus", "1,4", "--pairs", "diamond:5", "--profile", "e8f3z", "--contact", "hit,depth"];
    let shell = ["--shell", "axi", "--bus", "128", "--out", "out", "--json", "-"];
    let cache = room.path().join("cache");
    let done = command(room.path(), &[&sweep[..], &shell].concat()).env("AFU_CACHE", &cache).assert().success();
    let json: Value = serde_json::from_slice(&done.get_output().stdout).expect("JSON alone");
    let rows = json["rows"].as_array().expect("rows");
    assert!(rows.iter().all(|row| row["mismatches"] == 0), "{json}");
    let kept: Vec<_> = fs::read_dir(&cache).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    assert!(kept.len() == 1 && kept[0].join("verilated.o").is_file(), "{kept:?}");
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

/// Fewer bits of a box make more candidates, and the same contacts in any number of lanes.
#[test]
fn a_sweep_of_spheres_has_a_row_for_each_search_and_is_resumed() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let small = ["sweep", "--input", "spheres", "--spheres", "diamond:5+1000", "--table", "512", "--deciders", "1"];
    let sweep = |lanes: &str| {
        let sizes = ["--box-bits", "24,16", "--lanes", lanes, "--out", "out", "--json", "-"];
        let done = afu(room.path(), &[&small[..], &sizes].concat()).success();
        let json: Value = serde_json::from_slice(&done.get_output().stdout).expect("JSON alone");
        assert_eq!((&json["schema"], &json["spheres"]), (&"contact-afu/sweep/2".into(), &"diamond:5+1000".into()));
        (
            json["rows"].as_array().expect("rows").clone(),
            String::from_utf8_lossy(&done.get_output().stderr).into_owned(),
        )
    };
    let (first, _) = sweep("16");
    let (rows, said) = sweep("16,32");
    assert!(said.contains("2 of 4 rows come from an earlier run"), "{said}");
    assert_eq!(rows[..2], first[..]);
    let all = |key: &str| rows.iter().map(|row| row[key].as_u64()).collect::<Option<Vec<_>>>().expect(key);
    assert_eq!((all("lanes"), all("box_bits")), (vec![16, 16, 32, 32], vec![24, 16, 24, 16]));
    assert_eq!((all("mismatches"), all("unmet")), (vec![0; 4], vec![0; 4]));
    assert_eq!(all("contacts"), [264; 4], "as the diamond at the origin");
    let candidates = all("candidates");
    assert!(candidates[1] > candidates[0] && candidates[2..] == candidates[..2], "{candidates:?}");
    for (cycles, predicted) in all("cycles").into_iter().zip(all("predicted_cycles")) {
        assert!(cycles.abs_diff(predicted) * 10 < cycles, "{cycles} and the model's {predicted}");
    }
    let csv = fs::read_to_string(room.path().join("out/sweep.csv")).expect("written");
    assert!(csv.starts_with("lanes,deciders,box_bits,scpus,interval,spheres,"), "{csv}");
    let host = fs::read_to_string(room.path().join("out/host.csv")).expect("written");
    assert!(host.starts_with("lanes,deciders,box_bits,build_seconds,simulation_seconds\n16,1,24,"), "{host}");
    let page = fs::read_to_string(room.path().join("out/report.html")).expect("written");
    assert!(page.contains("candidates per sphere by bits of a box") && page.contains("ns per sphere by lanes"));
    let refused = afu(room.path(), &[&small[..], &["--out", "out"]].concat()).code(2);
    let told = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(told.contains("not asked for now (16 lanes, 1 decider, boxes of 16 bits; 32 lanes, "), "{told}");
}

#[test]
fn pairs_and_spheres_are_not_mixed() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for (arguments, words) in [
        (&["--input", "spheres", "--pairs", "diamond:3"][..], "--pairs does not go with --input spheres"),
        (&["--lanes", "16,32"], "--lanes needs AFUs that take spheres"),
        (&["--sort"], "--sort needs AFUs that take spheres"),
        (&["--input", "spheres", "--interval", "1,2"], "--interval with --input spheres and --contact hit"),
        (&["--input", "spheres", "--table", "512"], "diamond:10: 1159 spheres; the AFU's table holds 512"),
        (&["--input", "spheres", "--box-bits", "9,24"], "boxes of 9 bits: expected 10 to 32"),
    ] {
        let refused = afu(room.path(), &[&["sweep", "--out", "out"][..], arguments].concat()).code(2);
        let told = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(told.contains(words) && told.lines().count() == 1, "{told}");
        assert_eq!(fs::read_dir(room.path()).expect("there").count(), 0, "{arguments:?}");
    }
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
