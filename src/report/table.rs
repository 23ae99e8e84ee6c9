//! Tables for a terminal.

use comfy_table::{Cell, CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};

pub use crate::count::{counted, grouped};

const RULE: LineStyle = LineStyle::none().fill('─').junction('─');
const STYLE: TableStyle = TableStyle::new().top_border(RULE).header_separator(RULE).bottom_border(RULE);

/// A table with a heading line. The first column is text, the others are figures.
pub fn table<R, C>(heading: &[&str], rows: R) -> String
where
    R: IntoIterator<Item = C>,
    C: IntoIterator<Item = String>,
{
    aligned_from(1, None, heading, rows)
}

/// The width of a terminal that text is made for, in columns.
pub const WIDTH: u16 = 100;

/// A table whose columns are all text, with cells wrapped to keep to [`WIDTH`].
pub fn words<R, C>(heading: &[&str], rows: R) -> String
where
    R: IntoIterator<Item = C>,
    C: IntoIterator<Item = String>,
{
    aligned_from(usize::MAX, Some(WIDTH), heading, rows)
}

/// A table whose columns are right-aligned from the column `figures` on.
fn aligned_from<R, C>(figures: usize, width: Option<u16>, heading: &[&str], rows: R) -> String
where
    R: IntoIterator<Item = C>,
    C: IntoIterator<Item = String>,
{
    let mut table = Table::new();
    table.load_style(STYLE);
    if let Some(width) = width {
        table.set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
    }
    let aligned = |(column, text): (usize, String)| {
        let side = if column < figures { CellAlignment::Left } else { CellAlignment::Right };
        Cell::new(text).set_alignment(side)
    };
    table.set_header(heading.iter().map(|text| (*text).to_owned()).enumerate().map(aligned));
    for row in rows {
        table.add_row(row.into_iter().enumerate().map(aligned));
    }
    table.trim_fmt()
}

/// A figure with `places` decimals, or a dash for `None` (a job without pairs has no cycles per pair).
pub fn figure(value: Option<f64>, places: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.places$}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_its_figures_on_the_right() {
        let text =
            table(&["set", "pairs"], [["a".to_owned(), "1".to_owned()], ["bcd".to_owned(), "12 354".to_owned()]]);
        let expected = expect_test::expect![[r#"
            ──────────────
             set    pairs
            ──────────────
             a          1
             bcd   12 354
            ──────────────"#]];
        expected.assert_eq(&text);
    }
}
