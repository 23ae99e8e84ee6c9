//! What a search compares, row by row: what a model of its hardware counts the cycles of.

use super::rows::{Boxes, ROW, Row, Rows};
use super::{Bounds, Search, Sphere};

/// What the search of a row compares.
#[derive(Clone, Debug, Default)]
pub(crate) struct RowTrace {
    /// The number of groups of 16 rows, which are compared first.
    pub(crate) groups: usize,
    /// The groups whose box meets that of the row, in order.
    pub(crate) met: Vec<GroupTrace>,
}

/// A group of 16 rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct GroupTrace {
    pub(crate) number: usize,
    /// Its rows whose box meets that of the row that is searched, in order.
    pub(crate) met: Vec<MemberTrace>,
}

/// A row that the row that is searched is compared with.
#[derive(Clone, Debug)]
pub(crate) struct MemberTrace {
    pub(crate) number: usize,
    /// The spheres of the row that is searched that meet this row's box, in order: the place of each, and the columns
    /// of this row that it is a candidate with, a bit each.
    pub(crate) near: Vec<(usize, u16)>,
}

impl Search {
    /// What a search compares, by the rows that are searched.
    pub(crate) fn trace(&self, spheres: &[Sphere], others: Option<&[Sphere]>) -> Vec<RowTrace> {
        let table = Rows::new(self.rule(), spheres);
        let second = others.map(|others| Rows::new(self.rule(), others));
        let searched = second.as_ref().unwrap_or(&table);
        let trace = |(number, row): (usize, &Row)| {
            let rows = if second.is_none() { number + 1 } else { table.rows.len() };
            let groups = rows.div_ceil(ROW);
            let own = second.is_none().then_some(number / ROW);
            let met =
                (0..groups).filter(|group| own == Some(*group) || table.groups[*group].around.meets(&row.boxes.around));
            let of_group = |group: usize| {
                let members = group * ROW..rows.min((group + 1) * ROW);
                let met = members.filter(|member| table.rows[*member].boxes.around.meets(&row.boxes.around));
                let met =
                    met.map(|member| members_of(&row.boxes, &table.rows[member].boxes, member, own.map(|_| number)));
                GroupTrace { number: group, met: met.collect() }
            };
            RowTrace { groups, met: met.map(of_group).collect() }
        };
        searched.rows.iter().enumerate().map(trace).collect()
    }
}

/// The comparison of a row with another one. In one set, `own` is the number of the row.
fn members_of(row: &Boxes, other: &Boxes, number: usize, own: Option<usize>) -> MemberTrace {
    let near = (0..ROW).filter(|place| row.column(*place).meets(&other.around));
    let near = near.map(|place| {
        let bounds: Bounds = row.column(place);
        let before = if own == Some(number) { place } else { ROW };
        let meets = (0..before).filter(|column| bounds.meets(&other.column(*column)));
        (place, meets.fold(0, |mask, column| mask | 1 << column))
    });
    MemberTrace { number, near: near.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Arithmetic;
    use crate::number::Format;
    use crate::spheres::SphereSet;

    /// The trace has the candidates of the search, in its order.
    #[test]
    fn a_trace_ends_with_the_candidates() {
        let search = Search::new(Arithmetic::Rounded(Format::WIDE), 24).expect("a search");
        for sets in [SphereSet::Diamond(7).spheres(1), SphereSet::Probes(100, 900).spheres(2)] {
            let second = sets.second.as_deref();
            let mut pairs = Vec::new();
            for (row, trace) in search.trace(&sets.first, second).iter().enumerate() {
                for member in trace.met.iter().flat_map(|group| &group.met) {
                    for (place, columns) in &member.near {
                        let columns = (0..ROW).filter(|column| columns >> column & 1 == 1);
                        pairs.extend(columns.map(|c| [member.number * ROW + c, row * ROW + place].map(|n| n as u32)));
                    }
                }
            }
            assert_eq!(pairs, search.candidates(&sets.first, second).pairs);
        }
    }
}
