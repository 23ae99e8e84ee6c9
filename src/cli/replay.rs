//! The command that does a run again.

use contact_afu::config::Config;

/// A command line in the making, quoted for a POSIX shell.
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

    /// Adds an option with its value.
    #[must_use]
    pub fn option(mut self, name: &str, value: &str) -> Self {
        self.word(name);
        self.word(value);
        self
    }

    /// The line.
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
}
