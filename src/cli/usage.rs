//! Reads the command line, and reports what is wrong with it.

use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::LazyLock;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::{ArgAction, CommandFactory, FromArgMatches};
use contact_afu::query::Query;

use super::Program;

/// The commands as `afu help` groups them. Commands that are not built in are left out there.
pub const GROUPS: [(&str, &[&str]); 4] = [
    ("Hardware", &["rtl", "synth"]),
    ("Simulation", &["cosim", "sweep", "pairs", "spheres"]),
    ("Studies", &["accuracy", "choose", "hard", "paper", "scene", "merge"]),
    ("This program", &["doctor", "completions", "help"]),
];

/// The commands that are built only with the feature `cosim`.
#[cfg(test)]
pub const SIMULATED: [&str; 5] = ["cosim", "sweep", "accuracy", "choose", "paper"];

/// The description of the command that clap adds.
const HELP: &str = "Explain a command and all its options";

/// Why a command that every program with simulation has may still need the feature `ode`.
const NEEDS_ODE: [(&str, &str); 2] =
    [("paper", "This command needs the feature ode"), ("scene", "A scene whose bodies move needs the feature ode")];

/// The program's commands and options for clap, with the help texts that clap does not write.
pub fn command() -> clap::Command {
    let is_built_in = if cfg!(feature = "ode") { "which is built in" } else { "which is not built in" };
    let command = Program::command().mut_subcommands(|command| {
        match NEEDS_ODE.iter().find(|(name, _)| *name == command.get_name()) {
            Some((_, needs)) => command.after_help(format!("{needs}, {is_built_in}.")),
            None => command,
        }
    });
    let template = help_template(&command);
    command.help_template(template).max_term_width(100)
}

/// The template of the program's own help: clap's default with the commands in groups.
fn help_template(command: &clap::Command) -> String {
    let (header, literal) = (*command.get_styles().get_header(), *command.get_styles().get_literal());
    let mut groups = String::new();
    for (title, names) in GROUPS {
        groups += &format!("\n{header}{title}:{header:#}\n");
        for name in names {
            let about = match command.find_subcommand(name) {
                Some(found) => found.get_about().map(ToString::to_string).unwrap_or_default(),
                None if *name == "help" => HELP.to_owned(),
                None => continue,
            };
            let needs_ode = NEEDS_ODE.iter().any(|(needing, _)| needing == name);
            let mark = if needs_ode && !cfg!(feature = "ode") { " [ode is not built in]" } else { "" };
            groups += &format!("  {literal}{name:<13}{literal:#}{about}{mark}\n");
        }
    }
    format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n{groups}\n{header}Options:{header:#}\n{{options}}{{after-help}}"
    )
}

/// The version and the features of this build.
pub fn version() -> &'static str {
    static VERSION: LazyLock<String> =
        LazyLock::new(|| format!("{} ({})", env!("CARGO_PKG_VERSION"), contact_afu::tools::summary()));
    &VERSION
}

/// The parser for names of queries, which the help lists.
pub fn query() -> impl TypedValueParser<Value = Query> {
    PossibleValuesParser::new(Query::ALL.map(|query| query.shape().name)).try_map(|name| name.parse::<Query>())
}

/// Parses a command line.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Program, clap::Error> {
    // `-1` is read as a value, so that the option can refuse it in its own words.
    let numbers = |arg: clap::Arg| {
        let takes_values = matches!(arg.get_action(), ArgAction::Set | ArgAction::Append);
        if takes_values { arg.allow_negative_numbers(true) } else { arg }
    };
    let mut command = command().mut_subcommands(|command| command.mut_args(numbers));
    let matches = command.try_get_matches_from_mut(arguments)?;
    Program::from_arg_matches(&matches).map_err(|error| error.format(&mut command))
}

/// Prints the error, the help or the version, and returns the exit status.
pub fn report(error: &clap::Error) -> ExitCode {
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        return if error.print().is_ok() { ExitCode::SUCCESS } else { ExitCode::from(4) };
    }
    let text = error.render().to_string();
    match text.strip_prefix("error: ") {
        Some(text) => eprint!("afu: {text}"),
        None => eprint!("{text}"),
    }
    ExitCode::from(2)
}

/// Parses a seed: a whole number from 0 to 2^64 - 1.
pub fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| {
        let tip = text.strip_prefix('-').filter(|digits| digits.parse::<u64>().is_ok());
        let tip = tip.map(|digits| format!("; did you mean {digits}?")).unwrap_or_default();
        format!("expected a whole number from 0 to {}{tip}", u64::MAX)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_that_simulate_need_the_feature_cosim() {
        let command = command();
        for name in GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).filter(|name| *name != "help") {
            let is_needy = SIMULATED.contains(&name);
            assert_eq!(command.find_subcommand(name).is_some(), cfg!(feature = "cosim") || !is_needy, "{name}");
        }
    }

    #[test]
    fn the_help_names_every_command_once_in_at_most_100_columns() {
        let command = command();
        let grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        for subcommand in command.get_subcommands() {
            let name = subcommand.get_name();
            assert_eq!(grouped.iter().filter(|grouped| **grouped == name).count(), 1, "{name}");
        }
        let help = command.clone().render_long_help().to_string();
        for subcommand in command.get_subcommands() {
            let about = subcommand.get_about().expect("a command has a description").to_string();
            let line = format!("  {:<13}{about}", subcommand.get_name());
            assert!(help.contains(&line), "{help}");
        }
        for line in help.lines() {
            assert!(line.chars().count() <= 100, "{} columns: {line}", line.chars().count());
        }
    }
}
