//! `afu spheres`: sets as files, and what touches.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

fn afu(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("afu").expect("the program is built").current_dir(folder).args(arguments).assert()
}

/// The paper's diamond has as many contacts as its pairs do, from its name, from files, and in another order.
#[test]
fn a_set_and_its_files_touch_alike() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let contacts = |arguments: &[&str]| {
        let arguments = [&["spheres"], arguments, &["--json", "-"]].concat();
        let output = afu(room.path(), &arguments).success().get_output().stdout.clone();
        let report: serde_json::Value = serde_json::from_slice(&output).expect("JSON");
        assert_eq!(report["schema"], "contact-afu/spheres/1");
        (report["spheres"].as_u64(), report["candidates"].as_u64(), report["contacts"].as_u64())
    };
    let expected = (Some(1159), Some(12_354), Some(2934));
    assert_eq!(contacts(&["diamond:10"]), expected);
    for (out, sort) in [("d.csv", false), ("s.npy", true)] {
        let arguments = ["spheres", "diamond:10", "--out", out, "--sort"];
        afu(room.path(), &arguments[..if sort { 5 } else { 4 }]).success();
        assert_eq!(contacts(&[out]), expected, "{out}");
    }
    assert_eq!(fs::metadata(room.path().join("s.npy")).expect("written").len(), 128 + 1159 * 16);
    assert_eq!(contacts(&["diamond:10", "--profile", "exact", "--box-bits", "12"]).2, Some(2934));
}

#[test]
fn hits_name_both_spheres() {
    let room = tempfile::tempdir().expect("a temporary folder");
    fs::write(room.path().join("a.csv"), "x,y,z,r\n0,0,0,1\n9,0,0,1\n").expect("written");
    fs::write(room.path().join("b.csv"), "r,z,y,x\n1,0,0,7.5\n1,0,0,-1\n").expect("written");
    afu(room.path(), &["spheres", "a.csv", "--against", "b.csv", "--hits", "h.csv"]).success();
    let text = fs::read_to_string(room.path().join("h.csv")).expect("written");
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows[0], "first,second,flow,pos_x,pos_y,pos_z,normal_x,normal_y,normal_z,depth");
    assert_eq!(rows[1..], ["1,0,real,8.25,0,0,1,0,0,0.5", "0,1,real,-0.5,0,0,1,0,0,1"]);
    afu(room.path(), &["spheres", "probes:3:5", "--out", "p.csv", "--out-against", "q.csv"]).success();
    let lines = |file: &str| fs::read_to_string(room.path().join(file)).expect("written").lines().count();
    assert_eq!((lines("p.csv"), lines("q.csv")), (6, 4));
}

#[test]
fn wrong_spheres_are_one_clear_error() {
    let room = tempfile::tempdir().expect("a temporary folder");
    fs::write(room.path().join("a.csv"), "x,y,z,r\n0,0,0,one\n").expect("written");
    for (arguments, expected) in [
        (&["spheres", "a.csv"][..], "a.csv, line 2, field r:"),
        (&["spheres", "gas:5"], "unknown set of spheres `gas:5`"),
        (&["spheres", "gas:5:2"], "expected a filled part from 0.001 to 0.74, found `2`"),
        (&["spheres", "diamond:3", "--profile", "paper"], "underflows"),
        (&["spheres", "diamond:3", "--box-bits", "9"], "boxes of 9 bits: expected 10 to 32"),
        (&["spheres", "diamond:3", "--hits", "h.txt"], "the name must end in .csv or .npy"),
        (&["spheres", "probes:3:3", "--out", "h.csv"], "--out-against FILE"),
        (&["spheres", "diamond:3", "--out", "h.csv", "--out-against", "g.csv"], "leave out --out-against"),
        (&["spheres", "probes:3:3", "--against", "a.csv"], "leave out --against"),
    ] {
        let said = String::from_utf8(afu(room.path(), arguments).code(2).get_output().stderr.clone()).expect("UTF-8");
        assert!(said.starts_with("afu: ") && said.contains(expected), "{said}");
        assert_eq!(fs::read_dir(room.path()).expect("a folder").count(), 1, "nothing is written: {said}");
    }
}

/// The table of docs/spheres.md has the figures of its command.
#[test]
fn the_documented_counts_are_today_s() {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/spheres.md")).expect("the page");
    let rows: Vec<Vec<&str>> = page
        .lines()
        .filter(|line| line.starts_with("| `diamond:") || line.starts_with("| `gas:") || line.starts_with("| `probes:"))
        .map(|line| line.trim_matches(['|', ' ']).split(" | ").collect())
        .filter(|cells: &Vec<&str>| cells.len() == 6)
        .collect();
    assert_eq!(rows.len(), 5);
    for row in rows {
        let set = row[0].trim_matches('`');
        let counts = |sort: &[&str]| {
            let arguments = [&["spheres", set, "--json", "-", "--contact", "hit"], sort].concat();
            let output = afu(Path::new("."), &arguments).success().get_output().stdout.clone();
            let report: serde_json::Value = serde_json::from_slice(&output).expect("JSON");
            ["contacts", "candidates", "column_tests"].map(|key| report[key].as_u64().expect("a count"))
        };
        let [contacts, candidates, tests] = counts(&[]);
        let expected = [contacts, candidates, tests, counts(&["--sort"])[2]];
        let documented: Vec<u64> =
            row[2..].iter().map(|cell| cell.replace(' ', "").parse().expect("a number")).collect();
        assert_eq!(documented, expected, "{set}");
    }
}
