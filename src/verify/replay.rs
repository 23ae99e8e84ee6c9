//! The command that runs a job again.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::config::Config;
use crate::link::{Description, LinkModel};

/// Stands for the file with a job's pairs in a command.
const PAIRS: &str = "PAIRS.csv";

/// The AFU, link and seed of a job. With the same pairs, [`Bench::run`](super::Bench::run) repeats the job cycle by
/// cycle. Its text is a line that says this, with the command.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// The AFU.
    pub config: Config,
    /// The folder its Verilog was read from, if it was not generated.
    pub folder: Option<PathBuf>,
    /// The link.
    pub link: LinkModel,
    /// The seed of the link, and of the initial values of registers without a reset.
    pub seed: u64,
}

impl Setup {
    /// The command that runs the job again, in which `PAIRS.csv` stands for its pairs
    /// ([`write_pairs`](crate::pairs::write_pairs)). `None` if the link has no name.
    pub fn command(&self) -> Option<String> {
        let Self { config, folder, link, seed } = self;
        let known = link.name.parse::<Description>().and_then(|known| known.at(config.clock_mhz)).ok()?;
        if known != *link {
            return None;
        }
        let command = match folder {
            None => Command::new("cosim").config(config),
            Some(folder) => Command::new("cosim").folder(folder, config.scpus),
        };
        Some(command.option("--pairs", PAIRS).option("--link", &link.name).option("--seed", &seed.to_string()).line())
    }
}

impl fmt::Display for Setup {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the same pairs over the link `{}` with seed {}", self.link.name, self.seed)?;
        match self.command() {
            Some(command) => write!(f, "; with the pairs in a file (pairs::write_pairs): {command}"),
            None => Ok(()),
        }
    }
}

/// Builds a command line, quoted for a POSIX shell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Command(String);

impl Command {
    /// `afu SUBCOMMAND`.
    pub fn new(subcommand: &str) -> Self {
        Self(format!("afu {subcommand}"))
    }

    /// Adds the options of a configuration.
    #[must_use]
    pub fn config(mut self, config: &Config) -> Self {
        config.flags().iter().for_each(|word| self.word(word));
        self
    }

    /// Adds the options of Verilog that was read from a folder.
    #[must_use]
    pub fn folder(self, folder: &Path, scpus: u32) -> Self {
        self.option("--rtl", &folder.display().to_string()).option("--scpus", &scpus.to_string())
    }

    /// Adds an option with its value.
    #[must_use]
    pub fn option(mut self, name: &str, value: &str) -> Self {
        self.word(name);
        self.word(value);
        self
    }

    /// The command line.
    pub fn line(self) -> String {
        self.0
    }

    fn word(&mut self, word: &str) {
        self.0.push(' ');
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,=+@%".contains(c);
        if !word.is_empty() && word.chars().all(plain) {
            self.0.push_str(word);
        } else {
            self.0.push_str(&format!("'{}'", word.replace('\'', r"'\''")));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_shell_would_change_is_quoted() {
        let config = Config { scpus: 3, ..Config::default() };
        let line =
            Command::new("cosim").config(&config).option("--pairs", "my pairs.csv").option("--link", "it's").line();
        assert_eq!(line, r"afu cosim --scpus 3 --interval 1 --pairs 'my pairs.csv' --link 'it'\''s'");
    }

    #[test]
    fn only_a_link_that_the_program_knows_is_in_a_command() {
        let config = Config { scpus: 3, ..Config::default() };
        let harp = "harp1".parse::<Description>().and_then(|link| link.at(config.clock_mhz)).expect("a preset");
        let mut setup = Setup { config, folder: None, link: harp, seed: 7 };
        let command = setup.command().expect("a preset");
        assert_eq!(command, "afu cosim --scpus 3 --interval 1 --pairs PAIRS.csv --link harp1 --seed 7");
        setup.folder = Some("my rtl".into());
        let command = setup.command().expect("a preset");
        assert_eq!(command, "afu cosim --rtl 'my rtl' --scpus 3 --pairs PAIRS.csv --link harp1 --seed 7");
        setup.link.read.tail += 1;
        assert_eq!(setup.command(), None);
        assert_eq!(setup.to_string(), "the same pairs over the link `harp1` with seed 7");
    }
}
