//! Reading the command line, and what is said when it is wrong.

use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::LazyLock;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::{ArgAction, CommandFactory, FromArgMatches};
use contact_afu::query::Query;

use super::Program;

/// What clap knows of this program. In the list of commands those that need the feature `ode` say so.
pub fn command() -> clap::Command {
    let built_in = if cfg!(feature = "ode") { "" } else { ", which is not built in" };
    let marked = |command: clap::Command, what: &str| {
        let about = command.get_about().map(ToString::to_string).unwrap_or_default();
        command.about(format!("{about} [{what} the feature ode{built_in}]"))
    };
    Program::command().mut_subcommands(|command| match command.get_name() {
        "paper" => marked(command, "needs"),
        "scene" => marked(command, "bodies that move need"),
        _ => command,
    })
}

/// The version, and what is built in.
pub fn version() -> &'static str {
    static VERSION: LazyLock<String> =
        LazyLock::new(|| format!("{} ({})", env!("CARGO_PKG_VERSION"), contact_afu::tools::summary()));
    &VERSION
}

/// Reads the name of a query, and lists them in the help.
pub fn query() -> impl TypedValueParser<Value = Query> {
    PossibleValuesParser::new(Query::ALL.map(|query| query.shape().name)).try_map(|name| name.parse::<Query>())
}

/// The program that a command line asks for.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Program, clap::Error> {
    // A negative number is a value, which its option then refuses by name.
    let numbers = |arg: clap::Arg| {
        let takes_values = matches!(arg.get_action(), ArgAction::Set | ArgAction::Append);
        if takes_values { arg.allow_negative_numbers(true) } else { arg }
    };
    let mut command = command().mut_subcommands(|command| command.mut_args(numbers));
    let matches = command.try_get_matches_from_mut(arguments)?;
    Program::from_arg_matches(&matches).map_err(|error| error.format(&mut command))
}

/// Says what is wrong, or shows the help or version that was asked for.
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

/// A seed.
pub fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| {
        let tip = text.strip_prefix('-').filter(|digits| digits.parse::<u64>().is_ok());
        let tip = tip.map(|digits| format!("; did you mean {digits}?")).unwrap_or_default();
        format!("a seed is a whole number from 0 to {}{tip}", u64::MAX)
    })
}
