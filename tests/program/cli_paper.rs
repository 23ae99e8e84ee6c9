//! `afu paper` from the user's side: its outputs, its errors, and its page in a browser.

use assert_cmd::Command;
use std::fs;

fn afu(arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("afu").expect("the program");
    command.args(arguments).assert()
}

#[test]
fn a_browser_that_sees_something_wrong_says_so() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let page = room.path().join("page.html");
    let opened = |body: &str| {
        fs::write(&page, format!("<!DOCTYPE html><title>x</title>{body}")).expect("written");
        crate::browser::open(&page)
    };
    let good = opened("<p>good</p>");
    assert!(good.dom.contains("<p>good</p>") && good.console.is_empty() && good.fetched.is_empty(), "{good:?}");
    let bad = opened("<script>console.error('a planted error')</script><img src='http://127.0.0.1:9/planted.png'>");
    assert!(bad.console.iter().any(|line| line.contains("a planted error")), "{bad:?}");
    assert!(bad.fetched.iter().any(|url| url.ends_with("planted.png")), "{bad:?}");
}

#[cfg(not(feature = "ode"))]
#[test]
fn without_ode_the_command_says_what_to_do() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let out = room.path().join("out");
    let told = afu(&["paper", "--out", out.to_str().expect("a path")]).code(3);
    let text = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
    assert!(text.contains("./scripts/setup --ode && cargo run --release --features ode -- paper --out"), "{text}");
    assert!(!out.exists());
}

/// Checks the files and figures of a small run and its page in Chromium. A second run reuses all simulations.
#[cfg(feature = "ode")]
#[test]
fn a_run_is_written_whole_shown_in_a_browser_and_resumed() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let out = room.path().join("out");
    let run =
        ["paper", "--quick", "--n-col-max", "1000", "--transactions", "2", "--out", out.to_str().expect("a path")];
    let told = afu(&run).success();
    let text = String::from_utf8_lossy(&told.get_output().stdout).into_owned();
    assert!(text.contains("ODE, loop of calls (measured)") && text.contains("report.html"), "{text}");

    let json = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(out.join(name)).expect("written")).expect("JSON")
    };
    let results = json("results.json");
    assert_eq!(results["schema"], "contact-afu/paper/1");
    let points = results["points"].as_array().expect("points");
    assert_eq!(points.len(), 11);
    for point in points {
        let number = |key: &str| point[key].as_f64().expect("a number");
        let n = number("collisions");
        assert_eq!(number("afu_contacts"), n, "the AFU finds every collision that ODE found");
        // The AFU has a cost per pair and before the first pair, and ODE's time is positive.
        assert!(number("afu_cycles") > n && number("afu_cycles") >= number("link_limit_ns") / 5.0, "{point}");
        assert!(number("afu_least_cycles") <= number("afu_most_cycles") && point["afu_transactions"] == 2);
        assert!(number("afu_total_ns") > number("afu_ns") && number("ode_loop_ns") > n && number("batch_ns") > 0.0);
        assert!(number("ode_rule_ns") > 0.0 && number("ode_loop_median_ns") >= number("ode_loop_ns"));
    }
    assert_eq!(results["summary"]["collisions"], 1000);
    assert!(results["claims"].as_array().is_some_and(|claims| claims.len() == 7));

    let csv = fs::read_to_string(out.join("figure6.csv")).expect("written");
    assert_eq!(csv.lines().count(), 12);
    for svg in ["figure6.svg", "figure7.svg", "per-collision.svg"] {
        assert!(fs::read_to_string(out.join(svg)).expect("written").ends_with("</svg>"), "{svg}");
    }
    seen(&out);

    let kept = || {
        let files = fs::read_dir(out.join("measurements")).expect("written").map(|file| file.expect("a file"));
        let written =
            |file: fs::DirEntry| (file.path(), file.metadata().and_then(|file| file.modified()).expect("a time"));
        files.map(written).collect::<std::collections::BTreeMap<_, _>>()
    };
    let before = kept();
    assert_eq!(before.len(), 11);
    afu(&run).success();
    assert_eq!(kept(), before, "nothing is simulated again");

    // The stored results are for these collisions. Other collisions are a different task.
    let other = ["paper", "--quick", "--n-col-max", "100", "--t-col", "fake", "--transactions", "1", "--out", run[7]];
    afu(&other).success();
    let results = json("results.json");
    let points = results["points"].as_array().expect("points");
    assert_eq!((points.len(), &points[0]["afu_contacts"]), (2, &serde_json::json!(0)), "fake ones are no contacts");
}

#[cfg(feature = "ode")]
fn seen(out: &std::path::Path) {
    let page = crate::browser::open(&out.join("report.html"));
    assert!(page.console.is_empty(), "{:#?}", page.console);
    assert!(page.fetched.is_empty(), "{:#?}", page.fetched);
    // Two figures, each drawn for a wide and for a narrow screen. Figure 7 is left out: it begins where a run of at
    // most a thousand collisions ends.
    assert_eq!(page.dom.matches("<svg class=\"plot\"").count(), 4);
    // Each plot has six series, each drawn with eleven points.
    assert_eq!(page.dom.matches("data-series=").count(), 24);
    let longest = page.dom.split(" d=\"M").skip(1).filter_map(|rest| rest.split('"').next());
    assert!(longest.filter(|path| path.matches('L').count() == 10).count() >= 24);
    for text in
        ["Figure 6: time for 10 to 1000 real collisions", "measured here", "simulated, harp1", "15.7 % less time"]
    {
        assert!(page.dom.contains(text), "{text}");
    }
    for svg in ["figure6.svg", "figure7.svg", "per-collision.svg"] {
        let alone = crate::browser::open(&out.join(svg));
        assert!(
            alone.console.is_empty() && alone.fetched.is_empty() && alone.dom.contains("data-series="),
            "{svg}: {alone:?}"
        );
    }
}

#[cfg(feature = "ode")]
#[test]
fn bad_parameters_are_bad_usage() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let out = room.path().join("out");
    let out = out.to_str().expect("a path");
    for (options, words) in [
        (["--h-max", "0"], "the number of layers is 0: expected 1 to 40"),
        (["--d-sph", "-2"], "the gap between spheres is -2: expected -1"),
        (["--t-col", "soft"], "possible values: fake, real, grazing"),
        (["--n-col-max", "9"], "9 is not in 10..=1000000"),
        (["--executions", "0"], "0 is not in 1..=10000"),
        (["--link", "wire"], "unknown link `wire`"),
        (["--query", "sphere-plane"], "the paper's experiment is for sphere-sphere only"),
    ] {
        let told = afu(&[&["paper", "--quick", "--out", out][..], &options].concat()).code(2);
        let text = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
        assert!(text.contains(words), "{words}: {text}");
    }
    let foreign = room.path().join("foreign");
    fs::create_dir(&foreign).expect("made");
    fs::write(foreign.join("mine"), "x").expect("written");
    afu(&["paper", "--quick", "--out", foreign.to_str().expect("a path")]).code(2);
}
