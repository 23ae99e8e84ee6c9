//! Whether a command line of cargo names targets, features and tests that exist.

use std::fs;
use std::path::{Path, PathBuf};

use super::{afu_line, read, root};

/// What is wrong with the arguments of cargo, if anything.
pub fn fault(arguments: &[String], is_mention: bool) -> Option<String> {
    let (own, behind) = match arguments.iter().position(|word| word == "--") {
        Some(at) => (&arguments[..at], &arguments[at + 1..]),
        None => (arguments, &[][..]),
    };
    let (command, own) = own.split_first()?;
    let mut words = own.iter();
    let mut sources = None;
    let mut filters = Vec::new();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--test" | "--bench" | "--example" => {
                let name = words.next()?;
                if afu_line::is_placeholder(name) {
                    return None;
                }
                let folder = match word.as_str() {
                    "--test" => "tests",
                    "--bench" => "benches",
                    _ => "examples",
                };
                let Some(target) = target(folder, name) else { return Some(format!("{word} {name} does not exist")) };
                sources = Some(target);
            }
            "--features" => {
                let known: toml::Table = read(Path::new("Cargo.toml")).parse().expect("a manifest");
                let known = known["features"].as_table().expect("a table");
                if let Some(name) = words.next()?.split(',').find(|name| !known.contains_key(*name)) {
                    return Some(format!("feature {name} is not in Cargo.toml"));
                }
            }
            "--path" | "--bin" => _ = words.next(),
            flag if flag.starts_with('-') => {}
            filter => filters.push(filter),
        }
    }
    if command == "test" {
        let names = behind.iter().map(String::as_str).filter(|word| !word.starts_with('-'));
        let all = [PathBuf::from("src"), PathBuf::from("tests")];
        let sources = sources.map_or_else(|| all.to_vec(), |target| vec![target]);
        let text: String = sources.iter().map(|source| text_below(source)).collect();
        let unknown = filters
            .into_iter()
            .chain(names)
            .flat_map(|filter| filter.split("::"))
            .find(|part| !(afu_line::is_placeholder(part) || text.contains(part)));
        return unknown.map(|part| format!("no test's name holds `{part}`"));
    }
    match (command.as_str(), sources) {
        ("run", None) => (!behind.is_empty()).then(|| afu_line::fault(behind, is_mention)).flatten(),
        ("bench" | "run", Some(source)) => {
            let text = text_below(&source);
            let unknown = behind.iter().find(|word| word.starts_with("--") && !text.contains(word.as_str()));
            unknown.map(|option| format!("{} has no {option}", source.display()))
        }
        _ => None,
    }
}

/// The source of a target: a file, or the folder of its `main.rs`.
fn target(folder: &str, name: &str) -> Option<PathBuf> {
    let (file, main) = (PathBuf::from(format!("{folder}/{name}.rs")), format!("{folder}/{name}/main.rs"));
    let folder = || root().join(main).is_file().then(|| PathBuf::from(format!("{folder}/{name}")));
    if root().join(&file).is_file() { Some(file) } else { folder() }
}

/// The names and texts of all sources at or below a path.
fn text_below(path: &Path) -> String {
    let whole = root().join(path);
    if whole.is_file() {
        return format!("{}\n{}", path.display(), read(path));
    }
    let entries = fs::read_dir(&whole).expect("a folder").map(|entry| entry.expect("readable").file_name());
    entries.map(|name| text_below(&path.join(name))).collect()
}

#[test]
fn targets_features_and_tests_must_exist() {
    let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    for good in [
        "test --locked --test numbers faithful",
        "test --test ode afu:: -- --nocapture",
        "bench --bench step -- --check",
        "run --release --features ode -- paper --out DIR",
        "run --example verify",
        "test --test NAME",
    ] {
        assert_eq!(fault(&words(good), false), None, "{good}");
    }
    for (bad, expected) in [
        ("test --test number", "--test number does not exist"),
        ("test --test numbers no_such_test", "no test's name holds `no_such_test`"),
        ("bench --bench steps", "--bench steps does not exist"),
        ("bench --bench step -- --quick", "benches/step.rs has no --quick"),
        ("run --example verified", "--example verified does not exist"),
        ("run --features ode,fast -- doctor", "feature fast is not in Cargo.toml"),
        ("run -- doctors", "unrecognized subcommand"),
    ] {
        let fault = fault(&words(bad), false).expect(bad);
        assert!(fault.contains(expected), "{fault}");
    }
}
