//! Whether words in an SVG lie on others, for tests: boxes of its text elements, whose widths are estimated.

/// Left, top, right and bottom.
type Frame = [f64; 4];

/// The least width of a character, as a share of the font's size: what overlaps by this overlaps for certain.
const NARROW: f64 = 0.5;

/// Checks that no text of an SVG covers another, or leaves the picture to the left or right.
///
/// # Panics
/// Panics if a text overlaps another; the message has both.
pub(crate) fn check(svg: &str) {
    let width: f64 = attribute(svg, "viewBox")
        .and_then(|view| view.split(' ').nth(2)?.parse().ok())
        .expect("a view box with a width");
    let texts = texts(svg);
    assert!(texts.len() > 2, "{svg}");
    for (number, (a, words)) in texts.iter().enumerate() {
        assert!(a[0] >= 0.0 && a[2] <= width, "`{words}` leaves the picture: {a:?}");
        for (b, others) in &texts[..number] {
            let apart = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
            assert!(apart, "`{words}` lies on `{others}`: {a:?} {b:?}");
        }
    }
}

fn texts(svg: &str) -> Vec<(Frame, String)> {
    let elements = svg.split("<text ").skip(1).filter_map(|rest| rest.split_once("</text>")?.0.split_once('>'));
    let shown = elements.filter(|(attributes, words)| !attributes.contains("\"halo\"") && !words.is_empty());
    shown.map(|(attributes, words)| (frame(attributes, words), words.to_owned())).collect()
}

fn frame(attributes: &str, words: &str) -> Frame {
    let number = |name: &str| attribute(attributes, name).and_then(|text| text.parse::<f64>().ok());
    let size = number("font-size").unwrap_or(12.0);
    let letters = words.replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"");
    let wide = letters.chars().count() as f64 * size * NARROW;
    let before = match attribute(attributes, "text-anchor") {
        Some("middle") => wide / 2.0,
        Some("end") => wide,
        _ => 0.0,
    };
    let (above, below) = (0.75 * size, 0.2 * size);
    if let Some(moved) = attribute(attributes, "transform") {
        let place = moved.trim_start_matches("translate(").split_once(')').expect("a place").0;
        let (x, y) = place.split_once(' ').expect("two numbers");
        let [x, y]: [f64; 2] = [x, y].map(|text| text.parse().expect("a number"));
        // Turned by a right angle: it reads upwards.
        return [x - above, y - wide + before, x + below, y + before];
    }
    let (x, y) = (number("x").expect("a place"), number("y").expect("a place"));
    [x - before, y - above, x - before + wide, y + below]
}

fn attribute<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = text.split_once(&format!("{name}=\""))?;
    Some(rest.split_once('"')?.0)
}

#[test]
#[should_panic(expected = "lies on")]
fn words_on_words_are_found() {
    check(concat!(
        "<svg viewBox=\"0 0 100 100\"><text x=\"10\" y=\"20\">some</text><text x=\"20\" y=\"24\">words</text>",
        "<text x=\"10\" y=\"60\">others</text></svg>"
    ));
}
