//! Plots as SVG: axes, ticks, series of lines and points, marks, and a legend below, where it covers nothing.
//!
//! [`Plot::svg`] is a file of its own; [`Plot::figure`] goes into a page that has [`STYLE`] in its head. Both follow a
//! reader's light or dark scheme, and are light in a viewer that knows no style. Imports nothing of ours.

mod axis;
mod draw;
mod layout;
mod names;
#[cfg(test)]
pub(crate) mod overlap;
mod series;
mod style;

pub use axis::{Axis, Scale};
pub use series::{Line, Mark, Marker, Series};
pub use style::STYLE;

/// A plot: a title, two axes, and what lies between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Above the plot.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// In the order of the legend; later ones lie over earlier ones.
    pub series: Vec<Series>,
    /// Upright lines at places on the x axis, each with a few words above the plot.
    pub marks: Vec<Mark>,
    width: f64,
}

impl Plot {
    /// A plot without series.
    pub fn new(title: &str, x: Axis, y: Axis) -> Self {
        Self { title: title.to_owned(), x, y, series: Vec::new(), marks: Vec::new(), width: layout::WIDTH }
    }

    /// Adds a series.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds a mark.
    #[must_use]
    pub fn marked(mut self, mark: Mark) -> Self {
        self.marks.push(mark);
        self
    }

    /// The plot for a narrow screen: text keeps its size, and everything else has less room.
    #[must_use]
    pub(crate) fn narrow(mut self) -> Self {
        self.width = layout::NARROW;
        self
    }

    /// The plot as an SVG file, which carries its own colours.
    pub fn svg(&self) -> String {
        draw::file(self).into_string()
    }

    /// The plot as part of a page that has [`STYLE`].
    pub fn figure(&self) -> maud::Markup {
        draw::figure(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(scale: Scale) -> Plot {
        let axis = |label: &str| Axis::new(label, scale);
        let points = || (1..=10).map(|i| (f64::from(i) * 100.0, f64::from(i * i)));
        Plot::new("A < B & \"C\"", axis("collisions"), axis("time, ns"))
            .with(Series::new("measured", 0, points()).line(Line::Solid).marker(Marker::Circle))
            .with(Series::new("simulated", 1, points()).line(Line::Dashed).hollow(Marker::Square))
            .marked(Mark::new(250.0, "crossover 250"))
    }

    #[test]
    fn an_svg_has_every_point_and_every_name() {
        for scale in [Scale::Linear, Scale::Log] {
            let svg = plot(scale).svg();
            assert!(svg.starts_with("<svg ") && svg.contains(r#"xmlns="http://www.w3.org/2000/svg""#), "{svg}");
            assert_eq!(svg.matches("<circle").count(), 11, "ten points and one in the legend");
            for text in ["measured", "simulated", "collisions", "time, ns", "crossover 250", "A &lt; B &amp; "] {
                assert!(svg.contains(text), "{text}");
            }
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
            let (open, closed) = (svg.matches("<g").count(), svg.matches("</g>").count());
            assert_eq!(open, closed);
        }
    }

    #[test]
    fn what_has_no_place_is_left_out_and_parts_the_line() {
        let points = [(1.0, 1.0), (2.0, 2.0), (3.0, f64::NAN), (4.0, 0.0), (5.0, 5.0), (6.0, 6.0)];
        let log = Plot::new("", Axis::new("x", Scale::Linear), Axis::new("y", Scale::Log))
            .with(Series::new("s", 0, points).line(Line::Solid).marker(Marker::Circle));
        let svg = log.svg();
        assert_eq!(svg.matches("<circle").count(), 4 + 1);
        let path =
            svg.split("class=\"line c0 Solid\" d=\"").nth(1).and_then(|rest| rest.split('"').next()).expect("a path");
        assert_eq!(path.matches('M').count(), 2, "{path}");
    }

    #[test]
    fn named_points_can_be_pointed_at() {
        let axis = || Axis::new("", Scale::Linear).with_range(0.0, 10.0);
        let points = [(1.0, 1.0), (5.0, f64::NAN), (9.0, 9.0)];
        let series = Series::new("s", 0, points).hollow(Marker::Circle);
        let svg = Plot::new("", axis(), axis()).with(series.named(["a", "lost", "b"].map(str::to_owned))).svg();
        for text in ["data-point=\"a\"", "data-point=\"b\"", ">a</text>", ">b</text>", "<title>b</title>"] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
        assert!(!svg.contains("lost"), "a point without a place has no name either");
    }

    /// A viewer that does not support CSS variables leaves out elements whose colour is one.
    #[test]
    fn every_element_has_its_colours_as_attributes() {
        let named = Series::new("t", 8, [(3.0, 3.0)]).hollow(Marker::Circle).named(["a name".to_owned()]);
        let svg = plot(Scale::Linear).with(named).svg();
        let (style, drawn) = svg.split_once("</style>").expect("a style");
        assert!(!svg.contains("var(") && style.contains("prefers-color-scheme:dark"), "{style}");
        let elements = drawn
            .split('<')
            .filter(|element| ["path ", "circle ", "text ", "rect "].iter().any(|kind| element.starts_with(kind)));
        for element in elements {
            let is_line = element.contains("class=\"mark ");
            assert!(element.contains(" fill=\"") || is_line && element.contains(" stroke=\"#"), "{element}");
            assert!(element.starts_with("text ") || element.contains("\"#") || element.contains("around"), "{element}");
        }
    }

    #[test]
    fn no_words_lie_on_others_in_a_broad_or_a_narrow_plot() {
        let marked = |scale| {
            let points: Vec<(f64, f64)> = (1..12).map(|i| (f64::from(i * i * i) * 70.0, f64::from(i))).collect();
            let names: Vec<String> = (1..12).map(|i| format!("point {i}")).collect();
            plot(scale)
                .with(Series::new("named", 2, points).marker(Marker::Square).named(names))
                .marked(Mark::new(260.0, "near"))
        };
        for scale in [Scale::Linear, Scale::Log] {
            overlap::check(&marked(scale).svg());
            overlap::check(&marked(scale).narrow().svg());
        }
    }

    #[test]
    fn an_empty_plot_is_a_plot() {
        let empty = Plot::new("", Axis::new("x", Scale::Log), Axis::new("y", Scale::Linear)).svg();
        assert!(empty.contains("</svg>") && !empty.contains("NaN"), "{empty}");
    }
}
