//! Every command line in the documentation can be run, every option that it mentions exists, and so does every path.

use std::path::Path;

use super::markdown::{self, Code};
use super::{afu_line, cargo_line, comments, options_of_afu, pages, read, root};

/// The repository's folders: a path that begins with one of them must exist.
const FOLDERS: [&str; 8] = ["benches", "docs", "examples", "rtl", "scripts", "src", "tb", "tests"];

/// Options of other programs that the documentation mentions in a sentence.
const OTHERS: [&str; 14] = [
    "--bench",
    "--check",
    "--example",
    "--features",
    "--ignored",
    "--include-ignored",
    "--lib-create",
    "--locked",
    "--nocapture",
    "--no-default-features",
    "--release",
    "--test",
    "--timing",
    "--trace-fst",
];

/// What is wrong with a piece of code, if anything.
fn fault(code: &Code) -> Option<String> {
    let text = code.text.trim().trim_start_matches("$ ");
    if !code.is_block && text.starts_with("--") {
        let name = text.split([' ', '=', ',']).next().unwrap_or_default();
        let is_script_s = || scripts().contains(name);
        let is_known = options_of_afu().iter().any(|known| known == name) || OTHERS.contains(&name) || is_script_s();
        return (!is_known).then(|| format!("{name} is no option of afu or of a script"));
    }
    let words = shlex::split(text)?;
    // Words glued to a semicolon, and a comment, end a command too.
    let words = words.iter().flat_map(|word| match word.strip_suffix(';') {
        Some(word) => vec![word.to_owned(), ";".to_owned()],
        None => vec![word.clone()],
    });
    let words: Vec<String> = words.filter(|word| !["…", "..."].contains(&word.as_str())).collect();
    let mut commands = words.split(|word| ["&&", "||", ";", "|"].contains(&word.as_str()));
    commands
        .find_map(|command| fault_of(command, !code.is_block))
        .or_else(|| words.iter().find_map(|word| path_fault(word)))
}

/// What is wrong with a command, if anything.
fn fault_of(command: &[String], is_mention: bool) -> Option<String> {
    let is_setting = |word: &String| word.split_once('=').is_some_and(|(name, _)| afu_line::is_placeholder(name));
    let begin = command.iter().position(|word| !is_setting(word))?;
    let is_redirection = |word: &String| word.trim_start_matches('2').starts_with('>');
    let end = command.iter().position(is_redirection).unwrap_or(command.len());
    let (program, arguments) = command.get(begin..end)?.split_first()?;
    match program.trim_start_matches("./") {
        "afu" | "target/release/afu" | "target/debug/afu" => afu_line::fault(arguments, is_mention),
        "cargo" => cargo_line::fault(arguments, is_mention),
        script if script.starts_with("scripts/") && root().join(script).is_file() => {
            let text = read(Path::new(script));
            // What follows `--` is a study of afu, which scripts/slurm/submit gives a store.
            let mut parts = arguments.splitn(2, |word| word == "--");
            let mut own = parts.next().into_iter().flatten();
            let unknown = own.find(|word| word.starts_with("--") && !text.contains(word.as_str()));
            let unknown = unknown.map(|option| format!("{script} has no {option}"));
            unknown.or_else(|| {
                parts.next().and_then(|study| {
                    let study = [study, &["--store".to_owned(), "STORE".to_owned()]].concat();
                    afu_line::fault(&study, is_mention)
                })
            })
        }
        _ => None,
    }
}

/// The texts of all scripts.
fn scripts() -> String {
    let entries = std::fs::read_dir(root().join("scripts")).expect("a folder");
    let paths = entries.map(|entry| Path::new("scripts").join(entry.expect("readable").file_name()));
    paths.filter(|path| root().join(path).is_file()).map(|path| read(&path)).collect()
}

/// What is wrong with a word that looks like a path of the repository, if anything.
fn path_fault(word: &str) -> Option<String> {
    let path = word.trim_start_matches("./").trim_end_matches([',', '.', ':', ')']);
    let folder = path.split_once('/')?.0;
    let is_pattern = path.contains(['*', '{', '<', '$', '…']) || path.split('/').any(afu_line::is_placeholder);
    let is_ours = FOLDERS.contains(&folder) && !is_pattern;
    // `src/files` may stand for the module in `src/files.rs`.
    let exists = || root().join(path).exists() || root().join(format!("{path}.rs")).exists();
    (is_ours && !exists()).then(|| format!("{path} does not exist"))
}

#[test]
fn every_command_line_can_be_run() {
    let mut faults = Vec::new();
    // The log of changes speaks of earlier versions.
    for page in pages().into_iter().filter(|page| page.path != Path::new("CHANGELOG.md")).chain(comments()) {
        let wrong = markdown::code(&page.text).into_iter().filter_map(|code| Some((fault(&code)?, code)));
        faults.extend(
            wrong.map(|(fault, code)| format!("{}:{}: `{}`: {fault}", page.path.display(), code.line, code.text)),
        );
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_command_line_that_cannot_be_run_is_found() {
    let one = |text: &str, is_block| fault(&Code { line: 1, text: text.to_owned(), is_block });
    for (bad, expected) in [
        ("afu cosim --pair diamond:3    # a comment", "unexpected argument '--pair'"),
        ("$ target/release/afu rtl", "required arguments were not provided"),
        ("A=1 afu cosim && afu cosin", "unrecognized subcommand 'cosin'"),
        ("./scripts/demo --no-such-option", "scripts/demo has no --no-such-option"),
        ("scripts/slurm/submit 4 a b -- sweep --scpu 1..4", "unexpected argument '--scpu'"),
        ("./scripts/no-such-script", "scripts/no-such-script does not exist"),
        ("cargo test --test no_such_target", "--test no_such_target does not exist"),
        ("afu scene examples/scenes/no-such-scene.toml", "examples/scenes/no-such-scene.toml does not exist"),
    ] {
        let fault = one(bad, true).expect(bad);
        assert!(fault.contains(expected), "{fault}");
    }
    assert!(one("--no-such-option 3", false).expect("bad").contains("is no option"));
    assert!(one("src/no_such_file.rs", false).expect("bad").contains("does not exist"));
    for good in ["afu rtl --out build/    # Verilog", "$ afu cosim > out.txt; afu doctor", "ls *.v | wc -l"] {
        assert_eq!(one(good, true), None, "{good}");
    }
    for good in ["--scpus N", "afu rtl --prefix NAME", "src/main.rs", "rtl/*.v", "x + y", "examples/NAME.toml"] {
        assert_eq!(one(good, false), None, "{good}");
    }
}
