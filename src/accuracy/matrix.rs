//! Gross failures as a picture: one row per category, one column per contender.

use super::HardResults;
use maud::html;

const ROW: usize = 22;
const TOP: usize = 64;
const NAMES: usize = 130;
const COLUMN: usize = 104;
/// Colours are presentation attributes, which every viewer supports. The style replaces them on a dark background.
const STYLE: &str = "@media (prefers-color-scheme:dark){.ground{fill:#15181d}.ink{fill:#e8eaee}.soft{fill:#a4acb8}}";

/// The picture as an SVG file: in each cell the share of pairs on which the contender failed grossly.
pub(super) fn svg(results: &HardResults) -> String {
    let (contenders, categories) = (results.contenders(), results.categories());
    let (width, height) = (NAMES + COLUMN * contenders.len() + 16, TOP + ROW * categories.len() + 12);
    let cell = |category: &str, contender: &str| {
        let row = results.rows.iter().find(|row| row.category == category && row.contender == contender)?;
        (row.tally.pairs > 0).then(|| row.tally.bad as f64 / row.tally.pairs as f64)
    };
    let title = format!("Gross failures on hard pairs, {} per category", results.per_category());
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {width} {height}")) width=(width) height=(height)
            font-family="system-ui,'DejaVu Sans',sans-serif" font-size="13" role="img" aria-label=(title) {
            style { (maud::PreEscaped(STYLE)) }
            rect class="ground" width=(width) height=(height) fill="#ffffff" {}
            text class="ink" x="12" y="24" font-size="14" font-weight="600" fill="#1c1f24" { (title) }
            @for (column, contender) in contenders.iter().enumerate() {
                @let x = NAMES + COLUMN * column + COLUMN / 2;
                text class="ink" x=(x) y=(TOP - 10) text-anchor="middle" fill="#1c1f24" { (contender) }
            }
            @for (row, category) in categories.iter().enumerate() {
                @let y = TOP + ROW * row;
                text class="ink" x=(NAMES - 10) y=(y + 15) text-anchor="end" fill="#1c1f24" { (category) }
                @for (column, contender) in contenders.iter().enumerate() {
                    @let x = NAMES + COLUMN * column;
                    @match cell(category, contender) {
                        None => {}
                        Some(0.0) => text class="soft" x=(x + COLUMN / 2) y=(y + 15) text-anchor="middle" fill="#5c6470" { "0" },
                        Some(share) => {
                            rect x=(x + 2) y=(y + 1) width=(COLUMN - 4) height=(ROW - 2) rx="3" fill="#c04a00"
                                fill-opacity=(format!("{:.2}", 0.15 + 0.6 * share)) {}
                            text class="ink" x=(x + COLUMN / 2) y=(y + 15) text-anchor="middle" fill="#1c1f24" {
                                (percent(share))
                            }
                        },
                    }
                }
            }
        }
    }
    .into_string()
}

/// A share that is not 0, so that it never reads as 0.
fn percent(share: f64) -> String {
    match share * 100.0 {
        percent if percent >= 9.95 => format!("{percent:.0} %"),
        percent if percent >= 0.05 => format!("{percent:.1} %"),
        _ => "< 0.1 %".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn no_failure_reads_as_none() {
        assert_eq!([1.0, 0.818, 0.0375, 1e-4].map(percent), ["100 %", "82 %", "3.8 %", "< 0.1 %"]);
    }
}
