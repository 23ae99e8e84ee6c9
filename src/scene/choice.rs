//! What to build for a scene whose spheres are sent: sizes of the search, by the cycle model on the scene's start.

use super::still::Still;
use super::{Plan, Scene, SceneError};
use crate::afu::{Predicted, SearchModel, Spec};
use crate::config::{Config, DECIDERS, Input, LANES, Results, Search};
use crate::link::LinkModel;
use crate::query::Fields;
use crate::record::sphere_lines;
use crate::report::table::{counted, grouped, table};

/// More hardware must take at least this part less time to be worth it.
const GAIN: f64 = 0.1;
/// SCPUs and their interval, from the fewest operators to the most.
const SCPUS: [(u32, u32); 7] = [(1, 16), (1, 8), (1, 4), (1, 2), (1, 1), (2, 1), (4, 1)];

/// An AFU that was considered, and what the model says about it.
#[derive(Clone, Debug)]
pub struct Considered {
    /// The AFU.
    pub config: Config,
    /// Its cycles over the link, and its stages.
    pub predicted: Predicted,
}

impl Considered {
    /// The cycles that it takes.
    pub fn cycles(&self) -> f64 {
        self.predicted.cycles as f64
    }

    /// What sets the pace: the link, or the stage with the most steps.
    pub fn slowest(&self) -> &'static str {
        self.predicted.slowest()
    }
}

/// What pairs would take instead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pairs {
    /// The pairs that the host must find and send.
    pub sent: u64,
    /// The SCPUs at interval 1 that take them as fast as the link brings them.
    pub scpus: u64,
    /// The cycles that the link needs at least.
    pub link_cycles: f64,
    /// Bytes over the link in both directions, in whole lines.
    pub bytes: u64,
}

/// What to build for a scene whose spheres are sent.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Spheres at the start.
    pub spheres: u64,
    /// Pairs whose boxes meet.
    pub candidates: u64,
    /// Pairs that touch.
    pub contacts: u64,
    /// Bytes over the link in both directions, in whole lines.
    pub bytes: u64,
    /// What was taken, one after another, before the choice.
    pub before: Vec<Considered>,
    /// The AFU to build.
    pub chosen: Considered,
    /// The same scene with pairs.
    pub pairs: Pairs,
}

impl Choice {
    /// The choice for a scene. `plan` is its plan for pairs; `base` is the AFU for spheres, whose lanes, deciders,
    /// SCPUs and interval are chosen here.
    ///
    /// The smallest search is the beginning. The slowest of lanes and deciders is doubled as long as that takes a
    /// tenth less time and the link does not set the pace. Then come the fewest SCPUs to which more would not gain a
    /// tenth, if more than numbers come back.
    ///
    /// # Errors
    /// Returns an error if a file of bodies cannot be read, or if there is no such AFU.
    pub fn of(scene: &Scene, plan: &Plan, base: &Config, link: &LinkModel) -> Result<Self, SceneError> {
        let still = Still::of(scene)?;
        let sets = still.sets().0;
        let model = SearchModel::new(base, &sets)?;
        let contacts = model.contacts();
        let lines = |set: &Vec<_>| sphere_lines(set.len() as u64);
        let read = lines(&sets.first) + sets.second.as_ref().map_or(0, lines);
        let written = |config: &Config| Spec::from(config.clone()).layout().destination_lines(contacts);
        let consider =
            |config: Config| Ok::<_, SceneError>(Considered { predicted: model.predict(&config, link)?, config });
        // The search is sized for numbers alone, so that no SCPU slows it down.
        let sized = |lanes, deciders| {
            let search = Search { lanes, deciders, ..base.search };
            let numbers =
                Config { input: Input::Spheres, results: Results::Hits, contact: Fields::HIT, ..base.clone() };
            consider(Config { search, scpus: 1, interval: 1, ..numbers })
        };
        // Contacts take the link longer than their numbers.
        let limit = link.limit_cycles(read, written(base));
        let mut before = Vec::new();
        let mut chosen = sized(*LANES.start(), *DECIDERS.start())?;
        'larger: while limit < (1.0 - GAIN) * chosen.cycles() {
            for (lanes, deciders) in doubled(chosen.config.search, chosen.slowest()) {
                let larger = sized(lanes, deciders)?;
                if larger.cycles() < (1.0 - GAIN) * chosen.cycles() {
                    before.push(std::mem::replace(&mut chosen, larger));
                    continue 'larger;
                }
            }
            break;
        }
        if base.contact != Fields::HIT {
            let search = chosen.config.search;
            let with = |(scpus, interval)| Config { scpus, interval, contact: base.contact, search, ..base.clone() };
            let possible = SCPUS.into_iter().map(with);
            let possible = possible.filter(|config| Spec::from(config.clone()).unused_scpus().is_none());
            let all = possible.map(consider).collect::<Result<Vec<_>, _>>()?;
            let least = all.iter().map(Considered::cycles).fold(f64::INFINITY, f64::min);
            if let Some(enough) = all.into_iter().find(|one| (1.0 - GAIN) * one.cycles() <= least) {
                before.push(std::mem::replace(&mut chosen, enough));
            }
        }
        Ok(Self {
            spheres: sets.count() as u64,
            candidates: model.candidates(),
            contacts,
            bytes: 64 * (read + written(&chosen.config)),
            before,
            chosen,
            pairs: Pairs::of(plan, still.candidates.len() as u64, contacts, link),
        })
    }

    /// The choice in words: what was considered, and what pairs would take.
    pub fn text(&self) -> String {
        let each = |cycles: f64, config: &Config| cycles * config.cycle_ns() / self.spheres.max(1) as f64;
        let rows = self.before.iter().chain([&self.chosen]).map(|one| {
            let Config { search, contact, scpus, interval, .. } = &one.config;
            let of_scpus = |value: &u32| if *contact == Fields::HIT { "-".to_owned() } else { value.to_string() };
            vec![
                search.lanes.to_string(),
                search.deciders.to_string(),
                of_scpus(scpus),
                of_scpus(interval),
                grouped(one.predicted.cycles),
                grouped(one.predicted.link_cycles),
                format!("{:.2}", each(one.cycles(), &one.config)),
                one.slowest().to_owned(),
            ]
        });
        let heading =
            ["lanes", "deciders", "SCPUs", "interval", "cycles", "link, at least", "ns per sphere", "slowest"];
        let considered = table(&heading, rows);
        let us = |cycles: f64| format!("{:.2}", cycles * self.chosen.config.cycle_ns() / 1000.0);
        let pairs = &self.pairs;
        let rows = [
            ("sent", counted(self.spheres, "sphere"), counted(pairs.sent, "pair")),
            ("the host finds", "nothing".to_owned(), "those pairs".to_owned()),
            ("bytes over the link", grouped(self.bytes), grouped(pairs.bytes)),
            ("SCPUs at interval 1 to keep up with the link", "-".to_owned(), pairs.scpus.to_string()),
            ("µs at least, without the host", us(self.chosen.cycles()), us(pairs.link_cycles)),
        ];
        let rows = rows.into_iter().map(|(name, spheres, pairs)| [name.to_owned(), spheres, pairs]);
        let mut text = format!(
            "{}, {}, {}\n{considered}\n\n{}",
            counted(self.spheres, "sphere"),
            counted(self.candidates, "candidate"),
            counted(self.contacts, "contact"),
            table(&["", "spheres", "pairs"], rows)
        );
        if self.contacts == 0 && self.chosen.config.contact != Fields::HIT {
            text += "\n\nNo spheres touch at the start. If many do later, choose a shorter interval.";
        }
        text
    }
}

/// Larger sizes, the one that helps the slowest stage first. Stages may wait for one another, so both together come
/// last.
fn doubled(search: Search, slowest: &str) -> impl Iterator<Item = (u32, u32)> {
    let Search { lanes, deciders, .. } = search;
    let (by_lanes, by_deciders) = ((2 * lanes, deciders), (lanes, 2 * deciders));
    let [first, second] = if slowest == "deciders" { [by_deciders, by_lanes] } else { [by_lanes, by_deciders] };
    let all = [first, second, (2 * lanes, 2 * deciders)];
    all.into_iter().filter(|(lanes, deciders)| LANES.contains(lanes) && DECIDERS.contains(deciders))
}

impl Pairs {
    fn of(plan: &Plan, sent: u64, contacts: u64, link: &LinkModel) -> Self {
        let layout = Spec::from(plan.config.clone()).layout();
        let (read, written) = (layout.source_lines(sent), layout.destination_lines(contacts));
        let link_cycles = link.limit_cycles(read, written);
        // An SCPU at interval 1 takes a pair per cycle.
        let scpus = if sent == 0 { 0 } else { (sent as f64 / link_cycles.max(1.0)).ceil() as u64 };
        Self { sent, scpus, link_cycles, bytes: 64 * (read + written) }
    }
}
