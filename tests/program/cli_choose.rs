//! `afu choose --scene`: what to build for a scene whose spheres are sent.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use contact_afu::config::{self, Config, Input, Search, Shell};
use contact_afu::link::LinkModel;
use contact_afu::query::Fields;
use contact_afu::scene::{Choice, Plan, Scene};

/// A lattice in which each sphere touches its six neighbours.
const LATTICE: &str = r#"
scene = 1
want = ["touching"]
[[bodies]]
shape = "lattice"
count = [12, 12, 12]
gap = -0.001
radius = 0.5
"#;

fn choice(lines: &str, contact: Fields, link: &LinkModel) -> Choice {
    let scene = Scene::parse("a.toml", lines).expect("a scene");
    let plan = Plan::of(&scene).expect("a plan");
    let base = plan.clone().of_spheres(Search { table: 4096, ..Search::default() }).config;
    let base = Config { contact, shell: Shell::Line, ..base };
    Choice::of(&scene, &plan, &base, link).expect("a choice")
}

fn afu(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("afu").expect("the program is built").current_dir(folder).args(arguments).assert()
}

fn told(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stdout).into_owned()
}

#[test]
fn the_slowest_stage_is_doubled_until_that_gains_no_more() {
    let choice = choice(LATTICE, Fields::HIT, &LinkModel::ideal());
    assert_eq!((choice.spheres, choice.contacts), (1728, 3 * 11 * 12 * 12));
    let first = &choice.before[0];
    assert_eq!((first.config.search.lanes, first.config.search.deciders, first.slowest()), (16, 1, "deciders"));
    let all: Vec<_> = choice.before.iter().chain([&choice.chosen]).collect();
    for pair in all.windows(2) {
        assert!(pair[1].cycles() < 0.9 * pair[0].cycles());
        let [before, after] = [&pair[0].config.search, &pair[1].config.search];
        assert!(after.lanes > before.lanes || after.deciders > before.deciders);
    }
    assert!(choice.chosen.config.search.deciders > 1 && choice.chosen.config.check().is_ok());
    assert_eq!(choice.bytes, 64 * (1728 / 4 + choice.contacts.div_ceil(16)));
    // A slow link sets the pace sooner.
    let slow = LinkModel { lines_per_cycle: 0.02, ..LinkModel::ideal() };
    let by_link = self::choice(LATTICE, Fields::HIT, &slow);
    assert!(by_link.before.len() < choice.before.len());
    assert_eq!(by_link.chosen.slowest(), "link");
}

#[test]
fn contacts_get_the_fewest_scpus_that_keep_up() {
    let many = choice(LATTICE, Fields::ALL, &LinkModel::ideal());
    let Config { scpus, interval, contact, .. } = &many.chosen.config;
    assert_eq!((*scpus, *interval, contact), (2, 1, &Fields::ALL), "{}", many.text());
    // A search as large, and two contacts per cycle, which fill a line. They leave behind the hits, so they take longer
    // than either alone.
    let last = many.before.last().expect("the search for numbers alone");
    assert_eq!(last.config.search, many.chosen.config.search);
    let alone = last.cycles().max(many.contacts as f64 / 2.0);
    assert!(many.chosen.cycles() > alone && many.chosen.cycles() < 1.15 * alone, "{}", many.text());
    let apart = choice(&LATTICE.replace("-0.001", "0.5"), Fields::ALL, &LinkModel::ideal());
    let fewer = &apart.chosen.config;
    assert_eq!((apart.contacts, fewer.scpus), (0, 1));
    assert!(fewer.interval > *interval, "{}", apart.text());
    assert!(apart.text().contains("No spheres touch at the start"));
}

/// The options and the file are the same AFU, which `afu rtl` takes.
#[test]
fn what_is_chosen_can_be_built() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for (want, options) in [("touching", "--interval 1 --contact hit"), ("depth", "--scpus ")] {
        fs::write(room.path().join("a.toml"), LATTICE.replace("touching", want)).expect("written");
        for shell in ["spl2", "line"] {
            let arguments = ["choose", "--scene", "a.toml", "--input", "spheres", "--shell", shell];
            let text = told(&afu(room.path(), &arguments).success());
            for part in ["1 728 spheres", "4 752 contacts", "deciders", "the host finds", "link harp1"] {
                assert!(text.contains(part), "{part} in\n{text}");
            }
            let line = text.lines().find_map(|line| line.strip_prefix("options: ")).expect("options");
            assert!(line.starts_with(options) && line.ends_with(&format!("--shell {shell}")), "{line}");
            afu(room.path(), &[&arguments[..], &["--out", "chosen.json"]].concat()).success();
            let chosen = config::read(&room.path().join("chosen.json")).expect("a configuration");
            let words: Vec<&str> = line.split(' ').collect();
            afu(room.path(), &[&["rtl", "--force", "--out", "built"], &words[..]].concat()).success();
            let built = config::read(&room.path().join("built")).expect("a configuration");
            assert_eq!((built.search, built.shell), (chosen.search, chosen.shell));
            assert_eq!((built.input, &built.contact), (Input::Spheres, &chosen.contact));
            if want == "depth" {
                assert_eq!((built.scpus, built.interval), (chosen.scpus, chosen.interval));
            }
        }
    }
}

#[test]
fn what_does_not_go_together_is_refused() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let scene = |name: &str, text: &str| fs::write(room.path().join(name), text).expect("written");
    scene("a.toml", LATTICE);
    scene("short.toml", &LATTICE.replace("scene = 1", "scene = 1\nmax_error = 1e-4"));
    scene("exact.toml", &LATTICE.replace("scene = 1", "scene = 1\naccuracy = \"exact\""));
    scene("large.toml", &LATTICE.replace("12, 12, 12", "41, 41, 41"));
    scene(
        "alone.toml",
        "scene = 1\nwant = [\"trajectories\"]\n[effects]\ngravity = [0.0, 0.0, -1.0]\n[[bodies]]\nshape = \"stack\"\ncount = 2\n",
    );
    for (arguments, expected) in [
        (&["a.toml", "--input", "direct"][..], "give --input spheres; for pairs, `afu scene FILE --plan`"),
        (&["a.toml"], "--input"),
        (&["a.toml", "--input", "spheres", "--max-error", "1e-3"], "--max-error"),
        (&["a.toml", "--input", "spheres", "--from", "x"], "--from"),
        (&["a.toml", "--input", "spheres", "--link", "harp9"], "harp9"),
        (&["none.toml", "--input", "spheres"], "none.toml"),
        (&["short.toml", "--input", "spheres"], "spheres would be rounded before their boxes are made"),
        (&["exact.toml", "--input", "spheres"], "profile exact with results hits: unsettled pairs would not come back"),
        (&["large.toml", "--input", "spheres"], "68921 spheres; the largest table holds 65536"),
        (&["alone.toml", "--input", "spheres"], "nothing in this scene needs contacts"),
    ] {
        let error = afu(room.path(), &[&["choose", "--scene"], arguments].concat()).code(2);
        let error = String::from_utf8_lossy(&error.get_output().stderr).into_owned();
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }
    for option in [&["--input", "spheres"][..], &["--link", "harp1"], &["--shell", "axi"]] {
        let error = afu(room.path(), &[&["choose", "--max-error", "1e-3"], option].concat()).code(2);
        let error = String::from_utf8_lossy(&error.get_output().stderr).into_owned();
        assert!(error.contains("give --scene <FILE>"), "{option:?}: {error}");
    }
}
