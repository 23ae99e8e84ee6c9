//! Merges lines that follow each other in memory into bursts.
//!
//! A line joins the open burst if it follows that burst's last line within the same 4 KB. A burst is closed when it is
//! full, when the line behind it does not follow, when no line came for some cycles, or when no other burst is in
//! flight. So bursts are short while the link is idle, when latency counts, and grow while it is busy.

use crate::afu::Spec;
use crate::afu::counter::Outstanding;
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
    /// A line may come: a register.
    pub(super) ready: Signal<'g>,
    /// A line comes in this cycle.
    pub(super) accepted: Signal<'g>,
    /// The open burst is closed in this cycle, a register; the other fields are its own.
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
    /// The lines for which there must be room: they come here, and one is `done` with.
    pub(super) in_hand: Outstanding<'g>,
    /// One of them has been read, or its write acknowledged.
    pub(super) done: Signal<'g>,
    /// A closed burst can leave.
    pub(super) may_close: Signal<'g>,
    /// A response of a burst arrives.
    pub(super) response: Signal<'g>,
}

/// The bursts of `lines`.
pub(super) fn bursts<'g>(graph: &'g Graph, spec: &Spec, lines: &Lines<'g>) -> Bursts<'g> {
    // Two lines may wait for the open burst, so that whether another may come is a register.
    let [waiting, second] = ["line_waiting", "second_waiting"].map(|name| graph.register(name, 1, 0));
    let ready = graph.register("line_ready", 1, 0);
    let open = graph.register("burst_open", 1, 0);
    let takes = graph.wire("line_taken", 1);
    let accepted = (lines.valid & *ready).named("line_accepted");
    let stays = (*waiting & !takes).named("line_stays");
    let both = ((*second | accepted) & stays).named("both_wait");
    waiting.next(accepted | *second | stays);
    second.next(both);
    ready.next(lines.in_hand.has_room_after(accepted, lines.done) & !both);
    lines.in_hand.connect(accepted, lines.done);

    // Whether a line follows the one before it is known when it waits.
    let page_bits = PAGE_LINES.ilog2();
    let next_line = graph.data_register("next_line", lines.address.width());
    next_line.next_if(accepted, lines.address.plus(1));
    let follows = (lines.address.equals(*next_line) & lines.address.low(page_bits).any()).named("coming_follows");
    let comes = lines.address.concat(follows).named("coming_line");
    let behind = graph.data_register("second_line", comes.width());
    behind.next_if(accepted, comes);
    let oldest = graph.data_register("waiting_line", comes.width());
    oldest.next_if(!stays, second.select(*behind, comes));
    let (line, follows) = (oldest.drop_low(1), oldest.bit(0).named("line_follows"));

    let more = graph.data_register("burst_more", most_lines(spec).ilog2());
    let is_full = graph.register("burst_full", 1, 0);
    let is_old = graph.register("burst_old", 1, 0);
    let age = graph.data_register("burst_age", PATIENCE_BITS);
    age.next(age.all().select(*age, age.plus(1)).gate(!takes));
    is_old.next(age.all() & !takes);
    let closes = graph.register("burst_closes", 1, 0);
    let begins = (!*open | *closes).named("burst_begins");
    takes.drive(*waiting & (begins | (follows & !*is_full)));
    open.next(takes | (*open & !*closes));
    let is_last = (more.is(u128::from(most_lines(spec) - 2)) & !begins).named("last_line_of_burst");
    is_full.next(takes.select(is_last, *is_full));
    let in_flight = Outstanding::new(graph, "bursts_in_flight", spec.max_outstanding.ilog2() + 1);
    let answered = (lines.response & in_flight.any()).named("burst_answered");
    in_flight.connect(*closes, answered);
    // That a burst closes is known a cycle ahead. A line may still join it then.
    let wants = (*is_full | *is_old | !in_flight.any() | (*waiting & !follows)).named("burst_wants_to_close");
    closes.next(*open & !*closes & lines.may_close & (wants | (takes & is_last)));
    let first = graph.data_register("burst_first", lines.address.width());
    first.next_if(takes & begins, line);
    more.next_if(takes, begins.select(more.same(0), more.plus(1)));
    let none_in_flight = !in_flight.any();
    Bursts {
        ready: ready.value(),
        accepted,
        closes: closes.value(),
        first: first.value(),
        more: more.value(),
        answered,
        none_in_flight,
    }
}

/// The beats of a burst of `more` lines and one, less one.
pub(super) fn length<'g>(graph: &'g Graph, spec: &Spec, more: Signal<'g>) -> Signal<'g> {
    let bits = beats(spec).ilog2();
    let beats = if bits == 0 { more } else { more.concat(graph.constant(bits, (1 << bits) - 1)) };
    beats.extend(8)
}
