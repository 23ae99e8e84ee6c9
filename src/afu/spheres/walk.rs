//! Walks over the set bits of a mask, one per cycle and the lowest first: what each stage of the search does with
//! what the stage before it found.

use super::bits::lowest;
use crate::hdl::{Graph, Signal};

/// What a stage gets.
pub(super) struct Item<'g> {
    pub(super) valid: Signal<'g>,
    /// The bits to be walked over. With none, there is one step without a bit.
    pub(super) mask: Signal<'g>,
    /// What stays the same for all of them.
    pub(super) about: Signal<'g>,
}

/// A walk.
pub(super) struct Walk<'g> {
    /// True if the item is taken in this cycle.
    pub(super) takes: Signal<'g>,
    /// True if there is a step in this cycle.
    pub(super) steps: Signal<'g>,
    /// The step's bit, one-hot; none if the item's mask was empty.
    pub(super) bit: Signal<'g>,
    /// The item's `about`.
    pub(super) about: Signal<'g>,
    /// True in the last step of an item.
    pub(super) is_last: Signal<'g>,
    /// True while an item is being walked over.
    pub(super) is_active: Signal<'g>,
}

/// A walk over items. `start` forgets the item in hand; steps are made only where `may_step`, a register, is set.
pub(super) fn walk<'g>(graph: &'g Graph, start: Signal<'g>, item: &Item<'g>, may_step: Signal<'g>) -> Walk<'g> {
    let active = graph.register("active", 1, 0);
    let left = graph.data_register("bits_left", item.mask.width());
    let about = graph.data_register("about", item.about.width());
    let bit = lowest(*left).named("walked_bit");
    let rest = (*left & !bit).named("rest");
    let is_last = (!rest.any()).named("is_last");
    let steps = (*active & may_step).named("steps");
    let ends = (steps & is_last).named("ends");
    let takes = (item.valid & (!*active | ends)).named("takes");
    active.next(!start & (takes | (*active & !ends)));
    left.next_if(takes | steps, takes.select(item.mask, rest));
    about.next_if(takes, item.about);
    Walk { takes, steps, bit, about: about.value(), is_last, is_active: active.value() }
}
