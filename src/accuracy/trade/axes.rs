//! The configurations of a study.

use crate::config::{Config, Profile, RecordFormat, Shell};
use crate::number::{Format, Roots};

/// The configuration that a study uses: one SCPU without a shell. The results for more SCPUs follow from it.
fn one(config: Config) -> Config {
    Config { scpus: 1, shell: Shell::Line, ..config }
}

/// The name of a configuration: its profile, and every option that differs from the default.
pub fn name(config: &Config) -> String {
    let default = Config::default();
    let rest = Config { scpus: default.scpus, shell: default.shell, profile: default.profile, ..config.clone() };
    let others = rest.flags().join(" ").replace("--", "");
    let others = others.strip_prefix("interval 1").unwrap_or(&others).trim_start();
    format!("{} {others}", config.profile).trim_end().to_owned()
}

/// A value of an axis: the axis, and the configuration.
pub type Choice = (&'static str, Config);

fn profile(name: &str) -> Option<Config> {
    // An invalid name is left out. Tests check that there is none.
    name.parse::<Profile>().ok().map(|profile| one(Config { profile, ..Config::default() }))
}

/// The given profiles.
pub(super) fn chosen(profiles: Vec<Profile>) -> Vec<Choice> {
    profiles.into_iter().map(|profile| ("profile", one(Config { profile, ..Config::default() }))).collect()
}

fn profiles(axis: &'static str, names: &[&str]) -> Vec<Choice> {
    names.iter().filter_map(|name| profile(name)).map(|config| (axis, config)).collect()
}

fn clocks(mhz: &[f64]) -> Vec<Choice> {
    mhz.iter().map(|&clock_mhz| ("clock", one(Config { clock_mhz, ..Config::default() }))).collect()
}

fn intervals(cycles: &[u32]) -> Vec<Choice> {
    cycles.iter().map(|&interval| ("interval", one(Config { interval, ..Config::default() }))).collect()
}

fn records(choices: &[(&str, RecordFormat)]) -> Vec<Choice> {
    let of = |&(name, record): &(&str, RecordFormat)| profile(name).map(|config| Config { record, ..config });
    choices.iter().filter_map(of).map(|config| ("record", config)).collect()
}

/// One row per profile, from narrow to exact.
pub(super) fn of_profiles() -> Vec<Choice> {
    profiles("profile", &["half", "bfloat", "e8f15", "paper", "wide", "wide+faithful", "exact"])
}

/// Some ten configurations.
pub(super) fn few() -> Vec<Choice> {
    [of_profiles(), profiles("fraction bits", &["e10f11z", "e10f19z"]), clocks(&[100.0])].concat()
}

/// One axis at a time from `wide`.
pub(super) fn each_alone() -> Vec<Choice> {
    let fraction: Vec<String> =
        [5, 7, 9, 11, 13, 15, 17, 19, 21, 22, 24, 25, 27].map(|bits| format!("e10f{bits}z")).to_vec();
    let exponent: Vec<String> = [7, 9, 11].map(|bits| format!("e{bits}f23z")).to_vec();
    let of = |axis, list: &[String]| profiles(axis, &list.iter().map(String::as_str).collect::<Vec<_>>());
    [
        of_profiles(),
        of("fraction bits", &fraction),
        of("exponent bits", &exponent),
        profiles("subnormals", &["wide+kept", "paper+flushed"]),
        profiles("rounding", &["wide+zero", "paper+zero"]),
        profiles("roots", &["paper+faithful", "e10f15zr", "e10f19zr"]),
        clocks(&[50.0, 100.0, 150.0, 250.0, 300.0]),
        records(&[
            ("half", RecordFormat::F16),
            ("bfloat", RecordFormat::Bf16),
            ("e8f15", RecordFormat::F16),
            ("e8f15", RecordFormat::Bf16),
            ("wide", RecordFormat::F16),
            ("wide", RecordFormat::Bf16),
            ("wide+faithful", RecordFormat::F16),
        ]),
        intervals(&[2, 4]),
    ]
    .concat()
}

/// Configurations that are one step from `config`: one fraction or exponent bit more or less, roots of the other kind,
/// the next clock up or down, records of another format.
pub(super) fn neighbours(config: &Config) -> Vec<Choice> {
    let format = config.profile.format();
    let (exponent, fraction) = (format.exponent_bits(), format.fraction_bits());
    let with = |exponent, fraction, roots| {
        let other = Format::new(exponent, fraction, format.subnormals()).ok()?.with_rounding(format.rounding());
        // The text names the profile of that format.
        other.with_roots(roots).ok()?.to_string().parse::<Profile>().ok()
    };
    let other_roots = if format.roots() == Roots::Correct { Roots::Faithful } else { Roots::Correct };
    let formats = match config.profile.is_exact() {
        true => Vec::new(),
        false => vec![
            with(exponent, fraction, other_roots),
            with(exponent, fraction + 1, format.roots()),
            with(exponent, fraction - 1, format.roots()),
            with(exponent - 1, fraction, format.roots()),
            with(exponent + 1, fraction, format.roots()),
        ],
    };
    let formats = formats.into_iter().flatten().map(|profile| Config { profile, ..config.clone() });
    let clocks = [0.75, 1.25].map(|factor| Config { clock_mhz: (config.clock_mhz * factor).round(), ..config.clone() });
    let others = [RecordFormat::F32, RecordFormat::F16, RecordFormat::Bf16]
        .into_iter()
        .filter(|&record| record != config.record);
    let records = others.map(|record| Config { record, ..config.clone() });
    formats.chain(clocks).chain(records).map(|config| ("neighbour of the front", config)).collect()
}

/// True if two configurations are the same under two names.
pub(super) fn is_same(a: &Config, b: &Config) -> bool {
    let renamed = Config { profile: a.profile.clone(), ..b.clone() };
    a.profile.arithmetic() == b.profile.arithmetic() && *a == renamed
}

/// The same choices without repetitions and without those that cannot be generated, which are returned separately with
/// the reason.
pub(super) fn possible(choices: Vec<Choice>) -> (Vec<Choice>, Vec<String>) {
    let (mut good, mut left_out): (Vec<Choice>, Vec<String>) = (Vec::new(), Vec::new());
    for (axis, config) in choices {
        match config.check() {
            Err(error) => left_out.push(error.to_string()),
            Ok(()) => {
                if !good.iter().any(|(_, other)| is_same(other, &config)) {
                    good.push((axis, config));
                }
            }
        }
    }
    left_out.dedup();
    (good, left_out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn configurations_have_the_names_one_would_give() {
        let wide = profile("wide").expect("a profile");
        assert_eq!(name(&wide), "wide");
        assert_eq!(name(&Config { clock_mhz: 300.0, ..wide }), "wide clock 300");
        assert_eq!(name(&profile("e8f15").expect("a profile")), "e8f15");
    }

    #[test]
    fn every_name_is_a_profile_and_nothing_comes_twice() {
        assert_eq!(of_profiles().len(), 7);
        assert_eq!(few().len(), 10);
        let (good, left_out) = possible(each_alone());
        assert_eq!(good.len(), 7 + 13 + 3 + 2 + 2 + 3 + 5 + 7 + 2);
        assert!(good.len() >= 40 && left_out.is_empty(), "{left_out:?}");
        let (_, left_out) = possible(intervals(&[0, 1, 100]));
        assert_eq!(left_out.len(), 2, "{left_out:?}");
        assert!(left_out[0].starts_with("interval 0"), "{left_out:?}");
        // wide is e10f23z under another name.
        let (two, _) = possible([profiles("a", &["wide", "e10f23z"]), profiles("b", &["e10f24z"])].concat());
        assert_eq!(two.len(), 2);
        let around = neighbours(&profile("wide").expect("a profile"));
        let names: Vec<_> = around.iter().map(|(_, config)| name(config)).collect();
        assert_eq!(names[..5], ["e10f23zr", "e10f24z", "e10f22z", "e9f23z", "e11f23z"]);
        assert_eq!(names[5..], ["wide clock 150", "wide clock 250", "wide record f16", "wide record bf16"]);
    }
}
