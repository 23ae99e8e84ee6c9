//! The options of the command line that give a configuration.

use super::{Config, Input};
use crate::query::Fields;

impl Config {
    /// The options that give this configuration, without those at their defaults. The interval is always included,
    /// because its default on the command line depends on SCPUs and link.
    pub fn flags(&self) -> Vec<String> {
        let default = Self::default();
        // Input spheres has fields and a shell by default that are its own, and SCPUs behind deciders a number, so
        // these are always named. A search for numbers alone has no SCPUs.
        let is_search = self.input == Input::Spheres;
        let unless_search = |usual: String| if is_search { String::new() } else { usual };
        let scpus = match self.contact {
            Fields::HIT if is_search => self.scpus.to_string(),
            Fields::HIT => default.scpus.to_string(),
            _ if self.has_deciders() => String::new(),
            _ => default.scpus.to_string(),
        };
        let radius = |config: &Self| config.radius.map_or(String::new(), |radius| radius.to_string());
        let cut = |config: &Self| config.cut_mhz.map_or(String::new(), |clock| clock.to_string());
        let pairs = [
            ("--scpus", self.scpus.to_string(), scpus),
            ("--interval", self.interval.to_string(), String::new()),
            ("--query", self.query.to_string(), default.query.to_string()),
            ("--profile", self.profile.to_string(), default.profile.to_string()),
            ("--contact", self.contact.to_string(), unless_search(default.contact.to_string())),
            ("--input", self.input.to_string(), default.input.to_string()),
            ("--table", self.search.table.to_string(), default.search.table.to_string()),
            ("--box-bits", self.search.box_bits.to_string(), default.search.box_bits.to_string()),
            ("--lanes", self.search.lanes.to_string(), default.search.lanes.to_string()),
            ("--deciders", self.search.deciders.to_string(), default.search.deciders.to_string()),
            ("--decide", self.decide.to_string(), default.decide.to_string()),
            ("--results", self.results.to_string(), default.results.to_string()),
            ("--radius", radius(self), radius(&default)),
            ("--record", self.record.to_string(), default.record.to_string()),
            ("--multipliers", self.multipliers.to_string(), default.multipliers.to_string()),
            ("--shell", self.shell.to_string(), unless_search(default.shell.to_string())),
            ("--outstanding", self.outstanding.to_string(), default.outstanding.to_string()),
            ("--bus", self.bus.to_string(), default.bus.to_string()),
            ("--clock", self.clock_mhz.to_string(), default.clock_mhz.to_string()),
            ("--cut-for", cut(self), cut(&default)),
            ("--prefix", self.prefix.clone().unwrap_or_default(), String::new()),
        ];
        let differing = pairs.into_iter().filter(|(_, mine, default)| mine != default);
        differing.flat_map(|(flag, mine, _)| [flag.to_owned(), mine]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Multipliers, Results, Shell};

    #[test]
    fn flags_name_only_what_differs() {
        assert_eq!(Config::default().flags(), ["--interval", "1"]);
        let config = Config { scpus: 3, profile: "paper".parse().expect("a profile"), ..Config::default() };
        assert_eq!(config.flags(), ["--scpus", "3", "--interval", "1", "--profile", "paper"]);
        let sparing = Config { multipliers: Multipliers::Spare, ..Config::default() };
        assert_eq!(sparing.flags(), ["--interval", "1", "--multipliers", "spare"]);
        let reached = Config { clock_mhz: 169.1, cut_mhz: Some(200.0), ..Config::default() };
        assert_eq!(reached.flags(), ["--interval", "1", "--clock", "169.1", "--cut-for", "200"]);
        let far = Config { outstanding: 256, shell: Shell::Line, ..Config::default() };
        assert_eq!(far.flags(), ["--interval", "1", "--shell", "line", "--outstanding", "256"]);
        let spheres = Config { input: Input::Spheres, results: Results::Hits, ..Config::default() };
        let named =
            ["--scpus", "10", "--interval", "1", "--contact", "hit,depth,normal,position", "--input", "spheres"];
        assert_eq!(spheres.flags()[..8], named);
        assert_eq!(spheres.flags()[8..], ["--results", "hits", "--shell", "spl2"]);
        let numbers = Config { scpus: 1, contact: Fields::HIT, ..spheres };
        assert_eq!(numbers.flags()[..4], ["--interval", "1", "--contact", "hit"]);
    }
}
