//! HTML pages without external resources: no network, light or dark as the reader prefers, and no script but their own.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use sha2::{Digest, Sha256};

use crate::plot;

/// What a browser may load for a page: only its own style.
pub(crate) const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";

const STYLE: &str = "\
:root{color-scheme:light dark;--ground:#ffffff;--ink:#1c1f24;--soft:#5c6470;--grid:#dde1e6}
@media (prefers-color-scheme:dark){:root{--ground:#15181d;--ink:#e8eaee;--soft:#a4acb8;--grid:#323842}}
body{margin:0 auto;padding:1.5rem;max-width:60rem;background:var(--ground);color:var(--ink);\
font:15px/1.5 system-ui,'DejaVu Sans',sans-serif}
h1{font-size:1.6rem;line-height:1.2}h2{font-size:1.2rem;margin-top:2.2rem}
p.soft,caption,figcaption{color:var(--soft)}caption{text-align:left;padding-bottom:.4rem}
figure{margin:1.5rem 0}figure svg{display:block;box-sizing:border-box;max-width:100%;height:auto;border:1px solid var(--grid)}
div.wide{overflow-x:auto}
@media (max-width:40rem){body{padding:1rem}figure{overflow-x:auto}figure>svg.plot{min-width:38rem}\
#row span:nth-child(n+9){display:none}}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:.8rem 0}
th,td{padding:.3rem .7rem;border-bottom:1px solid var(--grid);text-align:left;vertical-align:top}
td.n,th.n{text-align:right}td.n{white-space:nowrap}th{vertical-align:bottom}
code,pre{font-family:ui-monospace,'DejaVu Sans Mono',monospace;font-size:.92em}
p code{overflow-wrap:anywhere}
pre{overflow-x:auto;border:1px solid var(--grid);padding:.7rem}
a{color:inherit}
h3{font-size:1rem;margin-bottom:.3rem}
.narrow{display:none}@media (max-width:40rem){.broad{display:none}.narrow{display:block}}
th[aria-sort]::after{content:\" ↑\"}th[aria-sort=descending]::after{content:\" ↓\"}
#points{font-size:.85em}#points th{cursor:pointer;white-space:normal;vertical-align:bottom}#points td{white-space:nowrap}
#points tr>:first-child{position:sticky;left:0;background:var(--ground)}#points tr.chosen td{background:var(--grid)}
details summary{cursor:pointer}
@media (max-width:40rem){th,td{padding:.3rem .45rem}td:first-child:not(.n){overflow-wrap:anywhere;min-width:7rem}}
#row:has(span+span){position:sticky;bottom:0}
#row{display:flex;flex-wrap:wrap;gap:.2rem 1.1rem;padding:.5rem .7rem;font-size:.85em;\
background:var(--ground);border:1px solid var(--grid);font-variant-numeric:tabular-nums}#row small{color:var(--soft)}
";

/// A page from its title and its body.
pub fn page(title: &str, body: &Markup) -> String {
    whole(title, body, None)
}

/// A page with a script, which runs at its end. The policy allows only this script, by its hash.
pub(crate) fn scripted(title: &str, body: &Markup, script: &str) -> String {
    whole(title, body, Some(script))
}

fn whole(title: &str, body: &Markup, script: Option<&str>) -> String {
    let hash = |script: &str| format!("{POLICY}; script-src 'sha256-{}'", base64(&Sha256::digest(script.as_bytes())));
    let policy = script.map_or(POLICY.to_owned(), hash);
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) (PreEscaped(plot::STYLE)) }
            }
            body {
                h1 { (title) }
                (body)
                @if let Some(script) = script { script { (PreEscaped(script)) } }
            }
        }
    };
    page.into_string()
}

/// Bytes in base 64 (RFC 4648, section 4), as hashes are written in policies.
pub(crate) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let word = (0..3).fold(0, |word, i| word << 8 | u32::from(three.get(i).copied().unwrap_or(0)));
        let digit = |place: usize| char::from(DIGITS[(word >> (18 - 6 * place) & 63) as usize]);
        (0..4).for_each(|place| text.push(if place <= three.len() { digit(place) } else { '=' }));
    }
    text
}

/// A plot, drawn twice: for a wide screen, and for a narrow one on which the text of the first would be too small.
pub(crate) fn figure(plot: &plot::Plot) -> Markup {
    html! {
        figure { div.broad { (plot.figure()) } div.narrow { (plot.clone().narrow().figure()) } }
    }
}

/// A table: a caption, headings, and rows. All columns but the first `words` hold figures, aligned to the right.
pub fn table(caption: &str, heading: &[&str], words: usize, rows: &[Vec<String>]) -> Markup {
    let class = |column: usize| if column < words { "" } else { "n" };
    html! {
        div.wide {
            table {
                @if !caption.is_empty() { caption { (caption) } }
                thead { tr { @for (column, name) in heading.iter().enumerate() { th class=(class(column)) { (name) } } } }
                tbody {
                    @for row in rows {
                        tr { @for (column, cell) in row.iter().enumerate() { td class=(class(column)) { (cell) } } }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_in_base_64_are_as_the_standard_has_them() {
        for (bytes, text) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        let page = scripted("t", &html! {}, "let a = 1 < 2;");
        assert!(page.contains("script-src 'sha256-") && page.contains("<script>let a = 1 < 2;</script>"), "{page}");
    }

    #[test]
    fn a_page_loads_nothing_and_escapes_its_text() {
        let rows = [vec!["a <b>".to_owned(), "1".to_owned()]];
        let page = page("x & y", &table("", &["name", "n"], 1, &rows));
        assert!(page.starts_with("<!DOCTYPE html>") && page.contains(POLICY.split(';').next().unwrap_or_default()));
        assert!(page.contains("<h1>x &amp; y</h1>") && page.contains("<td class=\"\">a &lt;b&gt;</td>"), "{page}");
        for load in ["http:", "https:", "<script", "<link", "src=", "url(", "@import"] {
            assert!(!page.contains(load), "{load}");
        }
    }
}
