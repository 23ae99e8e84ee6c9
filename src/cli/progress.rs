//! What long work shows on standard error: a bar, on a terminal only.

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

/// A bar over work whose length is guessed, and so is told only as a share.
#[cfg(feature = "cosim")]
pub fn share(title: &str) -> ProgressBar {
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{prefix} [{bar:30}] {percent} %, {elapsed}, about {eta} left") {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.set_prefix(title.to_owned());
    bar
}

/// A turning sign for work whose length nobody knows.
pub fn spinner(title: &str) -> ProgressBar {
    let spinner = ProgressBar::new_spinner();
    spinner.set_message(title.to_owned());
    spinner.enable_steady_tick(Duration::from_millis(200));
    spinner
}
