//! What the AFUs of a sweep differ in.

use serde::{Deserialize, Serialize};

use crate::config::{Config, Input};
use crate::count::counted;
use crate::query::Fields;

/// What distinguishes an AFU from the others of its sweep. What its kind of AFU does not have is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Size {
    /// Boxes of spheres that are compared in a cycle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lanes: Option<u32>,
    /// Kernels that decide candidates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deciders: Option<u32>,
    /// Bits of each number of a box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub box_bits: Option<u32>,
    /// Sphere Collision Processing Units.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scpus: Option<u32>,
    /// Cycles from one pair to the next in one SCPU.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<u32>,
}

impl Size {
    /// The size of a configuration.
    pub fn of(config: &Config) -> Self {
        let (search, searches) = (&config.search, config.input == Input::Spheres);
        let of_search = |value: u32| searches.then_some(value);
        // Where the search alone is asked, there are no SCPUs.
        let of_scpus = |value: u32| (!searches || config.contact != Fields::HIT).then_some(value);
        Self {
            lanes: of_search(search.lanes),
            deciders: of_search(search.deciders),
            box_bits: of_search(search.box_bits),
            scpus: of_scpus(config.scpus),
            interval: of_scpus(config.interval),
        }
    }

    /// The size in few words, where others say that they are sizes of SCPUs.
    pub(super) fn short(&self) -> String {
        match (self.lanes, self.scpus, self.interval) {
            (None, Some(scpus), Some(interval)) => format!("{scpus} at interval {interval}"),
            _ => self.title(),
        }
    }

    /// The size in words.
    pub fn title(&self) -> String {
        let parts = [
            self.lanes.map(|lanes| counted(lanes.into(), "lane")),
            self.deciders.map(|deciders| counted(deciders.into(), "decider")),
            self.box_bits.map(|bits| format!("boxes of {bits} bits")),
            self.scpus.map(|scpus| counted(scpus.into(), "SCPU")),
            self.interval.map(|interval| format!("interval {interval}")),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

/// The options that a sweep varies: there is a row for each combination of their values. A list is empty where the
/// AFUs have no such option.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Swept {
    /// Numbers of SCPUs.
    pub scpus: Vec<u32>,
    /// Intervals.
    pub interval: Vec<u32>,
    /// Lanes, of AFUs that are sent spheres.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lanes: Vec<u32>,
    /// Deciders, likewise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub deciders: Vec<u32>,
    /// Bits of a box, likewise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub box_bits: Vec<u32>,
}

impl Swept {
    /// The configurations of all combinations, which have the rest of `base`. The last list changes first.
    pub fn configs(&self, base: &Config) -> Vec<Config> {
        let usual = &base.search;
        let mut configs = vec![base.clone()];
        type Set = fn(&mut Config, u32);
        let lists: [(&[u32], u32, Set); 5] = [
            (&self.interval, base.interval, |config, interval| config.interval = interval),
            (&self.scpus, base.scpus, |config, scpus| config.scpus = scpus),
            (&self.deciders, usual.deciders, |config, deciders| config.search.deciders = deciders),
            (&self.lanes, usual.lanes, |config, lanes| config.search.lanes = lanes),
            (&self.box_bits, usual.box_bits, |config, bits| config.search.box_bits = bits),
        ];
        for (list, usual, set) in lists {
            let values = if list.is_empty() { std::slice::from_ref(&usual) } else { list };
            let with = |config: &Config, value: u32| {
                let mut config = config.clone();
                set(&mut config, value);
                config
            };
            configs = configs.iter().flat_map(|config| values.iter().map(move |value| with(config, *value))).collect();
        }
        configs
    }

    /// True if an AFU of this size is one of the sweep.
    pub(super) fn has(&self, size: &Size) -> bool {
        [
            (&self.scpus, size.scpus),
            (&self.interval, size.interval),
            (&self.lanes, size.lanes),
            (&self.deciders, size.deciders),
            (&self.box_bits, size.box_bits),
        ]
        .into_iter()
        .all(|(list, value)| value.is_none_or(|value| list.contains(&value)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_combination_is_a_configuration() {
        let base = Config { input: Input::Spheres, ..Config::default() };
        let [two, bits] = [vec![1, 2], vec![10, 24]];
        let swept = Swept { lanes: vec![16, 32], box_bits: bits, scpus: two, interval: vec![1], ..Swept::default() };
        let sizes: Vec<_> = swept.configs(&base).iter().map(Size::of).collect();
        assert_eq!((sizes.len(), swept.configs(&base)[0].search.deciders), (8, base.search.deciders));
        assert_eq!(sizes[1].title(), "16 lanes, 4 deciders, boxes of 24 bits, 1 SCPU, interval 1");
        assert_eq!([sizes[2].lanes, sizes[4].scpus], [Some(32), Some(2)]);
        let asked = Swept { deciders: vec![4], ..swept };
        assert!(sizes.iter().all(|size| asked.has(size)));
        assert!(!asked.has(&Size { lanes: Some(64), ..sizes[0] }));
        let hits = Config { contact: Fields::HIT, ..base };
        assert_eq!(Size::of(&hits).title(), "16 lanes, 4 deciders, boxes of 24 bits");
    }
}
