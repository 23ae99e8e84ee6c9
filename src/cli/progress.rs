//! What long work shows on standard error: a bar on a terminal, lines elsewhere.

use std::io::{self, IsTerminal};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// A bar over so many of something.
pub fn bar(title: &str, unit: &str, length: u64) -> ProgressBar {
    let bar = ProgressBar::new(length);
    // A wrong template would be a bar without one.
    let template = format!("{{prefix}} [{{bar:30}}] {{human_pos}} of {{human_len}} {unit}, {{eta}} left");
    if let Ok(style) = ProgressStyle::with_template(&template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.set_prefix(title.to_owned());
    bar
}

/// Shows work behind a full bar, whose length nobody knows: nothing stands still.
#[cfg(feature = "cosim")]
pub fn behind(bar: &ProgressBar, what: &str) {
    bar.set_style(working());
    bar.set_message(format!("{}: {what}", bar.prefix()));
    bar.reset_elapsed();
    bar.enable_steady_tick(TICK);
}

/// Says something where there is no terminal to show a bar.
pub fn line(what: &str) {
    if !io::stderr().is_terminal() {
        eprintln!("{what}");
    }
}

const TICK: Duration = Duration::from_millis(200);

/// A spinner with a message and the time since it began.
fn working() -> ProgressStyle {
    ProgressStyle::with_template("{spinner} {msg}, {elapsed}").unwrap_or_else(|_| ProgressStyle::default_spinner())
}

/// A spinner for a study: how far it is, and what is being done.
pub fn study() -> ProgressBar {
    let study = spinner("");
    if let Ok(style) = ProgressStyle::with_template("{spinner} {prefix}{msg}, {elapsed}") {
        study.set_style(style);
    }
    study
}

/// A spinner for work whose length nobody knows.
pub fn spinner(title: &str) -> ProgressBar {
    let spinner = ProgressBar::new_spinner();
    spinner.set_style(working());
    spinner.set_message(title.to_owned());
    spinner.enable_steady_tick(TICK);
    spinner
}
