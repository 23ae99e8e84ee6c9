//! Plans and runs as text.

use super::cost::Cost;
use super::plan::{Plan, Row};
use super::results::SceneRun;
use crate::config::Input;
use crate::pairs::npy_of_numbers;
use crate::query::{ContactRecord, FLAGS};
use crate::report::table::{grouped, table, words};

impl Plan {
    /// The plan as a table: the parts that are on, their values, and the lines that call for them.
    pub fn text(&self) -> String {
        words(&["", "", "value", "called for by"], self.rows.iter().map(row))
    }

    /// The differences of another plan: rows that differ, then costs side by side.
    ///
    /// # Errors
    /// Returns an error if there is no such AFU.
    pub fn difference(&self, other: &Self, mine: &Cost, theirs: &Cost) -> String {
        let differs = |row: &&Row| self.rows.iter().find(|mine| mine.name == row.name) != Some(*row);
        let rows: Vec<[String; 4]> = other.rows.iter().filter(differs).map(row).collect();
        let mut out = if rows.is_empty() {
            "no row of the plan changes".to_owned()
        } else {
            words(&["changes to", "", "value", "called for by"], rows)
        };
        out += "\n\n";
        out += &costs(&[("as it is", mine), ("then", theirs)]);
        out
    }
}

fn row(row: &Row) -> [String; 4] {
    [row.name.clone(), if row.on { "on" } else { "off" }.to_owned(), row.value.clone(), row.called_for_by().join("\n")]
}

impl Cost {
    /// The cost as a table.
    pub fn text(&self) -> String {
        costs(&[("", self)])
    }
}

impl Row {
    /// The lines that call for it, or a word that says that none does. For a group of bodies, only their numbers.
    pub(crate) fn called_for_by(&self) -> Vec<String> {
        match self.calls.as_slice() {
            [] if self.on => vec!["(default)".to_owned()],
            [] => vec!["nothing".to_owned()],
            [first, .., last] if self.calls.len() > 4 && last.line - first.line < self.calls.len() => {
                vec![format!("lines {} to {}", first.line, last.line)]
            }
            calls => calls
                .iter()
                .map(|call| match call.line {
                    0 => call.text.clone(),
                    line => format!("{line}: {}", call.text.trim_end_matches(',')),
                })
                .collect(),
        }
    }
}

/// An energy with a few significant digits.
fn energy(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-2..1e6).contains(&value.abs());
    if is_plain { format!("{value:.4}") } else { format!("{value:.4e}") }
}

/// Costs side by side.
pub fn costs(all: &[(&str, &Cost)]) -> String {
    let heading: Vec<&str> = std::iter::once("").chain(all.iter().map(|(name, _)| *name)).collect();
    table(&heading, cost_rows(&all.iter().map(|(_, cost)| *cost).collect::<Vec<_>>()))
}

/// Rows of a table of costs: the figure's name, then each cost's.
pub(super) fn cost_rows(all: &[&Cost]) -> Vec<Vec<String>> {
    let row = |name: &str, figure: &dyn Fn(&Cost) -> String| {
        std::iter::once(name.to_owned()).chain(all.iter().map(|cost| figure(cost))).collect::<Vec<_>>()
    };
    let of_spheres = all.iter().any(|cost| cost.input == Input::Spheres);
    let counted = |count: Option<u64>| count.map_or_else(|| "not counted".to_owned(), grouped);
    let mut rows = vec![
        row("modules of the AFU", &|cost| cost.modules.to_string()),
        row("cycles from a pair to its contact", &|cost| cost.latency_cycles.to_string()),
        row(if of_spheres { "bytes sent per sphere" } else { "bytes sent per pair" }, &|cost| {
            cost.bytes_sent.to_string()
        }),
        row("bytes that come back", &|cost| {
            let who = if cost.returns_misses { "per pair" } else { "per contact" };
            format!("{} {who}", cost.bytes_returned)
        }),
        row("LUTs per SCPU", &|cost| counted(cost.luts)),
        row("DSP blocks per SCPU", &|cost| counted(cost.dsps)),
        row("LUTs of all SCPUs", &|cost| counted(cost.luts_of_all)),
        row("DSP blocks of all SCPUs", &|cost| counted(cost.dsps_of_all)),
        row("host time per step, µs", &|cost| {
            cost.host_step_ns.map_or_else(|| "not measured".to_owned(), |ns| format!("{:.1}", ns / 1000.0))
        }),
    ];
    let mut names: Vec<&String> = all.iter().flat_map(|cost| cost.operators.keys()).collect();
    names.sort();
    names.dedup();
    for name in names {
        rows.push(row(name, &|cost| cost.operators.get(name).map_or_else(|| "none".to_owned(), ToString::to_string)));
    }
    rows
}

impl SceneRun {
    /// The counts of the run, each with its name.
    pub(super) fn rows(&self) -> Vec<Vec<String>> {
        let s = &self.summary;
        let mut rows = vec![
            ("bodies".to_owned(), grouped(s.bodies as u64)),
            ("steps".to_owned(), grouped(s.steps)),
            ("pairs of bodies that exist".to_owned(), grouped(s.all_pairs)),
            match self.config.input {
                Input::Direct => ("pairs sent, all steps".to_owned(), grouped(s.pairs)),
                Input::Spheres => ("spheres sent, all steps".to_owned(), grouped(s.spheres)),
            },
            ("contacts, all steps".to_owned(), grouped(s.contacts)),
            ("contacts with walls".to_owned(), grouped(s.wall_contacts)),
            ("bytes over the link".to_owned(), grouped(s.bytes as u64)),
            ("bytes with everything on".to_owned(), grouped(s.bytes_with_everything as u64)),
            (
                if s.steps > 0 { "host time per step, µs" } else { "time of the engine, µs" }.to_owned(),
                format!("{:.1}", s.step_ns / 1000.0),
            ),
        ];
        if let Some(cycles) = s.cycles {
            rows.push(("cycles of the AFU, all steps".to_owned(), grouped(cycles)));
        }
        rows.into_iter().map(|(name, value)| vec![name, value]).collect()
    }

    /// The energy at both ends of the run, if it was requested.
    pub(super) fn energy_sentence(&self) -> Option<String> {
        let sum = |e: &super::Energy| e.kinetic + e.potential;
        let (first, last) = (self.energy.first()?, self.energy.last()?);
        Some(format!("energy: {} at the start, {} at the end", energy(sum(first)), energy(sum(last))))
    }

    /// The warning of a run that gained unexplained energy.
    pub(super) fn warning(&self) -> Option<String> {
        self.summary.balance.and_then(|balance| balance.warning())
    }

    /// The run as text.
    pub fn text(&self) -> String {
        let mut out = format!("{} by {}\n", self.name, self.engine);
        out += &table(&["", ""], self.rows());
        if let Some(sentence) = self.energy_sentence() {
            out += &format!("\n{sentence}");
        }
        if let Some(warning) = self.warning() {
            out += &format!("\nWarning: {warning}");
        }
        out
    }

    /// The costs of the scene's AFU beside those of an AFU with everything.
    pub fn costs(&self) -> String {
        costs(&[("what the scene calls for", &self.cost), ("everything", &self.everything)])
    }

    /// The contacts as CSV. Only computed fields have columns.
    pub fn contacts_csv(&self) -> String {
        let fields = self.config.contact;
        let numbers = || ContactRecord::words(fields).filter(|word| *word != FLAGS);
        let mut out = "step,first,second".to_owned();
        numbers().for_each(|word| out += &format!(",{}", ContactRecord::NAMES[word]));
        out.push('\n');
        for contact in &self.contacts {
            out += &format!("{},{},{}", contact.step, contact.bodies[0], contact.bodies[1]);
            numbers().for_each(|word| out += &format!(",{}", contact.words[word]));
            out.push('\n');
        }
        out
    }

    /// The trajectories of the bodies as CSV.
    pub fn trajectories_csv(&self) -> String {
        let mut out = "step,body,x,y,z\n".to_owned();
        for (step, places) in self.places.iter().enumerate() {
            for (body, [x, y, z]) in places.iter().enumerate() {
                out += &format!("{step},{body},{x},{y},{z}\n");
            }
        }
        out
    }

    /// The trajectories of the bodies as npy: f64, steps × bodies × 3.
    pub fn trajectories_npy(&self) -> Vec<u8> {
        let shape = vec![self.places.len() as u64, self.radii.len() as u64, 3];
        npy_of_numbers(shape, self.places.iter().flatten().flatten().copied())
    }

    /// Energy and momentum as CSV.
    pub fn energy_csv(&self) -> String {
        let mut out = "step,kinetic,potential,momentum_x,momentum_y,momentum_z\n".to_owned();
        for (step, e) in self.energy.iter().enumerate() {
            let [x, y, z] = e.momentum;
            out += &format!("{step},{},{},{x},{y},{z}\n", e.kinetic, e.potential);
        }
        out
    }
}
