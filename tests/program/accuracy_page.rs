//! The page of `afu accuracy` in a browser, and `afu choose`, both with the results that are part of the crate.

use assert_cmd::Command;
use contact_afu::accuracy::trade::{Bounds, Study, Time, choose, committed, front, page, steps, write};
use contact_afu::afu::{Afu, Spec};
use contact_afu::config;
use contact_afu::synth::Unit;
use std::fs;

fn results() -> Study {
    committed().expect("results that this version reads")
}

/// The text from `from` to the next `to`.
fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    let begin = text.find(from).unwrap_or_else(|| panic!("{from} is missing")) + from.len();
    &text[begin..begin + text[begin..].find(to).unwrap_or_else(|| panic!("{to} is missing"))]
}

#[test]
fn points_are_there_pointing_shows_a_row_and_headings_sort() {
    let results = results();
    let room = tempfile::tempdir().expect("a temporary folder");
    let file = room.path().join("report.html");
    let made = page(&results);
    fs::write(&file, &made).expect("written");
    let opened = crate::browser::open(&file);
    assert!(opened.console.is_empty(), "{:#?}", opened.console);
    assert!(opened.fetched.is_empty(), "{:#?}", opened.fetched);
    // Each of the three pictures is drawn for a wide and for a narrow screen.
    assert_eq!(opened.dom.matches("<svg class=\"plot\"").count(), 6);
    for point in &results.points {
        assert!(opened.dom.contains(&format!("data-point=\"{}\"", point.name)), "{} is not drawn", point.name);
    }

    // Acts as a reader: hovers over a point and clicks on a heading twice. The page's policy allows only its own
    // script.
    let hand = "<script>\
        document.querySelector('[data-point=\"wide\"]').dispatchEvent(new PointerEvent('pointerover', {bubbles: true}));\
        const luts = [...document.querySelectorAll('#points th')].find(head => head.textContent === 'LUTs');\
        luts.click(); luts.click();</script>";
    let policy = between(&made, "<meta http-equiv=\"Content-Security-Policy\"", ">").to_owned();
    let handled = made.replace(&policy, "").replace("</body>", &format!("{hand}</body>"));
    fs::write(&file, handled).expect("written");
    let opened = crate::browser::open(&file);
    assert!(opened.console.is_empty(), "{:#?}", opened.console);
    let row = between(&opened.dom, "<aside id=\"row\"", "</aside>");
    let wide = results.point("wide").expect("wide is there");
    assert!(row.contains(">configuration</small> wide<"), "{row}");
    assert!(row.contains(&format!("{:.2}", wide.lone_ns())), "{row}");
    let body = between(&opened.dom, "<tbody>", "</tbody>");
    let names: Vec<&str> = body.split("data-name=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert_eq!(names.len(), results.points.len());
    let luts = |name: &str| results.point(name).and_then(|point| point.area()).map_or(0, |area| area.luts);
    assert!(names.windows(2).all(|two| luts(two[0]) >= luts(two[1])), "most first, the unknown last: {names:?}");

    // A foreign script has no effect.
    let strange = made.replace("</body>", "<script>document.title = 'strange'</script></body>");
    fs::write(&file, strange).expect("written");
    let opened = crate::browser::open(&file);
    assert!(!opened.dom.contains("<title>strange") && !opened.console.is_empty(), "the policy holds");
}

#[test]
fn files_hold_every_point_and_steps_are_computed() {
    let results = results();
    let room = tempfile::tempdir().expect("a temporary folder");
    write(&results, room.path()).expect("written");
    let csv = fs::read_to_string(room.path().join("results.csv")).expect("written");
    assert_eq!(csv.lines().count(), results.points.len() + 1);
    let json = fs::read(room.path().join("results.json")).expect("written");
    let read: Study = serde_json::from_slice(&json).expect("results");
    assert!(read.points.iter().map(|point| &point.name).eq(results.points.iter().map(|point| &point.name)));
    for svg in ["front.svg", "throughput.svg", "link.svg"] {
        let text = fs::read_to_string(room.path().join(svg)).expect("written");
        assert!(text.contains("data-point=\"wide\"") && text.ends_with("</svg>"), "{svg}");
    }
    for (time, sentences) in steps(&results) {
        let front = front(&results, time, |point| results.is_comparable(point));
        assert_eq!(sentences.len(), front.len().saturating_sub(1));
        for (sentence, to) in sentences.iter().zip(&front[1..]) {
            let to = &results.points[*to];
            assert!(sentence.contains(&format!(" to {}: ", to.name)), "{sentence}");
            assert!(sentence.contains(&format!("{:.1e}", results.worst(to))), "{sentence}");
        }
    }
}

#[test]
fn the_picture_in_the_docs_is_that_of_the_committed_study() {
    let room = tempfile::tempdir().expect("a temporary folder");
    write(&results(), room.path()).expect("written");
    let drawn = fs::read_to_string(room.path().join("front.svg")).expect("written");
    expect_test::expect_file!["../../docs/img/accuracy.svg"].assert_eq(&drawn);
}

/// The study is that of today's hardware: every SCPU in it takes as many cycles as the one that is generated now.
#[test]
fn every_point_has_the_cycles_of_today_s_hardware() {
    for point in &results().points {
        let latency = Unit::scpu(&point.config).expect("an SCPU").latency;
        assert_eq!(latency, Some(point.scpu_cycles), "{}: make the study again (docs/accuracy.md)", point.name);
    }
}

#[test]
fn the_columns_that_the_page_is_about_come_first() {
    let made = page(&results());
    let heading = between(&made, "<thead>", "</thead>");
    let names: Vec<&str> = heading.split("</th>").filter_map(|cell| cell.rsplit('>').next()).collect();
    assert_eq!(names[..4], ["configuration", "largest error", "latency, ns", "link, ns per pair"], "{names:?}");
    // Errors of billions of units are written as powers of ten instead of with all digits.
    let body = between(&made, "<tbody>", "</tbody>");
    let cells: Vec<&str> = body.split("</td>").filter_map(|cell| cell.rsplit('>').next()).collect();
    let whole = |cell: &&str| cell.split_once('.').filter(|_| !cell.contains('e')).map_or(0, |(whole, _)| whole.len());
    assert!(cells.iter().any(|cell| cell.ends_with("e10")), "no error of billions of units is left to show");
    assert!(cells.iter().all(|cell| whole(cell) <= 6 || cell.parse::<f64>().is_err()));
}

/// If points have routed clocks, the front is solid and connects only filled points; the other points are hollow.
#[test]
fn a_routed_point_is_filled_and_on_a_solid_front() {
    let mut results = results();
    for point in &mut results.points {
        let hardware = point.hardware.as_mut().expect("the study counted cells");
        hardware.routed_mhz = ["wide", "wide+faithful", "exact"].contains(&point.name.as_str()).then_some(91.0);
    }
    let wide = results.point("wide").expect("wide is there");
    assert!((wide.lone_ns() - wide.cycles.lone as f64 * 1000.0 / 91.0).abs() < 1e-9, "times are at the routed clock");
    for (time, steps) in steps(&results) {
        assert!(steps.len() < 3, "{time:?}: only what was routed is on a front: {steps:?}");
    }
    let room = tempfile::tempdir().expect("a temporary folder");
    let file = room.path().join("report.html");
    fs::write(&file, page(&results)).expect("written");
    let opened = crate::browser::open(&file);
    assert!(opened.console.is_empty(), "{:#?}", opened.console);
    let front = between(&opened.dom, "<g data-series=\"front, placed and routed\">", "</g>");
    assert!(front.contains("Solid") && !front.contains("Dotted"), "{front}");
    let of_model = "<g data-series=\"clock by the delay model, not routed\">";
    let drawn = between(&opened.dom, "<g data-series=\"placed and routed\">", of_model);
    assert_eq!(drawn.matches("data-point=").count(), 3, "{drawn}");
    assert!(drawn.contains("data-point=\"wide\"") && !drawn.contains("hollow"), "{drawn}");
    let model = between(&opened.dom, of_model, "</svg>");
    assert_eq!(model.matches("data-point=").count(), results.points.len() - 3);
    assert!(model.contains("hollow") && !model.contains("data-point=\"wide\""));
    assert!(between(&opened.dom, "data-name=\"wide\"", "</tr>").contains(">91<"), "the row has the routed clock");
}

#[test]
fn a_choice_meets_its_bounds_and_is_the_cheapest() {
    let results = results();
    let bounds = Bounds { error: Some(1e-6), bad: Some(0.0), ..Bounds::default() };
    let chosen = choose(&results, &bounds, Time::Lone).expect("wide at least");
    let luts = |name: &str| results.point(name).and_then(|point| point.area()).expect("an area").luts;
    assert!(results.worst(chosen) <= 1e-6 && chosen.tally().bad == 0);
    assert!(luts(&chosen.name) <= luts("wide"), "{}", chosen.name);

    // Configurations without a routed clock are not chosen, unless nothing was routed.
    assert!(chosen.routed_mhz().is_some(), "{}", chosen.name);
    let mut modelled = results.clone();
    modelled.points.iter_mut().for_each(|point| *point = point.unrouted());
    let of_all = choose(&modelled, &bounds, Time::Lone).expect("more to choose from");
    assert!(modelled.comparable().count() > results.comparable().count());
    assert!(of_all.area().expect("an area").luts < luts(&chosen.name), "{}", of_all.name);

    // If the bound is below every configuration's time, the error names the smallest possible time.
    let impossible = Bounds { ns: Some(1.0), ..bounds };
    let instead = choose(&results, &impossible, Time::Lone).expect_err("nothing is as fast");
    assert!(instead.iter().any(|instead| instead.value > 1.0 && results.worst(instead.point) <= 1e-6), "{instead:?}");
}

#[test]
fn choose_writes_what_config_reads() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let file = room.path().join("chosen.json");
    let afu_choose = |arguments: &[&str]| {
        let mut command = Command::cargo_bin("afu").expect("the program");
        command.arg("choose").args(arguments).assert()
    };
    let out = file.to_str().expect("a path");
    let told = afu_choose(&["--max-error", "1e-6", "--max-bad", "0", "--max-luts", "100000", "--out", out]).success();
    let text = String::from_utf8_lossy(&told.get_output().stdout).into_owned();
    assert!(text.contains("LUTs") && text.contains("afu accuracy "), "{text}");
    let config = config::read(&file).expect("a configuration");
    assert!(text.starts_with(&config.profile.to_string()), "{text}");
    config.check().expect("one that can be generated");
    // The configuration has the stages that were routed, at the clock that the router reached.
    let results = results();
    let name = text.split(':').next().expect("a name");
    let point = results.point(name).expect("the point that it names");
    let routed = point.routed_mhz().expect("a routed one");
    assert!((0.0..0.01).contains(&(routed - config.clock_mhz)) && config.clock_mhz < 200.0, "{routed}: {config:?}");
    let afu = Afu::generate(Spec::from(config)).expect("an AFU");
    assert_eq!(afu.kernel().latency, point.scpu_cycles);

    let told = afu_choose(&[]).code(2);
    let text = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
    for bound in ["--max-error", "--max-ns", "--max-luts", "--max-bad"] {
        assert!(text.contains(bound) && text.lines().count() == 1, "{text}");
    }

    let told = afu_choose(&["--max-error", "1e-12"]).code(1);
    let text = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
    assert!(text.contains("no configuration meets these bounds") && text.contains("could be met"), "{text}");
    afu_choose(&["--max-error", "-1"]).code(2);
    afu_choose(&["--max-error", "1", "--from", out]).code(2);
}
