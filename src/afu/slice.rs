//! A register slice for requests: two entries, so that neither side sees the other's logic. The side that puts requests
//! in knows from a register whether there is room.

use crate::hdl::{Graph, Signal};

/// The slice of a request port.
pub(super) struct Slice<'g> {
    /// True while a request may be put in; a register and an inverter.
    pub(super) has_room: Signal<'g>,
    /// The request at the port.
    pub(super) valid: Signal<'g>,
    /// Its fields, as they were put in.
    pub(super) fields: Vec<Signal<'g>>,
    /// True in a cycle in which a request of this job is accepted at the port.
    pub(super) accepted: Signal<'g>,
    /// True if no request is inside.
    pub(super) is_empty: Signal<'g>,
}

/// A slice in front of the `port` that takes a request when it is `ready`. A request enters when it is `valid` and
/// there is room. `fields` are the names and values of its parts. A request that is at the port when its job is given
/// up stays until it is taken, even during the next job. The slice `drops` one behind it.
pub(super) fn slice<'g>(
    graph: &'g Graph,
    port: &str,
    [start, drops]: [Signal<'g>; 2],
    valid: Signal<'g>,
    fields: &[(&str, Signal<'g>)],
    ready: Signal<'g>,
) -> Slice<'g> {
    let at_port = graph.register(&format!("{port}_valid"), 1, 0);
    // A copy says whether there is room, one stands at the port, one steers the wide fields. A reset clears them,
    // because it `drops`.
    let waits = graph.wire(&format!("{port}_waits"), 1);
    let copies = waits.data_copies(&format!("{port}_spare_valid"), 3);
    let (room, spare, steers) = (copies[0], copies[1], copies[2]);
    let moves = (!*at_port | ready).named(&format!("{port}_moves"));
    let behind = (!drops & (spare | valid)).named(&format!("{port}_next_valid"));
    at_port.next(behind | !moves);
    waits.drive(behind & !moves);
    let fields = fields
        .iter()
        .map(|(name, value)| {
            let kept = graph.data_register(&format!("{port}_spare_{name}"), value.width());
            kept.next_if(!steers, *value);
            let shown = graph.data_register(&format!("{port}_{name}"), value.width());
            shown.next_if(moves, steers.select(*kept, *value));
            shown.value()
        })
        .collect();
    let of_job = graph.register(&format!("{port}_of_job"), 1, 0);
    of_job.next(!start & (moves | *of_job));
    Slice {
        has_room: !room,
        valid: at_port.value(),
        fields,
        accepted: *at_port & ready & *of_job,
        is_empty: !*at_port & !spare,
    }
}
