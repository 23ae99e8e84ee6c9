//! Hits that wait for SCPUs side by side. Up to four come in a cycle, all of one step, and as many leave as the SCPUs
//! take, of any steps. So the SCPUs always get as many as they can take, in order.
//!
//! A row that is searched ends here when its last hit has left, because until then its spheres are needed.

use std::sync::Arc;

use super::bits::count;
use super::hits::{HIT_LANES, cycles_to_numbers};
use super::{NUMBER_BITS, ROW_BITS, Sizes};
use crate::afu::backlog::{Kept, keep};
use crate::afu::counter::later;
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Hits that can wait: twice as many as come after the stage before was told to stop, at least.
pub(super) const PLACES: u32 = 128;

/// Hits that still come then, at most, for so many spheres that are compared side by side: those of each cycle on their
/// way, and of one more before they are counted.
pub(super) const fn hits_on_the_way(compared: u32) -> u32 {
    HIT_LANES * (cycles_to_numbers(compared) + 2)
}

/// There is no configuration with more.
const _: () = assert!(2 * hits_on_the_way(super::ROW) <= PLACES);

/// Builds the module `contact_afu_waiting_hits`, from which `lanes` leave in a cycle. As from the stage before, which
/// lanes carry a hit is known one cycle before the hits, and these are the first ones.
pub(super) fn waiting_hits(sizes: &Sizes, lanes: u32) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_waiting_hits");
    graph.about("keeps hits, in their order, until SCPUs side by side take them");
    let start = graph.input("start", 1);
    let comes = graph.input("comes", HIT_LANES);
    let hits: Vec<_> = (0..HIT_LANES).map(|lane| graph.input(&format!("hit_{lane}"), 2 * NUMBER_BITS)).collect();
    let may_leave = graph.input("may_leave", 1);
    let row_comes = graph.input("row_comes_to_end", 1);

    let put = count("count_of_hits", comes).gate(!start).registered("put");
    let kept = keep(&graph, [start, may_leave], put, &hits, (PLACES, lanes));
    let Kept { group, oldest, stored, readable } = kept;
    let leave: Vec<_> = (0..lanes).rev().map(|lane| group.greater_than(group.same(lane.into()))).collect();
    let leave = Signal::join(&leave).named("leave");
    graph.output("carries", leave.gate(!start).registered("carries"));
    for (hit, lane) in oldest.iter().zip(0..lanes) {
        graph.output(&format!("record_{lane}"), hit.delay(2).named(&format!("leaving_{lane}")));
    }
    let limit = PLACES - hits_on_the_way(sizes.compared);
    let has_room = stored.less_than(stored.same(limit.into()));
    graph.output("has_room", (has_room & !start).registered("has_room"));

    // Rows end in order. Those before the row of the oldest hit have ended or, if none waits, all whose hits came.
    let row_bits = sizes.kept_bits + 1;
    let came = later(start, row_comes, cycles_to_numbers(sizes.compared), "row_coming");
    let [rows_came, rows_ended] = ["rows_came", "rows_ended"].map(|name| graph.register(name, row_bits, 0));
    rows_came.next_if(start | came, start.select(rows_came.same(0), rows_came.plus(1)));
    let row = oldest[0].slice(NUMBER_BITS + ROW_BITS, row_bits).named("oldest_row");
    let until = readable.any().select(row, *rows_came).named("rows_until");
    let is_known = readable.any() | !stored.any();
    let ends = (is_known & !rows_ended.equals(until)).named("ends");
    rows_ended.next_if(start | ends, start.select(rows_ended.same(0), rows_ended.plus(1)));
    graph.output("row_ends", (ends & !start).registered("row_ends"));
    graph.finish()
}
