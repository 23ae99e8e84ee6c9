//! The Verilated AFU in each profile, with its shell and a link: an invalid pair does not affect its neighbours, and a
//! hostile link does not affect a job's results.

mod hostile;
mod invalid;

use contact_afu::config::{Config, Profile, Shell};
use contact_afu::verify::Bench;

/// A bench per profile, with models that other tests use too.
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
