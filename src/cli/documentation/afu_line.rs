//! Whether clap accepts a command line of `afu`.

use clap::error::ErrorKind;

use super::super::usage;

/// Values that take the place of a placeholder such as `FILE` or `N`: the first that clap accepts is taken.
const SAMPLES: [&str; 7] = ["1", "diamond:1", "add", "wide", "hit", "rtl", "bash"];

/// `FILE`, `<FILE>`, `NAME.toml`, `NAME|FILE`, `"$out"`: what a reader replaces.
pub fn is_placeholder(word: &str) -> bool {
    let word = word.trim_start_matches('<').trim_end_matches('>');
    let stem = word.split_once('.').map_or(word, |(stem, _)| stem);
    let is_capital = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || matches!(c, '_' | '|' | '-');
    stem.starts_with('$') || (stem.starts_with(|c: char| c.is_ascii_uppercase()) && stem.chars().all(is_capital))
}

/// What is wrong with the arguments, if anything. A mention within a sentence may leave out what is required, and the
/// value of its last option.
pub fn fault(arguments: &[String], is_mention: bool) -> Option<String> {
    let attempt = |sample: &str, more: Option<&str>| {
        let all = arguments.iter().filter(|word| *word != "[OPTIONS]");
        let replaced = all.map(|word| if is_placeholder(word) { sample } else { word });
        let line = std::iter::once("afu").chain(replaced).chain(more);
        usage::command().try_get_matches_from(line).err().filter(|error| {
            let is_shown = matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
            let left_out = [
                ErrorKind::MissingRequiredArgument,
                ErrorKind::MissingSubcommand,
                ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand,
            ];
            !(is_shown || is_mention && left_out.contains(&error.kind()))
        })
    };
    let has_open_option = is_mention && arguments.last().is_some_and(|word| word.starts_with("--"));
    let mut first = None;
    for sample in SAMPLES {
        match attempt(sample, None) {
            None => return None,
            Some(error) => first = first.or(Some(error)),
        }
        if has_open_option && attempt(sample, Some(sample)).is_none() {
            return None;
        }
    }
    first.map(|error| error.to_string().trim().replace('\n', " "))
}

#[test]
fn clap_judges_command_lines() {
    let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    for good in ["cosim --scpus N --link NAME|FILE", "help COMMAND", "pairs SET --out FILE", "scene [OPTIONS] <FILE>"] {
        assert_eq!(fault(&words(good), false), None, "{good}");
    }
    for (bad, expected) in [
        ("cosim --scpu 3", "unexpected argument '--scpu'"),
        ("cosim --clock fast", "invalid value 'fast'"),
        ("rtl --prefix NAME", "required arguments were not provided"),
        ("simulate", "unrecognized subcommand"),
        ("synth --target", "a value is required"),
    ] {
        let fault = fault(&words(bad), false).expect(bad);
        assert!(fault.contains(expected), "{fault}");
    }
    for mention in ["rtl --prefix NAME", "synth --target", ""] {
        assert_eq!(fault(&words(mention), true), None, "{mention}");
    }
    assert!(fault(&words("synth --targets"), true).is_some());
}
