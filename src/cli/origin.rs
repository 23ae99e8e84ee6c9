//! Where results come from: the command, the processor, the day.

#[cfg(feature = "cosim")]
use std::fs;
#[cfg(feature = "cosim")]
use std::time::{SystemTime, UNIX_EPOCH};

/// The command line.
#[cfg(all(feature = "cosim", feature = "ode"))]
pub fn command() -> String {
    std::iter::once("afu".to_owned()).chain(std::env::args().skip(1)).collect::<Vec<_>>().join(" ")
}

/// Options with a value, and flags, that decide no result of a study: where results go, and who measures.
const ELSEWHERE: [&str; 8] = ["--out", "--store", "--shard", "--lease", "--limit", "--study", "--json", "--jobs"];
const FLAGS: [&str; 2] = ["--force", "--no-software"];

/// The command line of a study without options that decide no result: the same for all processes that work on it.
pub fn study() -> String {
    study_of(std::env::args().skip(1))
}

fn study_of(arguments: impl Iterator<Item = String>) -> String {
    let mut words = vec!["afu".to_owned()];
    let mut arguments = arguments;
    while let Some(word) = arguments.next() {
        let name = word.split('=').next().unwrap_or_default();
        if FLAGS.contains(&name) {
            continue;
        }
        if ELSEWHERE.contains(&name) {
            if name == word {
                arguments.next();
            }
            continue;
        }
        words.push(word);
    }
    quoted(&words)
}

/// Words as a shell takes them: those that it would change stand in quotes.
pub fn quoted<T: AsRef<str>>(words: &[T]) -> String {
    let is_plain =
        |word: &str| !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || "_-./,:=+@%".contains(c));
    let quote = |word: &T| match word.as_ref() {
        word if is_plain(word) => word.to_owned(),
        word => shlex::try_quote(word).map_or_else(|_| word.to_owned(), |quoted| quoted.into_owned()),
    };
    words.iter().map(quote).collect::<Vec<_>>().join(" ")
}

/// What the processor calls itself.
#[cfg(feature = "cosim")]
pub fn processor() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(':'));
    name.map_or(std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

/// Today in UTC, year first.
#[cfg(feature = "cosim")]
pub fn today() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    day(seconds / 86_400)
}

/// The day so many days after 1 January 1970, in the Gregorian calendar.
#[cfg(feature = "cosim")]
fn day(mut days: u64) -> String {
    let is_leap = |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let mut year = 1970;
    while days >= 365 + u64::from(is_leap(year)) {
        days -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    format!("{year}-{month:02}-{:02}", days + 1)
}

#[cfg(test)]
mod tests {
    #[cfg(feature = "cosim")]
    use super::day;
    use super::study_of;

    #[test]
    fn a_study_s_command_says_what_decides_its_results() {
        let text = "sweep --scpus 1..4 --out o --store=s --shard 1/2 --force --pairs 'my pairs.csv' --json - --lease 5 --synth";
        let words = shlex::split(text).expect("quoted well");
        assert_eq!(study_of(words.into_iter()), "afu sweep --scpus 1..4 --pairs 'my pairs.csv' --synth");
    }

    #[cfg(feature = "cosim")]
    #[test]
    fn days_are_those_of_the_calendar() {
        for (days, text) in [
            (0, "1970-01-01"),
            (58, "1970-02-28"),
            (59, "1970-03-01"),
            (11_016, "2000-02-29"),
            (19_722, "2023-12-31"),
            (19_723, "2024-01-01"),
            (20_513, "2026-03-01"),
        ] {
            assert_eq!(day(days), text);
        }
    }
}
