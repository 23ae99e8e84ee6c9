//! `afu scene` from the user's side.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

use super::path;

fn afu(arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("afu").expect("the program").arg("scene").args(arguments).assert()
}

fn told(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stdout).into_owned()
}

fn text(path: &Path) -> String {
    path.to_str().expect("a path").to_owned()
}

#[test]
fn a_plan_names_lines_and_an_effect_more_or_less_says_what_it_costs() {
    let diamond = text(&path("diamond"));
    let plan = told(&afu(&[&diamond, "--plan"]).success());
    for row in ["position", "depth", "14: bounce = 0.0", "every radius is 0.5", "fp_sqrt_e10f23z_normal"] {
        assert!(plan.contains(row), "{row} in\n{plan}");
    }
    let with = told(&afu(&[&diamond, "--plan", "--with", "friction", "--no-luts"]).success());
    for row in ["asked for on the command line", "fp_halve_e10f23z_normal", "position", "then", "host time per step"] {
        assert!(with.contains(row), "{row} in\n{with}");
    }
    assert!(!with.contains("damping"), "{with}");
    let without = told(&afu(&[&text(&path("billiards")), "--without", "spin", "--no-luts"]).success());
    assert!(without.contains("spin"), "{without}");
    let error = afu(&[&diamond, "--with", "jelly"]).code(2);
    let error = String::from_utf8_lossy(&error.get_output().stderr).into_owned();
    assert!(error.contains("no effect is called `jelly`: use gravity, pull"), "{error}");
}

#[test]
fn every_plan_fits_in_a_terminal_of_100_columns() {
    for example in super::EXAMPLES {
        for more in [&["--plan"][..], &["--with", "friction", "--no-luts"], &["--without", "bounce", "--no-luts"]] {
            let arguments: Vec<String> =
                [text(&path(example))].into_iter().chain(more.iter().map(|m| (*m).to_owned())).collect();
            let told = told(&afu(&arguments.iter().map(String::as_str).collect::<Vec<_>>()).success());
            let widest = told.lines().max_by_key(|line| line.chars().count()).expect("a plan");
            assert!(widest.chars().count() <= 100, "{example} {more:?}: {widest}");
        }
    }
}

/// Sent spheres, an AFU and its software find the contacts that pairs give.
#[test]
fn spheres_give_the_contacts_that_pairs_give() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let contacts = |scene: &str, more: &[&str]| {
        let out = room.path().join("out");
        let (file, out_text) = (text(&path(scene)), text(&out));
        let arguments = [&[file.as_str(), "--out", &out_text, "--force"], more].concat();
        afu(&arguments).success();
        let rows = fs::read_to_string(out.join("contacts.csv")).expect("contacts are wanted");
        let mut pairs: Vec<_> = rows
            .lines()
            .skip(1)
            .map(|row| {
                let mut cells = row.split(',').map(|cell| cell.parse::<u64>().expect("a number"));
                let (step, first, second) = (cells.next(), cells.next(), cells.next());
                (step, first.min(second), first.max(second))
            })
            .collect();
        pairs.sort_unstable();
        pairs
    };
    let pairs = contacts("touching", &["--engine", "reference"]);
    assert!(!pairs.is_empty());
    assert_eq!(pairs, contacts("touching", &["--engine", "reference", "--input", "spheres"]));
    assert_eq!(pairs, contacts("touching", &["--input", "spheres", "--shell", "line"]));
    for (more, expected) in [
        (&["--lanes", "16"][..], "--lanes is of a search: give --input spheres as well"),
        (&["--input", "spheres", "--table", "500"], "table 500"),
    ] {
        let error = afu(&[&[text(&path("touching")).as_str(), "--plan"], more].concat()).code(2);
        let error = String::from_utf8_lossy(&error.get_output().stderr).into_owned();
        assert!(error.contains(expected), "{error}");
    }
    let plan = told(&afu(&[&text(&path("touching")), "--plan", "--input", "spheres"]).success());
    for row in ["search for what touches", "bytes sent per sphere", "slowest stage", "none: the search decides"] {
        assert!(plan.contains(row), "{row} in\n{plan}");
    }
}

#[test]
fn a_bad_scene_ends_in_one_line_and_writes_nothing() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let (file, out) = (room.path().join("s.toml"), room.path().join("out"));
    fs::write(&file, "scene = 1\nwant = [\"touching\"]\n[[bodies]]\nshape = \"stack\"\ncount = 2\nmass = nan\n")
        .unwrap();
    let error = afu(&[&text(&file), "--out", &text(&out)]).code(2);
    let error = String::from_utf8_lossy(&error.get_output().stderr).into_owned();
    assert!(error.contains("s.toml:6: mass: NaN") && error.lines().count() == 1, "{error}");
    assert!(!out.exists());
}

/// Rejected before a model is built or a folder created.
#[cfg(feature = "ode")]
#[test]
fn a_scene_that_begins_below_its_floor_is_exit_2() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let (file, out) = (room.path().join("s.toml"), room.path().join("out"));
    let scene = "scene = 1\nsteps = 40\nwant = [\"energy\"]\n[effects]\ngravity = [0.0, 0.0, -9.81]\nfloor = 0.0\nbounce = 0.5\n\
                 [[bodies]]\nshape = \"lattice\"\ncount = [2, 2, 4]\nradius = 0.5\nat = [0.5, 0.5, 0.5]\n";
    fs::write(&file, scene).unwrap();
    let error = afu(&[&text(&file), "--engine", "reference", "--out", &text(&out)]).code(2);
    let error = String::from_utf8_lossy(&error.get_output().stderr).into_owned();
    assert!(error.contains("8 bodies begin below the floor") && error.lines().count() == 1, "{error}");
    assert!(!out.exists());
    fs::write(&file, scene.replace("steps", "start = \"as given\"\nsteps")).unwrap();
    let told = told(&afu(&[&text(&file), "--engine", "reference", "--out", &text(&out)]).success());
    assert!(told.contains("Warning: energy rose from "), "{told}");
    let manifest: serde_json::Value = serde_json::from_slice(&fs::read(out.join("manifest.json")).unwrap()).unwrap();
    let balance = &manifest["summary"]["balance"];
    assert!(balance["end"].as_f64() > balance["start"].as_f64(), "{balance}");
}

/// A static scene does not need ODE: a query, its contacts, its page.
#[test]
fn a_query_says_who_touches_whom() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let out = room.path().join("out");
    let told = told(&afu(&[&text(&path("touching")), "--engine", "reference", "--out", &text(&out)]).success());
    assert!(told.contains("an arm in a point cloud") && told.contains("48 000"), "{told}");
    let contacts = fs::read_to_string(out.join("contacts.csv")).unwrap();
    assert!(contacts.starts_with("step,first,second\n0,"), "{contacts}");
    let manifest: serde_json::Value = serde_json::from_slice(&fs::read(out.join("manifest.json")).unwrap()).unwrap();
    assert_eq!(manifest["schema"], "contact-afu/scene/1");
    assert_eq!(manifest["summary"]["contacts"], contacts.lines().count() - 1);
    assert!(!out.join("trajectories.csv").exists() && !out.join("energy.csv").exists());
}

/// A scene runs behind AXI4 as behind any other shell, with the same contacts, and its manifest names the shell.
#[cfg(feature = "cosim")]
#[test]
fn a_scene_behind_axi_finds_what_software_finds() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let file = room.path().join("s.toml");
    let scene = "scene = 1\nwant = [\"touching\"]\naccuracy = \"e8f3z\"\nscpus = 2\n[[bodies]]\nshape = \"lattice\"\n\
                 count = [6, 6, 6]\n";
    fs::write(&file, scene).unwrap();
    let contacts = |more: &[&str]| {
        let out = room.path().join("out");
        afu(&[&[&text(&file), "--shell", "axi", "--bus", "128", "--force", "--out", &text(&out)], more].concat())
            .success();
        let manifest: serde_json::Value =
            serde_json::from_slice(&fs::read(out.join("manifest.json")).unwrap()).unwrap();
        let config = &manifest["config"];
        assert_eq!((&config["shell"], &config["bus"]), (&"axi".into(), &128.into()));
        (fs::read_to_string(out.join("contacts.csv")).unwrap(), manifest["engine"].clone())
    };
    let (simulated, software) = (contacts(&[]), contacts(&["--engine", "reference"]));
    assert_eq!(simulated.0, software.0);
    assert!(simulated.0.lines().count() > 500, "{}", simulated.0);
    assert_eq!(simulated.1, "the simulated AFU, shell axi");
    let error = afu(&[&text(&file), "--bus", "128"]).code(2);
    let error = String::from_utf8_lossy(&error.get_output().stderr).into_owned();
    assert!(error.contains("only shell axi has a bus of another width"), "{error}");
}

/// The simulated AFU in ODE's loop gives the same bytes as the same arithmetic in software. The page is animated in
/// Chromium.
#[cfg(all(feature = "ode", feature = "cosim"))]
#[test]
fn the_simulated_afu_moves_bodies_as_software_does() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let file = room.path().join("s.toml");
    let scene = fs::read_to_string(path("diamond")).unwrap();
    fs::write(&file, scene.replace("steps = 120", "steps = 30\naccuracy = \"e8f5z\"")).unwrap();
    let [simulated, software] = ["ode", "reference"].map(|engine| {
        let out = room.path().join(engine);
        afu(&[&text(&file), "--engine", engine, "--out", &text(&out)]).success();
        out
    });
    for name in ["trajectories.csv", "energy.csv"] {
        assert_eq!(fs::read(simulated.join(name)).unwrap(), fs::read(software.join(name)).unwrap(), "{name}");
    }
    let manifest: serde_json::Value =
        serde_json::from_slice(&fs::read(simulated.join("manifest.json")).unwrap()).unwrap();
    assert!(manifest["summary"]["cycles"].as_u64().expect("simulated") > 1_000);
    assert!(manifest["summary"]["contacts"].as_u64().expect("a count") > 100);

    let npy = room.path().join("npy");
    afu(&[&text(&file), "--engine", "reference", "--npy", "--out", &text(&npy)]).success();
    let bytes = fs::read(npy.join("trajectories.npy")).unwrap();
    let array = npyz::NpyFile::new(&bytes[..]).expect("an array");
    assert_eq!(array.shape(), [31, 25, 3]);
    let values: Vec<f64> = array.into_vec().expect("of f64");
    let csv = fs::read_to_string(software.join("trajectories.csv")).unwrap();
    let last = csv.lines().last().unwrap().rsplit(',').next().unwrap().parse::<f64>().unwrap();
    assert_eq!(values.last(), Some(&last));
    assert!(!npy.join("trajectories.csv").exists());

    let opened = crate::browser::open(&simulated.join("report.html"));
    assert!(opened.console.is_empty() && opened.fetched.is_empty(), "{opened:?}");
    // The script did draw: it reports which frame the canvas shows.
    assert!(opened.dom.contains("data-frame=\""), "the canvas was never drawn");
    assert!(opened.dom.contains("id=\"play\"") && opened.dom.contains("figure class=\"energy\""));

    // Acts as a reader: scrubs to step 17, which stops playback, and then resumes it. The test's script needs a policy
    // without a hash.
    let made = fs::read_to_string(simulated.join("report.html")).unwrap();
    let (before, rest) = made.split_once("script-src 'sha256-").expect("a policy");
    let (_, after) = rest.split_once('\'').expect("the hash's end");
    let free = format!("{before}script-src 'unsafe-inline{}{after}", '\'');
    let hand = "<script>const at = document.getElementById('at'), play = document.getElementById('play');\
        at.value = '17'; at.dispatchEvent(new Event('input'));\
        const canvas = document.getElementById('scene');\
        document.title = [canvas.dataset.frame, document.getElementById('step').value, play.textContent].join('|');\
        play.click(); document.title += '|' + play.textContent; play.click(); document.title += '|' + play.textContent;\
        </script></body>";
    let page = room.path().join("hand.html");
    fs::write(&page, free.replace("</body>", hand)).unwrap();
    let opened = crate::browser::open(&page);
    assert!(opened.dom.contains("<title>17|step 17|Play|Pause|Play</title>"), "{:?}", opened.dom.get(..600));
}
