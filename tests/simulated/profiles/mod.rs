//! The Verilated AFU in each profile, through its shell and a link: what an invalid pair does to its neighbours, and
//! what a hostile link does to a job. Nothing.

mod hostile;
mod invalid;

use contact_afu::config::{Config, Profile, Shell};
use contact_afu::verify::Bench;

/// A bench of each profile, of the models that other tests have too.
fn benches() -> impl Iterator<Item = (&'static str, Bench)> {
    [
        ("paper", Config { scpus: 2, shell: Shell::Line, ..Config::default() }),
        ("wide", Config::default()),
        ("exact", Config { scpus: 1, ..Config::default() }),
    ]
    .into_iter()
    .map(|(name, config)| {
        let profile: Profile = name.parse().expect("a profile");
        (name, Bench::new(&Config { profile, ..config }).expect("a model"))
    })
}
