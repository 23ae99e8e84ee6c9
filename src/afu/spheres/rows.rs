//! Rows of spheres: the box around each row and around each 16 rows, and the start of a row's search.

use std::sync::Arc;

use super::bounds::Edges;
use super::{ROW, ROW_BITS, ROW_NUMBER_BITS, Sizes};
use crate::afu::counter::later;
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Cycles from a complete row to its search: the last row that it is compared with, and the words of groups up to
/// that. By then the boxes around it are written.
const CYCLES_TO_LAUNCH: u32 = 2;

/// Builds the module `contact_afu_rows`.
pub(super) fn rows(sizes: &Sizes) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_rows");
    graph.about("the boxes around rows and around groups of rows");
    let start = graph.input("start", 1);
    let keeps_table = graph.input("keeps_table", 1);
    let has_others = graph.input("has_others", 1);
    let boxes: Vec<_> = sizes.of_loaded("box").iter().map(|name| graph.input(name, sizes.box_bits())).collect();
    let [valid, searched, to_table] = ["valid", "searched", "to_table"].map(|name| graph.input(name, 1));
    let column = graph.input("column", sizes.loaded_bits());
    let row = graph.input("row", ROW_NUMBER_BITS);
    // A box, or the one around two, is in a register before the row takes it in, and whether the row begins with it.
    let is_first = (!column.any()).delay(1).named("is_first_column");
    let bounds = match *boxes {
        [first, second] => Edges::of(first).around(Edges::of(second), valid.same(0)).delay(1).named("around_two"),
        _ => boxes[0].delay(1).named("box_in_hand"),
    };
    let valid = later(start, valid, 1, "box_comes");
    let column = column.delay(1).named("column_in_hand");

    let around = graph.data_register("around", sizes.box_bits());
    around.next_if(valid, Edges::of(*around).around(Edges::of(bounds), is_first));
    let complete = (valid & column.all() & !start).registered("row_complete");
    let row = row.delay(2).named("complete_row");
    let of_table = (complete & to_table.delay(2).named("is_of_table")).named("row_of_table");
    let of_search = (complete & searched.delay(2).named("is_searched")).named("row_of_search");
    graph.output("row_box", around.value());
    graph.output("row_box_row", row);
    graph.output("writes_row_box", of_table);
    graph.output("writes_query", of_search);

    // The box around the group that is being filled.
    let group_around = graph.data_register("group_around", sizes.box_bits());
    let is_first = (!row.low(ROW_BITS).any()).named("is_first_of_group");
    group_around.next_if(of_table, Edges::of(*group_around).around(Edges::of(*around), is_first));
    graph.output("group_box", group_around.value());
    graph.output("group_box_group", row.delay(1).named("group_row").slice(ROW_BITS, sizes.group_bits));
    graph.output("writes_group_box", of_table.gate(!start).registered("writes_group_box"));
    let table_rows = graph.register("table_rows", ROW_NUMBER_BITS + 1, 0);
    let emptied = (start & !keeps_table).named("empties_table");
    table_rows.next_if(emptied | of_table, emptied.select(table_rows.same(0), table_rows.plus(1)));
    let table_last = table_rows.minus(1).low(ROW_NUMBER_BITS).delay(1).named("table_last_row");
    let nothing = (has_others & !table_rows.any()).registered("table_is_empty");
    graph.output("table_last", table_last.low(sizes.row_bits));

    // The search of a row begins with the words of groups that there are.
    let limit = has_others.select(table_last, row).delay(1).named("last_row");
    let top = limit.drop_low(2 * ROW_BITS);
    let words: Vec<_> = (0..ROW).rev().map(|word| top.at_least(top.same(word.into()))).collect();
    graph.output("launches", later(start, of_search, CYCLES_TO_LAUNCH, "launching"));
    graph.output("launched_row", row.delay(CYCLES_TO_LAUNCH).named("launched_row"));
    graph.output("words", Signal::join(&words).gate(!nothing).delay(1).named("words"));
    graph.finish()
}
