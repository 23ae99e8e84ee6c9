//! The columns of the tables and of the CSV: one list.

use super::{Row, Simulated};

/// How a column's values were obtained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// ns per sphere, measured on a processor.
    Measured,
    /// ns per sphere of the simulated AFU.
    Simulated,
    /// A ratio of two of them, or a share of the link limit.
    Share,
    /// Clock cycles of a job; only in the CSV and the JSON.
    Cycles,
}

/// A column.
pub(super) struct Column {
    /// Its name in the CSV and the JSON.
    pub(super) key: &'static str,
    /// Its heading in tables.
    pub(super) heading: &'static str,
    pub(super) kind: Kind,
    pub(super) value: fn(&Row) -> Option<f64>,
}

impl Column {
    /// The text of a row in a table.
    pub(super) fn cell(&self, row: &Row) -> String {
        let Some(value) = (self.value)(row) else { return "-".to_owned() };
        match self.kind {
            Kind::Measured => format!("{value:.0}"),
            Kind::Simulated => format!("{value:.1}"),
            Kind::Share if value < 0.01 => format!("{:.2} %", 100.0 * value),
            Kind::Share => format!("{:.1} %", 100.0 * value),
            Kind::Cycles => format!("{value:.0}"),
        }
    }
}

const fn column(key: &'static str, heading: &'static str, kind: Kind, value: fn(&Row) -> Option<f64>) -> Column {
    Column { key, heading, kind, value }
}

fn of<T>(row: &Row, value: impl Fn(&Simulated) -> T) -> Option<T> {
    row.simulated.as_ref().map(value)
}

/// All columns behind the set, its spheres and its contacts.
pub(super) const COLUMNS: [Column; 20] = [
    column("sorting_ns", "sorting", Kind::Measured, |row| row.measured.sorting),
    column("search_numbers_ns", "search, numbers", Kind::Measured, |row| row.measured.search_numbers),
    column("search_contacts_ns", "search, contacts", Kind::Measured, |row| row.measured.search_contacts),
    column("cells_numbers_ns", "cells, numbers", Kind::Measured, |row| row.measured.cells_numbers),
    column("cells_contacts_ns", "cells, contacts", Kind::Measured, |row| row.measured.cells_contacts),
    column("ode_hash_ns", "ODE, hash", Kind::Measured, |row| row.measured.ode_hash),
    column("ode_sweep_and_prune_ns", "ODE, sweep and prune", Kind::Measured, |row| row.measured.ode_sweep),
    column("parry_ns", "parry3d", Kind::Measured, |row| row.measured.parry),
    column("afu_numbers_ns", "*AFU, numbers*", Kind::Simulated, |row| of(row, |jobs| jobs.numbers.ns)),
    column("afu_contacts_ns", "*AFU, contacts*", Kind::Simulated, |row| of(row, |jobs| jobs.contacts.ns)),
    column("afu_pairs_ns", "*AFU, pairs*", Kind::Simulated, |row| of(row, |jobs| jobs.pairs.ns)),
    column("afu_numbers_over_cells", "numbers: of the cell list", Kind::Share, Row::numbers_over_cells),
    column("afu_contacts_over_cells", "contacts: of the cell list", Kind::Share, Row::contacts_over_cells),
    column("afu_numbers_over_ode", "numbers: of ODE's best space", Kind::Share, Row::numbers_over_ode),
    column("afu_contacts_over_ode", "contacts: of ODE's best space", Kind::Share, Row::contacts_over_ode),
    column("afu_numbers_link_share", "numbers: share of the link", Kind::Share, |row| {
        of(row, |jobs| jobs.numbers.link_share)
    }),
    column("afu_contacts_link_share", "contacts: share of the link", Kind::Share, |row| {
        of(row, |jobs| jobs.contacts.link_share)
    }),
    column("afu_numbers_cycles", "", Kind::Cycles, |row| of(row, |jobs| jobs.numbers.cycles as f64)),
    column("afu_contacts_cycles", "", Kind::Cycles, |row| of(row, |jobs| jobs.contacts.cycles as f64)),
    column("afu_pairs_cycles", "", Kind::Cycles, |row| of(row, |jobs| jobs.pairs.cycles as f64)),
];

/// The columns of these kinds in which any row has a value.
pub(super) fn filled<'a>(rows: &'a [Row], kinds: &'a [Kind]) -> impl Iterator<Item = &'static Column> + use<'a> {
    let is_filled = |column: &&Column| rows.iter().any(|row| (column.value)(row).is_some());
    COLUMNS.iter().filter(|column| kinds.contains(&column.kind)).filter(is_filled)
}
