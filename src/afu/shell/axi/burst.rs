//! Merges lines that follow each other in memory into bursts.
//!
//! A line joins the open burst if it follows that burst's last line within the same 4 KB. A burst is closed when it is
//! full, when the line behind it does not follow, when no line came for some cycles, or when no other burst is in
//! flight. So bursts are short while the link is idle, when latency counts, and grow while it is busy.

use crate::afu::Spec;
use crate::afu::counter::up_down;
use crate::hdl::{Graph, Signal};
use crate::record::LINE_BITS;

/// Lines of the 4 KB that no burst crosses.
const PAGE_LINES: u32 = 64;
/// Bits of the number of cycles that an open burst waits for its next line.
const PATIENCE_BITS: u32 = 3;

/// The most lines of a burst: 4 KB, but no more than a quarter of what may be outstanding, so that other bursts are in
/// flight while one is open.
pub(in crate::afu) fn most_lines(spec: &Spec) -> u32 {
    PAGE_LINES.min(spec.max_outstanding / 4)
}

/// The number of beats of a line.
pub(super) fn beats(spec: &Spec) -> u32 {
    LINE_BITS / spec.config.bus
}

/// The bursts of one direction.
pub(super) struct Bursts<'g> {
    /// A line may come: a function of registers.
    pub(super) ready: Signal<'g>,
    /// A line comes in this cycle.
    pub(super) accepted: Signal<'g>,
    /// The open burst is closed in this cycle; the other fields are its own.
    pub(super) closes: Signal<'g>,
    /// The address of its first line.
    pub(super) first: Signal<'g>,
    /// Its lines, less one.
    pub(super) more: Signal<'g>,
    /// A burst that has left is answered in this cycle. A response without a burst does not count.
    pub(super) answered: Signal<'g>,
    /// No burst waits for a response.
    pub(super) none_in_flight: Signal<'g>,
}

/// What the bursts depend on.
pub(super) struct Lines<'g> {
    /// The core asks for a line.
    pub(super) valid: Signal<'g>,
    /// The line's address.
    pub(super) address: Signal<'g>,
    /// There is room for a line.
    pub(super) has_room: Signal<'g>,
    /// A closed burst can leave.
    pub(super) may_close: Signal<'g>,
    /// A response of a burst arrives.
    pub(super) response: Signal<'g>,
}

/// The bursts of `lines`.
pub(super) fn bursts<'g>(graph: &'g Graph, spec: &Spec, lines: &Lines<'g>) -> Bursts<'g> {
    let waiting = graph.register("line_waiting", 1, 0);
    let open = graph.register("burst_open", 1, 0);
    let takes = graph.wire("line_taken", 1);
    let ready = (lines.has_room & (!*waiting | takes)).named("line_ready");
    let accepted = (lines.valid & ready).named("line_accepted");

    // Whether a line follows the one before it is known when it waits.
    let page_bits = PAGE_LINES.ilog2();
    let next_line = graph.data_register("next_line", lines.address.width());
    next_line.next_if(accepted, lines.address.plus(1));
    let line = graph.data_register("waiting_line", lines.address.width());
    line.next_if(accepted, lines.address);
    let follows = graph.data_register("line_follows", 1);
    follows.next_if(accepted, lines.address.equals(*next_line) & lines.address.low(page_bits).any());
    waiting.next(accepted | (*waiting & !takes));

    let more = graph.data_register("burst_more", most_lines(spec).ilog2());
    let is_full = more.all().named("burst_full");
    let age = graph.data_register("burst_age", PATIENCE_BITS);
    age.next(age.all().select(*age, age.plus(1)).gate(!takes));
    let closes = graph.wire("burst_closes", 1);
    let in_flight = graph.register("bursts_in_flight", spec.max_outstanding.ilog2() + 1, 0);
    let answered = (lines.response & in_flight.any()).named("burst_answered");
    up_down(in_flight, graph.constant(1, 0), closes, answered);
    let wants = is_full | age.all() | !in_flight.any() | (*waiting & !*follows);
    closes.drive(*open & lines.may_close & wants);
    takes.drive(*waiting & (!*open | closes | (*follows & !is_full)));
    let begins = (!*open | closes).named("burst_begins");
    open.next(takes | (*open & !closes));
    let first = graph.data_register("burst_first", lines.address.width());
    first.next_if(takes & begins, *line);
    more.next_if(takes, begins.select(more.same(0), more.plus(1)));
    let none_in_flight = !in_flight.any();
    Bursts { ready, accepted, closes, first: first.value(), more: more.value(), answered, none_in_flight }
}

/// The beats of a burst of `more` lines and one, less one.
pub(super) fn length<'g>(graph: &'g Graph, spec: &Spec, more: Signal<'g>) -> Signal<'g> {
    let bits = beats(spec).ilog2();
    let beats = if bits == 0 { more } else { more.concat(graph.constant(bits, (1 << bits) - 1)) };
    beats.extend(8)
}
