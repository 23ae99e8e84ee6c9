//! Marks the requests that wait for a response. A response without a waiting request (answered before, or never sent)
//! is an error, because its data belong to no line of this job.

use crate::hdl::{Graph, Signal};

use super::in_order::Arrival;

/// Cycles from a response to [`Answers`]: compared with the mask, registered.
pub(super) const CYCLES_TO_ANSWER: u32 = 1;

/// The port on which requests wait for acceptance.
pub(super) struct Port<'g> {
    pub(super) valid: Signal<'g>,
    pub(super) ready: Signal<'g>,
    pub(super) slot: Signal<'g>,
}

/// Responses of this job, one cycle after they arrived.
pub(super) struct Answers<'g> {
    /// A response to a waiting request.
    pub(super) answered: Signal<'g>,
    /// A response without a waiting request, while the job runs.
    pub(super) unexpected: Signal<'g>,
    /// A response to a waiting request that reports a failure.
    pub(super) failed: Signal<'g>,
}

/// Marks a slot when its request is accepted, and clears the mark when its response arrives in a later cycle. `start`
/// clears all marks. A request that is still on the port then belongs to an earlier job and is not marked.
pub(super) fn awaited<'g>(
    graph: &'g Graph,
    slots: u32,
    [start, run]: [Signal<'g>; 2],
    port: &Port<'g>,
    response: &Arrival<'g>,
    error: Signal<'g>,
) -> Answers<'g> {
    let leftover = graph.register("leftover_request", 1, 0);
    let stays = (port.valid & !port.ready).named("request_stays");
    leftover.next(stays & (start | *leftover));
    let accepted = (port.valid & port.ready & !*leftover).named("accepted");
    let awaited = graph.register("awaited", slots, 0);
    let asked = port.slot.one_hot().gate(accepted).named("asked");
    let answers = response.slot.one_hot().gate(response.valid).named("answers");
    awaited.next(start.select(awaited.same(0), (*awaited & !answers) | asked));
    let is_awaited = (*awaited & answers).any().named("is_awaited");
    let registered = |happens: Signal<'g>, name: &str| (happens & !start).registered(name);
    Answers {
        answered: registered(is_awaited, "answered"),
        unexpected: registered(run & response.valid & !is_awaited, "unexpected"),
        failed: registered(is_awaited & error, "failed"),
    }
}
