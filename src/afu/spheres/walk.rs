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
    // The bit of a step, the bits behind it and that there are none are registers. They are found for the item that may
    // be taken and for the one in hand, and the later choice is made between them.
    let active = graph.register("active", 1, 0);
    let bit = graph.data_register("walked_bit", item.mask.width());
    let rest = graph.data_register("rest", item.mask.width());
    let last = graph.data_register("is_last", 1);
    let about = graph.data_register("about", item.about.width());
    let steps = (*active & may_step).named("steps");
    let ends = (steps & *last).named("ends");
    let takes = (item.valid & (!*active | ends)).named("takes");
    active.next(!start & (takes | (*active & !ends)));
    about.next_if(takes, item.about);
    let [of_item, of_rest] = [(item.mask, "item"), (*rest, "next")].map(|(mask, name)| {
        let first = lowest(mask).named(&format!("{name}_bit"));
        (first, (mask & !first).named(&format!("{name}_rest")))
    });
    bit.next_if(takes | steps, takes.select(of_item.0, of_rest.0));
    rest.next_if(takes | steps, takes.select(of_item.1, of_rest.1));
    last.next_if(takes | steps, !takes.select(of_item.1.any(), of_rest.1.any()));
    Walk { takes, steps, bit: *bit, about: *about, is_last: *last, is_active: *active }
}
