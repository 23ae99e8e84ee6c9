//! `afu hard`: the table, its files, and its results for the profiles and for other engines.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use contact_afu::accuracy::Tally;
use contact_afu::pairs::CATEGORIES;
use serde_json::Value;

const PAIRS: u64 = 5_100;

fn hard(room: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("afu").expect("the program is built");
    command.current_dir(room).args(["hard", "--seed", "3", "--out", "out"]).args(arguments).assert()
}

/// The tallies by category and contender.
type Rows = BTreeMap<(String, String), Value>;

fn rows(record: &Value) -> Rows {
    assert_eq!(
        (&record["schema"], &record["pairs"], &record["seed"]),
        (&"contact-afu/hard/1".into(), &PAIRS.into(), &3.into())
    );
    let name = |row: &Value, key: &str| row[key].as_str().expect("a name").to_owned();
    let rows = record["rows"].as_array().expect("rows").iter();
    rows.map(|row| ((name(row, "category"), name(row, "contender")), row["tally"].clone())).collect()
}

/// A contender's count in a category; in all categories if it is `None`.
fn count(rows: &Rows, contender: &str, category: Option<&str>, what: &str) -> u64 {
    let of = rows.iter().filter(|((c, who), _)| who == contender && category.is_none_or(|name| name == c));
    of.map(|(_, tally)| tally[what].as_u64().unwrap_or_else(|| panic!("{what} is no count"))).sum()
}

#[test]
fn the_table_says_what_each_engine_is_worth() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let pairs = PAIRS.to_string();
    let first = hard(room.path(), &["--pairs", &pairs, "--json", "record.json"]).success();
    let read = |name: &str| fs::read_to_string(room.path().join(name)).expect("written");
    let record: Value = serde_json::from_str(&read("record.json")).expect("JSON");
    assert_eq!(record, serde_json::from_str::<Value>(&read("out/manifest.json")).expect("JSON"));

    // Every column is on the terminal and in both files.
    let shown = String::from_utf8(first.get_output().stdout.clone()).expect("UTF-8");
    let columns = ["missed", "false", "non-finite", "normal", "direction", "depth", "position", "gross", "unsettled"];
    assert_eq!(columns, Tally::HEADING);
    let csv = read("out/hard.csv");
    let heading: Vec<&str> = csv.lines().next().expect("a heading").split(',').collect();
    assert_eq!(heading[..4], ["category", "contender", "pairs", "contacts"]);
    assert_eq!(heading[4..13], columns);
    let rows = rows(&record);
    let contenders = record["rows"].as_array().expect("rows").len() / CATEGORIES.len();
    assert_eq!((rows.len(), csv.lines().count()), (contenders * CATEGORIES.len(), contenders * CATEGORIES.len() + 1));
    for line in shown.lines().filter(|line| line.contains("unsettled")) {
        assert!(columns.iter().all(|column| line.contains(column)), "{line}");
    }
    assert_eq!(shown.matches("unsettled").count(), contenders, "{shown}");
    for category in CATEGORIES {
        assert_eq!(shown.matches(&format!(" {} ", category.name())).count(), contenders + 1, "{}", category.name());
        assert_eq!(count(&rows, "wide", Some(category.name()), "pairs"), PAIRS / CATEGORIES.len() as u64);
    }

    // The CSV has the same figures as the JSON.
    for line in csv.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let tally = &rows[&(cells[0].to_owned(), cells[1].to_owned())];
        for (cell, key) in cells[2..13].iter().zip([
            "pairs",
            "contacts",
            "missed",
            "false",
            "non_finite",
            "normal",
            "direction",
            "depth",
            "position",
            "BAD",
            "unsettled",
        ]) {
            assert_eq!(tally[key].as_u64(), cell.parse().ok(), "{line}: {key}");
        }
    }

    // The figures show what the contenders are worth.
    let all = |contender: &str, what: &str| count(&rows, contender, None, what);
    for what in ["missed", "false", "non_finite", "normal", "direction", "depth", "position", "BAD"] {
        assert_eq!(all("exact", what), 0, "exact: {what}");
    }
    assert!(all("exact", "unsettled") > 100 && count(&rows, "exact", Some("ordinary"), "unsettled") == 0);
    assert!(all("wide", "BAD") == 0 && all("wide", "false") > 100, "wide is wrong near tangents, never grossly");
    for what in ["missed", "false", "non_finite", "normal", "direction", "depth", "position", "BAD"] {
        assert_eq!(all("paper", what), all("formula f32", what), "the profile paper is the formula in f32: {what}");
    }
    let fails = |category: &str, what: &str| count(&rows, "formula f32", Some(category), what);
    assert!(fails("overflow", "BAD") > 50 && fails("overflow", "missed") == fails("overflow", "BAD"));
    assert!(fails("subnormal", "BAD") == fails("subnormal", "pairs") && fails("ordinary", "BAD") == 0);
    assert!(fails("largest", "non_finite") > 50);
    if cfg!(feature = "ode") {
        assert!(all("ODE f64", "BAD") == 0 && count(&rows, "ODE f64", Some("cancel"), "false") > 20);
    } else {
        assert!(shown.contains("--features ode"), "{shown}");
    }
    if cfg!(feature = "parry") {
        let parry = |category: &str, what: &str| count(&rows, "parry3d f32", Some(category), what);
        assert!(parry("tangent", "missed") > parry("tangent", "contacts") / 2, "it takes touching for none");
        assert!(parry("overflow", "missed") == parry("overflow", "contacts") && parry("ordinary", "BAD") == 0);
        assert!(parry("subnormal", "BAD") > parry("subnormal", "pairs") / 2 && parry("far", "BAD") == 0);
    } else {
        assert!(shown.contains("--features parry"), "{shown}");
    }

    // A second run of the same command reuses all results and gives the same files.
    let again = hard(room.path(), &["--pairs", &pairs]).success();
    let said = String::from_utf8(again.get_output().stderr.clone()).expect("UTF-8");
    assert!(said.contains(&format!("{0} of {0} rows come from an earlier run", rows.len())), "{said}");
    assert_eq!(read("out/hard.csv"), csv);
    // Another profile is added to the existing rows.
    let other = hard(room.path(), &["--pairs", &pairs, "--profile", "exact,half"]).success();
    let said = String::from_utf8(other.get_output().stderr.clone()).expect("UTF-8");
    assert!(said.contains(&format!("{} of ", rows.len() - 2 * CATEGORIES.len())), "{said}");
}

#[test]
fn wrong_words_are_exit_2_and_a_foreign_folder_is_left_alone() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for arguments in [&["--pairs", "many"][..], &["--profile", "best"], &["--profile", "e99f1"], &["--seed", "x"]] {
        hard(room.path(), arguments).code(2);
    }
    fs::create_dir(room.path().join("out")).expect("made");
    fs::write(room.path().join("out/theirs"), "x").expect("written");
    hard(room.path(), &["--pairs", "17"]).code(2);
    assert_eq!(fs::read_dir(room.path().join("out")).expect("there").count(), 1);
    hard(room.path(), &["--pairs", "17", "--force"]).success();
    assert!(room.path().join("out/theirs").exists() && room.path().join("out/hard.csv").exists());

    // A manifest of this program, but of a different command.
    let manifest = room.path().join("out/manifest.json");
    fs::write(&manifest, r#"{"schema": "contact-afu/sweep/1"}"#).expect("written");
    let before = fs::read(&manifest).expect("there");
    let refused = hard(room.path(), &["--pairs", "17"]).code(2);
    let said = String::from_utf8(refused.get_output().stderr.clone()).expect("UTF-8");
    assert!(said.contains("it holds results of contact-afu/sweep/1, not contact-afu/hard/1; choose another"), "{said}");
    assert_eq!(fs::read(&manifest).expect("there"), before);
    hard(room.path(), &["--pairs", "17", "--force"]).success();
}

#[test]
fn planes_are_judged_too_and_exact_is_for_spheres_alone() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let planes = ["--query", "sphere-plane", "--pairs", "12000"];
    let first = hard(room.path(), &planes).success();
    let read = |name: &str| fs::read_to_string(room.path().join("out").join(name)).expect("written");
    let record: Value = serde_json::from_str(&read("manifest.json")).expect("JSON");
    assert_eq!(record["query"], "sphere-plane");
    let rows = record["rows"].as_array().expect("rows");
    let total = |contender: &str, what: &str| -> u64 {
        let of = rows.iter().filter(|row| row["contender"] == contender);
        of.map(|row| row["tally"][what].as_u64().expect("a count")).sum()
    };
    assert!(total("wide", "BAD") == 0 && total("wide", "contacts") > 3_000 && total("formula f32", "BAD") > 0);
    for what in ["pairs", "missed", "false", "non_finite", "normal", "direction", "depth", "position", "BAD"] {
        assert_eq!(total("paper", what), total("formula f32", what), "{what}");
    }
    assert_eq!((total("wide", "pairs"), total("exact", "pairs")), (12_000, 0));
    if cfg!(feature = "ode") {
        assert!(total("ODE f64", "pairs") == 12_000 && total("ODE f64", "BAD") == 0);
    }
    let shown = String::from_utf8(first.get_output().stdout.clone()).expect("UTF-8");
    assert!(shown.contains("hard:12000 of sphere-plane with seed 3") && shown.contains("parry3d"), "{shown}");

    let refused = hard(room.path(), &[&planes[..], &["--profile", "wide,exact"]].concat()).code(2);
    let said = String::from_utf8(refused.get_output().stderr.clone()).expect("UTF-8");
    assert_eq!(
        said,
        "afu: query sphere-plane with profile exact: profile exact is for sphere-sphere only; leave it out\n"
    );

    // Another query in the same folder replaces the table. The measurements are kept.
    let csv = read("hard.csv");
    hard(room.path(), &["--pairs", "17", "--profile", "wide"]).success();
    let again = hard(room.path(), &planes).success();
    let said = String::from_utf8(again.get_output().stderr.clone()).expect("UTF-8");
    assert!(said.contains(&format!("{0} of {0} rows come from an earlier run", rows.len())), "{said}");
    assert_eq!(read("hard.csv"), csv);
}
