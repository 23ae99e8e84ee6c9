//! The loader: takes spheres from lines, one or two per cycle, and gives each its box. A row that is searched
//! begins only where fewer rows are inside than can be kept.

use std::sync::Arc;

use super::bits::{chosen, count as number_of};
use super::bounds::{SPHERE_BITS, sphere_box};
use super::{ROW, ROW_BITS, ROW_NUMBER_BITS, Sizes};
use crate::afu::counter::{Level, later, up_down};
use crate::afu::lines::CYCLES_TO_WORD;
use crate::afu::{COUNT_BITS, Spec};
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Builds the module `contact_afu_loader`.
pub(super) fn loader(spec: &Spec, sizes: &Sizes) -> Result<Arc<Module>, BuildErrors> {
    let unit = sphere_box(sizes.rule, &spec.model(), spec.config.cut_mhz())?;
    let graph = Graph::new("contact_afu_loader");
    graph.about("takes spheres from lines, and gives each its box");
    let start = graph.input("start", 1);
    let run = graph.input("run", 1);
    let spheres = graph.input("count", COUNT_BITS);
    let others = graph.input("others", COUNT_BITS);
    let one_set = graph.input("one_set", 1);
    let keeps_table = graph.input("keeps_table", 1);
    let comes = graph.input("line_comes", 1);
    let line = graph.input("line", spec.line_bits);
    let row_ends = graph.input("row_ends", 1);

    // Lines that were announced and not taken yet.
    let slot_bits = spec.max_outstanding.ilog2();
    let per_line = spec.line_bits / SPHERE_BITS;
    let waiting = Level::new(&graph, "lines_waiting", slot_bits + 1, 0);
    let line_ends = graph.wire("line_ends", 1);
    waiting.connect(start, comes, line_ends);

    // Where the next sphere is: the set, the row and the column.
    let second = graph.register("is_second_set", 1, 0);
    let left = graph.register("spheres_left", COUNT_BITS, 0);
    let row = graph.register("row_now", ROW_NUMBER_BITS, 0);
    let column = graph.register("column_now", sizes.loaded_bits(), 0);
    let searched = (one_set | *second).named("is_searched");
    // A row that is searched needs a place among the rows that are kept.
    let inside_bits = sizes.kept_bits + 1;
    let inside = graph.register("rows_inside", inside_bits, 0);
    // Whether spheres of the set are left, and whether the rows let one be taken, is known a cycle ahead. A line comes
    // later than that: in the cycle after the beginning it is still assumed that some are left.
    let some_left = graph.register("any_left", 1, 0);
    let may_go = graph.register("may_go", 1, 1);
    let any_left = *some_left;
    let goes = (run & *waiting.any & any_left & *may_go).named("goes");
    let begins = (goes & searched & !column.any()).named("row_begins");
    let row_loaded = (goes & column.all()).named("row_loaded");
    let per_line_bits = (per_line / sizes.loaded).ilog2();
    line_ends.drive(goes & column.low(per_line_bits).all());
    up_down(inside, start, begins, row_ends);
    column.next_if(start | goes, start.select(column.same(0), column.plus(1)));
    let more = left.drop_low(ROW_BITS).any().named("has_whole_row");
    let fewer = left.drop_low(ROW_BITS).minus(1).concat(left.low(ROW_BITS));
    let behind_row = more.select(fewer, left.same(0)).named("left_behind_row");
    let turns = (!any_left & !searched).named("turns_to_second_set");
    let first_left = keeps_table.select(others, spheres);
    let row_changes = (start | row_loaded | turns).named("row_changes");
    left.next_if(row_changes, start.select(first_left, turns.select(others, behind_row)));
    second.next(start.select(keeps_table, *second | turns));
    let any_of_first = start.delay(1).named("counts_spheres").select(left.any(), any_left);
    let any_behind_row = more & !left.is(u128::from(ROW));
    let any_then = row_loaded.select(any_behind_row, any_of_first);
    some_left.next(start | turns.select(others.any(), any_then));
    // A row that begins is inside from the next cycle on, in which it is no longer at its first sphere.
    let is_inside_row = goes.select(!column.all(), column.any()).named("goes_on_in_row");
    let is_searched = searched | turns;
    may_go.next(start | is_inside_row | !is_searched | !inside.msb() | row_ends);
    row.next_if(row_changes, (start | turns).select(row.same(0), row.plus(1)));
    let present: Vec<_> = (0..sizes.loaded)
        .zip(sizes.of_loaded("is_present"))
        .map(|(side, name)| {
            let place = if sizes.loaded == 1 { column.value() } else { column.concat(graph.constant(1, side.into())) };
            (more | left.low(ROW_BITS).greater_than(place)).named(&name)
        })
        .collect();

    // The line in the collector's memory, a cycle after its spheres are counted: the collector may be far away.
    let head = graph.register("head", slot_bits, 0);
    head.next_if(start | *waiting.counted, start.select(head.same(0), head.plus(1)));
    let to_line = 1 + CYCLES_TO_WORD;
    let word = column.low(per_line_bits).delay(to_line).named("word");
    let together = sizes.loaded * SPHERE_BITS;
    let parts: Vec<_> = (0..per_line / sizes.loaded).map(|part| line.slice(part * together, together)).collect();
    let spheres_now = chosen("sphere", word.one_hot(), &parts).delay(1).named("spheres_now");
    let to_unit = to_line + 1;
    let cycles = to_unit + unit.latency;
    let mut invalid = Vec::new();
    for (side, present) in (0..sizes.loaded).zip(&present) {
        let name = |name: &str| sizes.of_loaded(name).swap_remove(side as usize);
        let sphere = spheres_now.slice(side * SPHERE_BITS, SPHERE_BITS);
        let there = present.delay(to_unit).named(&name("sphere_is_present"));
        let bounds = graph.instance(&name("unit"), &unit, &[("sphere", sphere), ("present", there)]);
        graph.output(&name("box"), bounds.output("box"));
        graph.output(&name("sphere"), sphere.delay(unit.latency).named(&name("sphere_then")));
        invalid.push(bounds.output("invalid"));
    }

    // All that belongs to a sphere arrives with its box.
    let valid = later(start, goes, cycles, "on_the_way");
    graph.output("valid", valid);
    graph.output("column", column.delay(cycles).named("column_then"));
    graph.output("row", row.delay(cycles).named("row_then"));
    graph.output("searched", searched.delay(cycles).named("searched_then"));
    let to_table = !*second;
    graph.output("to_table", to_table.delay(cycles).named("to_table_then"));
    graph.output("head", head.value());
    graph.output("taken", waiting.counted.value());

    // The status.
    let told = (run & valid).named("tells");
    let are_invalid = Signal::join(&invalid.iter().rev().copied().collect::<Vec<_>>()).gate(told).named("are_invalid");
    let count = graph.register("invalid_count", COUNT_BITS, 0);
    let passed = graph.register("spheres_passed", COUNT_BITS, 0);
    let first = graph.register("first_invalid_sphere", COUNT_BITS, u128::from(u32::MAX));
    let none_yet = graph.register("none_invalid", 1, 1);
    let present: Vec<_> = present.iter().rev().map(|present| present.delay(cycles)).collect();
    let counted = Signal::join(&present).gate(told).named("are_counted");
    passed.next_if(
        start | told,
        start.select(passed.same(0), passed.value() + number_of("passing_now", counted).extend(COUNT_BITS)),
    );
    count.next_if(
        start | told,
        start.select(count.same(0), count.value() + number_of("invalid_now", are_invalid).extend(COUNT_BITS)),
    );
    let invalid = are_invalid.any().named("any_invalid");
    // The first of two is not the invalid one if its bit is not set.
    let place =
        if sizes.loaded == 1 { passed.value() } else { passed.value() + (!are_invalid.bit(0)).extend(COUNT_BITS) };
    first.next_if(start | (invalid & *none_yet), start.select(first.same(u128::from(u32::MAX)), place));
    none_yet.next(start | (*none_yet & !invalid));
    graph.output("invalid", count.value());
    graph.output("first_invalid", first.value());
    let set_ended = (!any_left & searched).named("set_ended");
    // The last sphere is still on its way to its box, and then to its row, for a few cycles.
    let passing = later(start, goes, cycles + 5, "passing");
    let on_the_way = graph.register("spheres_on_the_way", COUNT_BITS.ilog2() + 1, 0);
    up_down(on_the_way, start, goes, passing);
    let ended = set_ended & !inside.any() & !on_the_way.any() & !goes;
    graph.output("all_ended", (ended & run & !start).registered("all_ended"));
    let waits = run & any_left;
    graph.output("waits_for_input", (waits & !*waiting.any).registered("waits_for_input"));
    graph.finish()
}
