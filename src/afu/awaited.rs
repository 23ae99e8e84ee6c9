//! Which requests wait for a response. A response whose request does not wait, because it was answered before or was
//! never sent, is an error: what it carries belongs to no line of this job.

use crate::hdl::{Graph, Signal};

use super::in_order::Arrival;

/// From a response to [`Answers`]: compared with the mask, registered.
pub(super) const CYCLES_TO_ANSWER: u32 = 1;

/// The port on which requests wait for acceptance.
pub(super) struct Port<'g> {
    pub(super) valid: Signal<'g>,
    pub(super) ready: Signal<'g>,
    pub(super) slot: Signal<'g>,
}

/// Responses of this job, a cycle after they came.
pub(super) struct Answers<'g> {
    /// One that a request waits for.
    pub(super) answered: Signal<'g>,
    /// One that no request waits for, while the job runs.
    pub(super) unexpected: Signal<'g>,
    /// One that a request waits for, and that says that it failed.
    pub(super) failed: Signal<'g>,
}

/// Marks a slot when its request is accepted, and takes the mark away when its response comes, in a later cycle.
/// `start` clears all marks: a request that still stands on the port then is one of an earlier job, and gets none.
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
