//! Gathers records, in order, into lines (or into words, which are gathered into lines in turn). Each place of a line
//! has an enable, decoded a cycle ahead, so no record is shifted.

use super::wide;
use crate::hdl::{Graph, Signal};

/// Cycles from records to the line that they fill: registered beside their enables, in the line.
pub(super) const CYCLES: u32 = 2;

/// What is gathered.
pub(super) struct Gathered<'g> {
    /// True if a line comes in the next cycle.
    pub(super) comes: Signal<'g>,
    /// The line.
    pub(super) line: Signal<'g>,
    /// True if all records have left, the last line included, and no line comes.
    pub(super) all_out: Signal<'g>,
}

/// Gathers `records` in lines of `per_line` (a power of two) records, at least as many as there are lanes. The lanes
/// below the first one that `carries` no record have one, one cycle after `carries` says so. After `all_out`, a line
/// that is not full leaves with zeros in its unused part. `prefix` distinguishes the names of two such parts in one
/// module.
pub(super) fn gather<'g>(
    graph: &'g Graph,
    prefix: &str,
    start: Signal<'g>,
    carries: Signal<'g>,
    records: &[Signal<'g>],
    per_line: u32,
    all_out: Signal<'g>,
) -> Gathered<'g> {
    let name = |text: &str| format!("{prefix}{text}");
    let lanes = records.len() as u32;
    let place_bits = per_line.ilog2().max(1);

    // The place of the next record is decided before it arrives.
    let place = graph.register(&name("place"), place_bits, 0);
    let sum_bits = place_bits + 1;
    let sum = |pairs: u32| place.extend(sum_bits).plus(pairs.into());
    let behind = (0..lanes).fold(sum(0), |behind, lane| carries.bit(lane).select(sum(lane + 1), behind));
    let behind = behind.named(&name("place_behind"));
    let fills = behind.at_least(behind.same(per_line.into())).named(&name("fills"));
    let flushes = (all_out & place.any() & !carries.any()).named(&name("flushes"));
    let wrapped = fills.select(behind.minus(per_line.into()), behind).named(&name("place_in_line"));
    let wrapped = wrapped.low(place_bits).named(&name("next_place"));
    place.next((start | flushes).select(place.same(0), wrapped));
    let went = (!start & (fills | flushes)).registered(&name("went"));
    let comes = (!start & went).registered(&name("comes"));
    let empties = (start | flushes | fills).named(&name("empties")).delay(1).named(&name("empties_soon"));

    // Which lane's record enters which place, a cycle before it does: of the line in hand, or of the next line if its
    // place is behind this one.
    let hot = if per_line == 1 { graph.constant(1, 1) } else { place.one_hot().delay(1).named(&name("first_place")) };
    let carried = carries.delay(1).named(&name("carried"));
    let soon: Vec<_> = (0..lanes)
        .map(|lane| {
            let reached = hot.extend(per_line + lanes - lane).append_zeros(lane);
            reached.gate(carried.bit(lane)).named(&name(&format!("enters_{lane}_soon")))
        })
        .collect();
    let records: Vec<_> = records
        .iter()
        .zip(0..)
        .map(|(record, lane)| record.delay(1).named(&name(&format!("entering_{lane}"))))
        .collect();
    let record_bits = records[0].width();
    let steering = |bit: Signal<'g>, text: String| wide::steering(bit, &name(&text), record_bits);
    let enters =
        |lane: u32, place: u32| steering(soon[lane as usize].bit(place), format!("enters_{lane}_place_{place}"));
    // The lanes from `first` on whose record can enter a place (of the next line from `per_line` on).
    let possible =
        |place: u32, first: u32| (first..lanes).filter(move |lane| place >= *lane && place - lane < per_line);
    let entering = |place: u32, first: u32, otherwise: Signal<'g>| {
        possible(place, first)
            .fold(otherwise, |other, lane| wide::select(&enters(lane, place), records[lane as usize], other))
    };
    let any_soon =
        |place: u32| possible(place, 0).fold(graph.constant(1, 0), |any, lane| any | soon[lane as usize].bit(place));
    let mut line = Vec::new();
    for place in 0..per_line {
        let none = records[0].same(0);
        // The record in the last place fills the line, so it never waits.
        let waits = if place + 1 == per_line {
            none
        } else {
            let overtaken = place + 1 < lanes;
            // Lane 0's record if no other enters: without an enable nothing is stored.
            let emptied = steering(empties, format!("empties_{place}"));
            let new = wide::select(&emptied, none, entering(place, 1, records[0]));
            let (new, next_line) = if overtaken {
                (entering(per_line + place, 0, new), any_soon(per_line + place))
            } else {
                (new, graph.constant(1, 0))
            };
            let stores = steering(next_line | empties | any_soon(place), format!("stores_{place}"));
            wide::register_if(&stores, &name(&format!("filling_{place}")), new)
        };
        // Only the last places are still being filled when a line leaves.
        line.push(if place + lanes >= per_line { entering(place, 0, waits) } else { waits });
    }
    line.reverse();
    let line = Signal::join(&line).delay(1).named(&name("line"));
    let all_out = all_out & !place.any() & !went & !comes;
    Gathered { comes, line, all_out }
}
