//! Compares the program's output as shown in README and docs with what the program prints now.
//! `UPDATE_EXPECT=1 cargo test --test program documented` rewrites the pages.
//!
//! Some figures are not compared, because they need a router, a measured time, their own models or many minutes:
//! - the study of accuracy (README, docs/accuracy.md);
//! - areas and clocks (docs/operators.md, docs/interval.md, LUTs in docs/scene.md);
//! - rates over links (docs/link.md) and the cycles of two SCPUs (docs/spl2.md);
//! - speeds of models (docs/cosim.md) and ODE's times (docs/paper.md);
//! - long runs (docs/stability.md), a million pairs (docs/exact.md), and parry3d (docs/hard.md).
//!
//! Figures of registers and links are compared elsewhere: tests/spl2, src/link.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use contact_afu::config::{Config, Shell};
use contact_afu::link::Description;
use contact_afu::report::latency;
use contact_afu::report::table::grouped;
use contact_afu::verify::Bench;
use serde_json::Value;

/// A page as it is and as it should be.
struct Page {
    path: PathBuf,
    was: String,
    text: String,
}

impl Page {
    fn open(name: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        let text = fs::read_to_string(&path).expect("a page");
        Self { path, was: text.clone(), text }
    }

    /// The range from the only occurrence of `before` to the next `after`.
    fn find(&self, before: &str, after: &str) -> (usize, usize) {
        let found: Vec<usize> = self.text.match_indices(before).map(|(at, _)| at + before.len()).collect();
        let [begin] = found[..] else { panic!("{}: {} of `{before}`", self.path.display(), found.len()) };
        let end = self.text[begin..].find(after).unwrap_or_else(|| panic!("{}: `{after}`", self.path.display()));
        (begin, begin + end)
    }

    /// Replaces the text between `before`, which occurs once, and `after`.
    fn between(&mut self, before: &str, after: &str, value: &str) {
        let (begin, end) = self.find(before, after);
        self.text.replace_range(begin..end, value);
    }

    /// Replaces a block of text that starts with the line `first`. Lines that start with a word of `of_one_run` are
    /// kept.
    fn block(&mut self, first: &str, text: &str, of_one_run: &[&str]) {
        let (begin, end) = self.find(&format!("```text\n{first}\n"), "```");
        let stays = |line: &str| of_one_run.iter().any(|word| line.trim_start().starts_with(word));
        let mut kept = self.text[begin..end].lines().filter(|line| stays(line)).map(str::to_owned);
        let lines: Vec<String> = text
            .lines()
            .map(|line| if stays(line) { kept.next().unwrap_or_default() } else { line.to_owned() })
            .collect();
        self.text.replace_range(begin..end, &format!("{}\n", lines.join("\n")));
    }

    /// Replaces cells of the row called `name` below a heading. Columns are counted from 0, the name's column.
    fn row(&mut self, heading: &str, name: &str, cells: &[(usize, String)]) {
        let below = self.find(heading, "\n").0;
        let start = format!("\n| {name} |");
        let at = self.text[below..].find(&start).unwrap_or_else(|| panic!("{}: row {name}", self.path.display()));
        let begin = below + at + 1;
        let end = begin + self.text[begin..].find('\n').expect("a line");
        let mut all: Vec<String> = self.text[begin..end].split('|').map(str::to_owned).collect();
        for (column, value) in cells {
            all[column + 1] = format!(" {value} ");
        }
        self.text.replace_range(begin..end, &all.join("|"));
    }

    fn check(self) {
        if self.was == self.text {
            return;
        }
        if std::env::var_os("UPDATE_EXPECT").is_some_and(|value| value == "1") {
            return fs::write(&self.path, &self.text).expect("written");
        }
        let differing = self.was.lines().zip(self.text.lines()).filter(|(was, is)| was != is);
        let lines: Vec<String> = differing.take(40).map(|(was, is)| format!("- {was}\n+ {is}")).collect();
        panic!("{}: UPDATE_EXPECT=1 writes what the program says:\n{}", self.path.display(), lines.join("\n"));
    }
}

fn afu(arguments: &[&str]) -> String {
    let output = Command::cargo_bin("afu").expect("built").args(arguments).output().expect("it runs");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[test]
fn the_readme_shows_what_the_demo_prints() {
    let printed = afu(&["cosim", "--pairs", "diamond:10", "--pairs", "random:100000"]);
    let (first, table) = printed.split_once('\n').expect("a heading and a table");
    let mut page = Page::open("README.md");
    page.block(first, table, &["simulation time"]);
    page.check();
}

#[test]
fn the_cycles_of_a_small_job_are_as_printed() {
    let config = Config { shell: Shell::Line, ..Config::default() };
    let mut link = "harp1".parse::<Description>().unwrap().at(config.clock_mhz).unwrap();
    (link.read.tail, link.write.tail) = (0, 0);
    let text = latency::text(&Bench::new(&config).unwrap(), &link, &[1, 2, 20]).unwrap().expect("a sum of parts");
    let mut page = Page::open("docs/link.md");
    page.block("harp1 without its tail, 10 SCPUs, 200 MHz", &text, &[]);
    page.check();
}

/// The manifest of an AFU, and the latency of its kernel.
fn generated(arguments: &[&str]) -> (Value, u64) {
    let room = tempfile::tempdir().unwrap();
    let out = room.path().join("out");
    afu(&[&["rtl", "--out", out.to_str().expect("UTF-8")], arguments].concat());
    let manifest: Value = serde_json::from_slice(&fs::read(out.join("manifest.json")).unwrap()).unwrap();
    let latency = manifest["latency_cycles"].as_u64().expect("a number");
    (manifest, latency)
}

#[test]
fn intervals_and_latencies_are_the_generator_s() {
    let mut page = Page::open("docs/link.md");
    for link in ["harp1", "harp2", "pcie3x8"] {
        let (manifest, _) = generated(&["--shell", "line", "--link", link]);
        page.row("## What the default AFU reaches", link, &[(1, manifest["config"]["interval"].to_string())]);
    }
    page.check();

    let scpu = |arguments: &[&str]| generated(&[&["--target", "ecp5", "--scpus", "1"], arguments].concat()).1;
    let mut page = Page::open("docs/interval.md");
    for interval in ["1", "2", "4", "8", "16"] {
        page.row("One SCPU, wide, ecp5.", interval, &[(2, scpu(&["--interval", interval]).to_string())]);
    }
    page.check();
}

#[test]
fn the_figures_of_scenes_are_their_plans() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    let plan = |scene: &str, more: &[&str]| {
        let scene = root.join(format!("{scene}.toml"));
        afu(&[&["scene", scene.to_str().expect("UTF-8"), "--plan"], more].concat())
    };
    let figures = |plan: &str, row: &str| -> Vec<String> {
        let line = plan.lines().find(|line| line.trim_start().starts_with(row)).expect("a row");
        let words = line.trim_start()[row.len()..].split_whitespace();
        words.filter(|word| word.chars().all(|c| c.is_ascii_digit())).map(str::to_owned).collect()
    };
    let mut page = Page::open("docs/scene.md");
    let touching = plan("touching", &[]);
    let [cycles, bytes] =
        ["cycles from a pair to its contact", "bytes that come back"].map(|row| figures(&touching, row).concat());
    page.between("of touching alone, ", " per contact.", &format!("{cycles} cycles and {bytes} bytes"));
    let friction = plan("diamond", &["--with", "friction", "--no-luts"]);
    let cycles = figures(&friction, "cycles from a pair to its contact").join(" cycles ");
    let bytes = figures(&friction, "bytes that come back");
    page.between("7 DSP blocks 8, ", ", and a contact's record", &cycles);
    page.between("and a contact's record ", " (Yosys", &format!("{} bytes instead of {}", bytes[1], bytes[0]));

    // The query of a million candidates from the page.
    let room = tempfile::tempdir().unwrap();
    let scene = room.path().join("million.toml");
    let text = fs::read_to_string(root.join("touching.toml")).unwrap();
    let mut text = text.lines().map(|line| if line.starts_with("at = ") { "at = [0.0, 0.0, -1.0]" } else { line });
    let text = text.by_ref().collect::<Vec<_>>().join("\n");
    let changes = [
        ("count = 4000", "count = 900_000"),
        ("count = 12", "count = 100"),
        ("gap = -0.02", "gap = -0.47"),
        ("radius = 0.06", "radius = 0.245"),
    ];
    fs::write(&scene, changes.iter().fold(text, |text, (from, to)| text.replace(from, to))).unwrap();
    let json = afu(&["scene", scene.to_str().expect("UTF-8"), "--engine", "reference", "--json", "-"]);
    let summary = &serde_json::from_str::<Value>(&json).expect("JSON")["summary"];
    let count = |name: &str| grouped(summary[name].as_u64().expect("a count"));
    let told = format!("{} of 90 million pairs are sent and {} touch", count("pairs"), count("contacts"));
    page.between("afu scene tens.toml\n```\n\n", "; ", &told);
    page.check();
}

/// Checks that a page's table of gross failures matches `afu hard` with these arguments. The table's columns are
/// `contenders`, and ODE, which is compared only if it is built in. Returns the picture that `afu hard` made.
fn compare_gross_failures(page: &str, arguments: &[&str], contenders: &[&str], sums: &[(&str, &str)]) -> String {
    let room = tempfile::tempdir().unwrap();
    let out = room.path().join("hard");
    afu(&[&["hard", "--out", out.to_str().expect("UTF-8")], arguments].concat());
    let csv = fs::read_to_string(out.join("hard.csv")).unwrap();
    let heading: Vec<&str> = csv.lines().next().expect("a heading").split(',').collect();
    let rows: Vec<HashMap<&str, &str>> =
        csv.lines().skip(1).map(|line| heading.iter().copied().zip(line.split(',')).collect()).collect();
    let sum = |contender: &str, category: Option<&str>, what: &str| {
        let of = rows.iter().filter(|row| row["contender"] == contender);
        let of = of.filter(|row| category.is_none_or(|category| row["category"] == category));
        grouped(of.map(|row| row[what].parse::<u64>().expect("a count")).sum())
    };
    let there = || contenders.iter().chain(cfg!(feature = "ode").then_some(&"ODE f64"));
    let cells = |category: Option<&str>, what: &str| -> Vec<(usize, String)> {
        (1..).zip(there()).map(|(column, contender)| (column, sum(contender, category, what))).collect()
    };
    let mut page = Page::open(page);
    let table = "Gross failures of 10 000 pairs each";
    for category in rows.iter().filter(|row| row["contender"] == "wide").map(|row| row["category"]) {
        page.row(table, category, &cells(Some(category), "gross"));
    }
    for (name, what) in [("contacts missed", "missed"), ("false positives", "false")].iter().chain(sums) {
        page.row(table, name, &cells(None, what));
    }
    page.check();
    fs::read_to_string(out.join("hard.svg")).unwrap()
}

#[test]
fn gross_failures_on_hard_pairs_are_the_table_s() {
    let sums = [("all 170 000", "gross"), ("left to the host", "unsettled")];
    let drawn = compare_gross_failures("docs/hard.md", &[], &["wide", "exact", "formula f32"], &sums);
    if cfg!(feature = "ode") && !cfg!(feature = "parry") {
        let mut picture = Page::open("docs/img/hard.svg");
        picture.text = drawn;
        picture.check();
    }
    let planes = ["--query", "sphere-plane", "--pairs", "120000"];
    compare_gross_failures("docs/sphere-plane.md", &planes, &["wide", "formula f32"], &[("all 120 000", "gross")]);
}
