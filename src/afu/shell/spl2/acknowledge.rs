//! Write responses come on either receive channel, or on both at once; the core takes one per cycle.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module};

use super::words::{MDATA_BITS, SHELL_EPOCH_BITS, is_core_s};
use crate::afu::counter::{from_zero, up_down};
use crate::afu::{EPOCH_BITS, Spec};

/// Builds the module `spl2_acknowledge`. Channel 0 goes straight to the core, and channel 1 waits for a cycle in which
/// channel 0 is idle. There is room for as many as there can be outstanding writes. Those of other jobs are dropped
/// first.
pub(super) fn acknowledge(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("spl2_acknowledge");
    graph.about("brings write responses of two channels to the core, one a cycle");
    let slots = spec.max_outstanding;
    let slot_bits = slots.ilog2();
    let tag_bits = EPOCH_BITS + slot_bits;
    let start = graph.input("start", 1);
    let epoch = graph.input("epoch", SHELL_EPOCH_BITS);
    let channels = [0, 1].map(|channel| {
        let valid = graph.input(&format!("valid_{channel}"), 1);
        let mdata = graph.input(&format!("mdata_{channel}"), MDATA_BITS);
        let mine = (valid & is_core_s(mdata, epoch, slot_bits)).named(&format!("core_s_{channel}"));
        ((mine & !start).registered(&format!("counts_{channel}")), mdata.low(tag_bits).delay(1))
    });
    let [(first, first_tag), (second, second_tag)] = channels;

    // The place of the oldest is read whether or not it leaves, so its tag is available one cycle later.
    let store = graph.memory("waiting", slots, tag_bits);
    let tail = graph.register("tail", slot_bits, 0);
    let head = graph.register("head", slot_bits, 0);
    let stored = graph.register("stored", slot_bits + 1, 0);
    let take = (stored.any() & !first).named("take");
    store.write(second, tail.value(), second_tag);
    from_zero(tail, start, second, tail.plus(1));
    from_zero(head, start, take, head.plus(1));
    up_down(stored, start, second, take);
    let waited = store.read(head.value()).named("oldest");

    graph.output("valid", (!start & (first | take)).registered("answered"));
    graph.output("tag", first.delay(1).named("from_first").select(first_tag.delay(1), waited));
    graph.finish()
}
