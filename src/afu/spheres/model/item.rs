//! What a row gives the stages of the model.

use std::collections::HashMap;

use crate::afu::spheres::{LONG_QUEUE, QUEUE, ROW, Sizes};
use crate::spheres::{GroupTrace, MemberTrace, RowTrace};

/// Hits by the number of the other row, that of the row that is searched, and the place of the sphere in this.
pub(super) type Hits = HashMap<(usize, usize, usize), u64>;

/// What waits for a stage: for each of its steps, what that puts into the queue behind it.
#[derive(Debug, Default)]
pub(super) struct Item {
    pub(super) steps: Vec<Option<Item>>,
    /// In the last stage, candidates of each decider, and hits.
    pub(super) decided: Option<(Vec<u64>, u64)>,
    pub(super) ends_row: bool,
}

/// The stages before the deciders, and the queue before each.
pub(super) const STAGES: [(&str, u32); 4] =
    [("groups", QUEUE), ("rows of groups", QUEUE), ("near", LONG_QUEUE), ("box by box", LONG_QUEUE)];

/// What a row gives the first stage.
pub(super) fn item(sizes: &Sizes, row: usize, trace: &RowTrace, hits: &Hits) -> Item {
    let members = |member: &MemberTrace| {
        let step = |near: &[(usize, u16)]| {
            let mut share = vec![0; sizes.deciders as usize];
            for (_, columns) in near {
                let columns = (0..ROW).filter(|column| columns >> column & 1 == 1);
                columns.for_each(|column| share[(column % sizes.deciders) as usize] += 1);
            }
            let found = near.iter().filter_map(|(place, _)| hits.get(&(member.number, row, *place))).sum();
            let is_asked = share.iter().any(|candidates| *candidates > 0);
            is_asked.then(|| Item { decided: Some((share, found)), ..Item::default() })
        };
        member.near.chunks(sizes.compared as usize).map(step).collect::<Vec<_>>()
    };
    let word = |word: usize| {
        let groups = trace.met.iter().filter(|group| group.number / ROW as usize == word);
        let step = |group: &GroupTrace| {
            let together = |member: &MemberTrace| member.number / sizes.near_rows as usize;
            let sides = group.met.chunk_by(|one, other| together(one) == together(other));
            let side_by_side = |rows: &[MemberTrace]| {
                let steps: Vec<_> = rows.iter().flat_map(members).collect();
                (!steps.is_empty()).then(|| Item { steps, ..Item::default() })
            };
            let steps: Vec<_> = sides.map(side_by_side).collect();
            (!steps.is_empty()).then(|| Item { steps, ..Item::default() })
        };
        let steps: Vec<_> = groups.map(step).collect();
        (!steps.is_empty()).then(|| Item { steps, ..Item::default() })
    };
    let mut item = Item { steps: (0..trace.groups.div_ceil(ROW as usize)).map(word).collect(), ..Item::default() };
    end(sizes, &mut item, 0);
    item
}

/// The last item of a row passes all stages, even if it found nothing.
fn end(sizes: &Sizes, item: &mut Item, stage: usize) {
    if stage == STAGES.len() {
        item.decided.get_or_insert_with(|| (vec![0; sizes.deciders as usize], 0));
        item.ends_row = true;
        return;
    }
    if item.steps.is_empty() {
        item.steps.push(None);
    }
    if let Some(last) = item.steps.last_mut() {
        end(sizes, last.get_or_insert_with(Item::default), stage + 1);
    }
}
