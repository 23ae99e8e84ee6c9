//! `afu accuracy` from the user's side.

use assert_cmd::Command;

fn afu(arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("afu").expect("the program").args(arguments).assert()
}

/// Where ODE is built in, each arithmetic leads the diamond somewhere.
const DRIFTS: usize = cfg!(feature = "ode") as usize;

/// The errors of `paper` are those of binary32, and its times follow from the simulated cycles.
#[test]
fn a_row_a_profile_with_errors_and_times() {
    let told = afu(&["accuracy", "--profile", "paper,e8f11", "--no-synth", "--json", "-"]).success();
    let output = told.get_output();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(text.contains("paper") && text.contains("e8f11") && text.contains("delay model"), "{text}");
    // No terminal: a line per point. Two arithmetics have errors on three sets, and cycles.
    assert_eq!(text.lines().filter(|line| line.contains(" of 2 points done, ")).count(), 8 + 2 * DRIFTS, "{text}");

    let results: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(results["schema"], "contact-afu/accuracy/1");
    let points = results["points"].as_array().expect("points");
    assert_eq!(
        points.iter().map(|point| point["name"].as_str().unwrap_or_default()).collect::<Vec<_>>(),
        ["paper", "e8f11"]
    );
    for point in points {
        let cycles = |name: &str| point["cycles"][name].as_f64().expect("a number");
        assert_eq!(cycles("mismatches"), 0.0, "{point}");
        let stages = point["scpu_cycles"].as_f64().expect("a number");
        assert!(cycles("lone") > stages && cycles("lone") < stages + 40.0, "{point}");
        assert!(cycles("compute") >= 1.0 && cycles("compute") < 1.02, "one SCPU takes a pair a cycle: {point}");
        assert!(cycles("link") >= cycles("link_limit"), "{point}");
        assert!(point["hardware"].is_null(), "nothing was synthesised: {point}");
    }
    let mean = |point: &serde_json::Value, set: usize| point["rows"][set]["errors"]["contact"]["mean"].as_f64();
    assert!(mean(&points[0], 1) < mean(&points[1], 1), "twelve bits less are less accurate");
}

/// The quick study has a page and pictures without areas, and says so. A second run reuses all measurements.
#[test]
fn a_quick_study_needs_no_synthesis() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let folder = room.path().join("study");
    let name = folder.to_str().expect("a path");
    let run = || {
        let told = afu(&["accuracy", "--quick", "--profile", "paper,e8f11", "--out", name]).success();
        String::from_utf8_lossy(&told.get_output().stdout).into_owned()
    };
    let text = run();
    assert!(text.contains("left out: areas") && !text.contains("LUT"), "{text}");
    for (file, there) in [("front.svg", true), ("link.svg", true), ("report.html", true), ("throughput.svg", false)] {
        assert_eq!(folder.join(file).is_file(), there, "{file}");
    }
    let page = std::fs::read_to_string(folder.join("report.html")).expect("the page");
    // Each picture is drawn for a wide and for a narrow screen.
    assert_eq!(page.matches("<svg class=\"plot\"").count(), 4);
    assert!(page.contains("Left out: areas") && !page.contains("LUTs"), "no empty columns");

    // Files left by another run are not presented as this run's.
    std::fs::write(folder.join("throughput.svg"), "of before").expect("written");
    let store = std::fs::read(folder.join("manifest.json")).expect("the store");
    assert_eq!(run(), text);
    assert!(!folder.join("throughput.svg").exists());
    assert_eq!(std::fs::read(folder.join("manifest.json")).expect("the store"), store, "everything was known");

    // By two shards: the same bytes as a run that times no software.
    let [store, merged, alone] = ["store", "merged", "alone"].map(|name| room.path().join(name));
    let path = |path: &std::path::Path| path.to_str().expect("a path").to_owned();
    let study = ["accuracy", "--quick", "--profile", "paper,e8f11"];
    for (shard, code) in [("1/2", 5), ("2/2", 0), ("1/2", 0)] {
        let told =
            afu(&[&study[..], &["--store", &path(&store), "--shard", shard, "--lease", "1"]].concat()).code(code);
        let text = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
        assert_eq!(text.contains("the next stage needs points of other shards"), code == 5, "{text}");
    }
    afu(&["merge", "--store", &path(&store), "--out", &path(&merged)]).success();
    afu(&[&study[..], &["--no-software", "--out", &path(&alone)]].concat()).success();
    for file in ["report.html", "results.json", "results.csv", "front.svg", "link.svg", "manifest.json"] {
        let read = |folder: &std::path::Path| std::fs::read_to_string(folder.join(file)).expect("written");
        assert_eq!(read(&merged), read(&alone), "{file}");
    }
    let page = std::fs::read_to_string(merged.join("report.html")).expect("the page");
    assert!(page.contains("afu accuracy --quick --profile paper,e8f11 --no-software --out DIR"), "{page}");

    let told = afu(&["choose", "--max-luts", "9000", "--from", name]).code(2);
    assert!(String::from_utf8_lossy(&told.get_output().stderr).contains("need areas, which these results lack"));
    afu(&["choose", "--max-error", "1e-3", "--from", name]).success();
    afu(&["accuracy", "--synth", "--out", name]).code(2);
}

#[test]
fn what_cannot_be_is_bad_usage() {
    for (options, words) in [
        (["--link", "wire"], "unknown link `wire`"),
        (["--profile", "e99f1"], "out of range"),
        (["--jobs", "0"], "0 is not in 1..=256"),
    ] {
        let told = afu(&[&["accuracy"][..], &options].concat()).code(2);
        let text = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
        assert!(text.contains(words), "{words}: {text}");
    }
}
