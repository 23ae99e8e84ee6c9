//! What a reader of the Verilog meets in every configuration: lines that fit a screen.

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Multipliers, Results, Shell};

/// Configurations that between them have every module and every way to write it.
fn configurations() -> Vec<Config> {
    let shipped = Config::shipped();
    let with = |profile: &str, contact: &str, interval: u32| Config {
        profile: profile.parse().unwrap(),
        contact: contact.parse().unwrap(),
        interval,
        ..Config::shipped()
    };
    let hits = |contact: &str| Config { results: Results::Hits, ..with("wide", contact, 1) };
    vec![
        shipped.clone(),
        Config { interval: 1, ..shipped.clone() },
        Config { interval: 2, scpus: 64, ..shipped.clone() },
        Config { interval: 10, ..shipped.clone() },
        Config { shell: Shell::Line, prefix: Some("a_prefix_of_a_long_name".to_owned()), ..shipped.clone() },
        Config { multipliers: Multipliers::Spare, ..shipped },
        with("wide", "hit", 1),
        with("wide", "hit", 5),
        with("exact", "hit,depth,normal,position", 1),
        with("paper", "hit,depth,normal,position", 10),
        with("half", "depth", 3),
        with("e11f52", "position,depth", 1),
        hits("hit"),
        hits("depth"),
        hits("hit,depth,normal,position"),
    ]
}

/// Each line of each module's file, with what it is a line of. Benches also hold data.
fn lines() -> Vec<(String, String)> {
    let mut found = Vec::new();
    for config in configurations() {
        let files = Afu::generate(Spec::from(config.clone())).unwrap().files();
        for (name, text) in files.into_iter().filter(|(name, _)| name.ends_with(".v") && !name.contains('/')) {
            let place = format!("{name} of {} at interval {}", config.profile, config.interval);
            found.extend(text.lines().map(|line| (place.clone(), line.to_owned())));
        }
    }
    assert!(found.len() > 20_000, "{} lines", found.len());
    found
}

#[test]
fn every_line_fits_120_columns() {
    for (place, line) in lines() {
        assert!(line.len() <= 120, "{place}: {} columns: {line}", line.len());
        assert_eq!(line.trim_end(), line, "{place}: space at the end");
    }
}
