//! Marks the requests that wait for a response. A response without a waiting request (answered before, or never sent)
//! is an error, because its data belong to no line of this job.

use crate::hdl::{Graph, Signal};

use super::EPOCH_BITS;

/// Marks among which one is chosen in a first step.
const ROW: u32 = 8;

/// Cycles from a response of this job, registered, to [`Answers`]: its slot decoded and its mark chosen in each row of
/// marks, then the row chosen.
pub(super) const CYCLES_TO_ANSWER: u32 = 2;

/// A response of this job, in the cycle after its arrival.
pub(super) struct Arrival<'g> {
    /// True if there is one.
    pub(super) valid: Signal<'g>,
    /// As `valid`, in the cycle of its arrival.
    pub(super) comes: Signal<'g>,
    /// The slot of its request.
    pub(super) slot: Signal<'g>,
    /// Its row of marks, one-hot; `None` if there is only one.
    row: Option<Signal<'g>>,
    /// Its place in a row, one-hot.
    place: Signal<'g>,
}

impl<'g> Arrival<'g> {
    /// Of a response that arrives now with `tag`. It is the job's if its epoch is.
    pub(super) fn new(slots: u32, [valid, tag, epoch]: [Signal<'g>; 3]) -> Self {
        let slot = tag.low(slots.ilog2());
        let row_bits = ROW.min(slots).ilog2();
        let rows = || slot.drop_low(row_bits).one_hot().delay(1).named("response_row");
        let comes = valid & tag.high(EPOCH_BITS).equals(epoch);
        Self {
            valid: comes.registered("is_current"),
            comes,
            slot: slot.delay(1).named("response_slot"),
            row: (slots > ROW).then(rows),
            place: slot.low(row_bits).one_hot().delay(1).named("response_place"),
        }
    }

    /// The mark of its slot in the next cycle.
    fn marks(&self) -> Signal<'g> {
        let rows = self.row.map_or(self.valid, |row| row.gate(self.valid).named("row_if_current"));
        let marks = |row: u32| self.place.gate(rows.bit(row));
        Signal::join(&(0..rows.width()).rev().map(marks).collect::<Vec<_>>())
            .named("next_answers")
            .delay(1)
            .named("answers")
    }
}

/// Responses of this job, [two cycles](CYCLES_TO_ANSWER) after they arrived.
pub(super) struct Answers<'g> {
    /// A response to a waiting request.
    pub(super) answered: Signal<'g>,
    /// Any response while the job runs: without a waiting request if it is not `answered`.
    pub(super) responded: Signal<'g>,
    /// A response to a waiting request that reports a failure.
    pub(super) failed: Signal<'g>,
}

/// True in the cycle after `start`, and after a reset: clears what is wide. A register of its own, so that no gate
/// stands before the resets of marks all over the device.
pub(super) fn clears<'g>(graph: &'g Graph, start: Signal<'g>) -> Signal<'g> {
    let clears = graph.register("clears_marks", 1, 1);
    clears.next(start);
    clears.value()
}

/// Marks a slot once its request was `accepted` at the port, and clears the mark when its response arrives. Both are
/// decoded first and registered, so the mark is there when a response of the cycle after the acceptance is compared
/// with it. What an earlier job had marked is gone two cycles after `start`, as [`clears`] says.
pub(super) fn awaited<'g>(
    graph: &'g Graph,
    slots: u32,
    [start, clears, run]: [Signal<'g>; 3],
    [accepted, slot]: [Signal<'g>; 2],
    response: &Arrival<'g>,
    error: Signal<'g>,
) -> Answers<'g> {
    let registered = |happens: Signal<'g>, name: &str| (happens & !start).registered(name);
    let accepted = registered(accepted, "accepted");
    let accepted_slot = slot.delay(1).named("accepted_slot");
    let asked = accepted_slot.one_hot().gate(accepted).delay(1).named("asked");
    let awaited = graph.data_register("awaited", slots);
    awaited.next(((*awaited & !response.marks()) | asked).gate(!clears));
    let is_response = registered(response.valid, "is_response");

    // The response's mark as it will be in the next cycle: as it is, unless that slot is answered or asked for now.
    let row_bits = ROW.min(slots).ilog2();
    let here = response.slot.delay(1).named("answered_slot");
    let was_answered = (is_response & here.equals(response.slot)).delay(1).named("was_answered");
    let asked_here =
        registered(accepted, "is_asked") & accepted_slot.delay(1).named("asked_slot").equals(response.slot);
    let was_asked = asked_here.delay(1).named("was_asked");
    let marked = |row: u32| (awaited.slice(row << row_bits, 1 << row_bits) & response.place).any();
    let rows: Vec<_> = (0..slots >> row_bits).rev().map(|row| marked(row).named(&format!("marked_in_{row}"))).collect();
    let rows = Signal::join(&rows).gate(!clears).delay(1).named("marked_in_rows");
    let is_marked = if slots > ROW { (rows & here.drop_low(row_bits).one_hot()).any() } else { rows };
    let is_awaited = (is_response & (was_asked | (is_marked & !was_answered))).named("is_awaited");
    Answers {
        answered: registered(is_awaited, "answered"),
        responded: registered(run & is_response, "responded"),
        failed: registered(is_awaited & error.delay(1).named("error_then"), "failed"),
    }
}
