//! `docs/options.md` is made from the help texts.
//! `UPDATE_EXPECT=1 cargo test --features ode --bin afu options` rewrites it.

use std::fmt::Write;

use clap::{Arg, Command};

use super::super::usage;

/// The heading under which the help lists the options that several commands share.
const SHARED: &str = "The AFU";

const INTRODUCTION: &str = "\
# Commands and options

`afu help COMMAND` prints these texts; this page is generated from them. It lists the commands of a build with all
features, and `afu --version` names the features of yours. A word in capitals stands for a value.
";

/// The page.
fn page() -> String {
    let mut command = usage::command();
    command.build();
    let mut page = INTRODUCTION.to_owned();
    let names = usage::GROUPS.iter().flat_map(|(_, names)| names.iter()).filter(|name| **name != "help");
    let commands: Vec<&Command> = names.map(|name| command.find_subcommand(name).expect("built in")).collect();
    page += "\n| command | what it does |\n|---|---|\n";
    for command in &commands {
        let name = command.get_name();
        page += &format!("| [`afu {name}`](#afu-{name}) | {} |\n", command.get_about().expect("a description"));
    }
    page += &format!("\n{}", paragraphs(&command.get_long_about().expect("a description").to_string(), 1));

    let shared = shared(&commands);
    page += "\n## Options of an AFU\n\n";
    page += "These options describe the AFU. They are the same in every command that has them.\n\n";
    shared.iter().for_each(|option| page += &definition(option));
    for command in &commands {
        page += &section(command, &shared);
    }
    page
}

/// The options under [`SHARED`] of `cosim`, which has all of them.
fn shared<'a>(commands: &[&'a Command]) -> Vec<&'a Arg> {
    let cosim = commands.iter().find(|command| command.get_name() == "cosim").expect("a command");
    options(cosim).into_iter().filter(|option| option.get_help_heading() == Some(SHARED)).collect()
}

fn options(command: &Command) -> Vec<&Arg> {
    command.get_arguments().filter(|option| !["help", "version"].contains(&option.get_id().as_str())).collect()
}

/// A command: what it does, its usage, its options.
fn section(command: &Command, shared: &[&Arg]) -> String {
    let name = command.get_name();
    let about = command.get_long_about().or(command.get_about()).expect("a description").to_string();
    let mut text = format!("\n## afu {name}\n\n{}", paragraphs(&about, 0));
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage:").split_whitespace().collect::<Vec<_>>().join(" ");
    _ = write!(text, "\nUsage: `{usage}`\n\n");
    if usage::SIMULATED.contains(&name) {
        text += "This command needs the feature `cosim`, which is built in by default.\n\n";
    }
    if let Some(needs) = command.get_after_help().map(ToString::to_string) {
        let needs = needs.trim_end_matches(", which is built in.");
        _ = write!(text, "{}, which is not built in by default.\n\n", needs.replace("ode", "`ode`"));
    }
    let is_shared = |option: &Arg| shared.iter().any(|known| definition(known) == definition(option));
    let all = options(command);
    let own: Vec<&&Arg> = all.iter().filter(|option| !is_shared(option)).collect();
    own.iter().for_each(|option| text += &definition(option));
    let missing: Vec<String> = shared
        .iter()
        .filter(|known| !all.iter().any(|option| definition(option) == definition(known)))
        .filter(|known| !own.iter().any(|option| option.get_id() == known.get_id()))
        .map(|known| format!("`--{}`", known.get_id().as_str().replace('_', "-")))
        .collect();
    if all.iter().any(|option| is_shared(option)) {
        let but = if missing.is_empty() { String::new() } else { format!(" except {}", missing.join(", ")) };
        _ = writeln!(text, "- all [options of an AFU](#options-of-an-afu){but}");
    }
    text
}

/// An option as an item of a list: its name and value, its text, its values and its default.
fn definition(option: &Arg) -> String {
    let value = |separator: &str| {
        let names: Vec<&str> = option.get_value_names().unwrap_or_default().iter().map(|name| name.as_str()).collect();
        let takes_values = option.get_action().takes_values();
        if takes_values && !names.is_empty() { format!("{separator}{}", names.join(" ")) } else { String::new() }
    };
    let name = match option.get_long() {
        Some(long) => format!("--{long}{}", value(" ")),
        None => value(""),
    };
    let required = if option.is_required_set() { " (required)" } else { "" };
    let help = option.get_long_help().or(option.get_help()).expect("a description").to_string();
    // A default that clap does not know stands in brackets at the end of the first paragraph.
    let (first, rest) = help.split_once("\n\n").unwrap_or((&help, ""));
    let (first, told) = match first.split_once(" [default: ") {
        Some((first, default)) => (first, Some(default.trim_end_matches(']').to_owned())),
        None => (first, None),
    };
    let of_clap = option.get_default_values().iter().map(|value| format!("`{}`", value.to_string_lossy()));
    let of_clap: Vec<String> = if option.get_action().takes_values() { of_clap.collect() } else { Vec::new() };
    let default = told.or_else(|| Some(of_clap.join(",")).filter(|text| !text.is_empty()));
    let mut text = format!("- **`{name}`**{required}  \n  {}.\n", sentence(first));
    if let Some(default) = default {
        _ = writeln!(text, "  Default: {default}.");
    }
    if !rest.is_empty() {
        _ = writeln!(text, "  {}", rest.replace("\n\n", "\n  ").trim_end());
    }
    for value in option.get_possible_values() {
        if option.get_action().takes_values() && !value.is_hide_set() {
            let about = value.get_help().map(|help| format!(": {help}")).unwrap_or_default();
            _ = writeln!(text, "  - `{}`{about}", value.get_name());
        }
    }
    text
}

/// A text's first line without its full stop, which follows it.
fn sentence(text: &str) -> &str {
    text.trim_end().trim_end_matches('.')
}

/// The paragraphs of a help text from the one numbered `from`, the first ending in a full stop.
fn paragraphs(text: &str, from: usize) -> String {
    let all = text.split("\n\n").skip(from).map(|paragraph| format!("{}.\n", sentence(paragraph)));
    all.collect::<Vec<_>>().join("\n")
}

#[test]
fn the_page_of_options_is_what_the_help_says() {
    let path = super::root().join("docs/options.md");
    let page = page();
    if std::env::var_os("UPDATE_EXPECT").is_some_and(|value| value == "1") {
        return std::fs::write(&path, &page).expect("written");
    }
    let was = std::fs::read_to_string(&path).unwrap_or_default();
    let line = was.lines().zip(page.lines()).position(|(was, is)| was != is).unwrap_or(was.lines().count());
    let (was_line, is_line) = (was.lines().nth(line), page.lines().nth(line));
    assert!(was == page, "docs/options.md:{}: expected {is_line:?}, found {was_line:?}", line + 1);
}
