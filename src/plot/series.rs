//! The data drawn between the axes.

/// How points are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// Solid: for measured values.
    Solid,
    /// Dashed: for simulated values.
    Dashed,
    /// Dotted: for values from others.
    Dotted,
}

/// The sign at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// ●
    Circle,
    /// ■
    Square,
    /// ◆
    Diamond,
    /// ▲
    Triangle,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub(super) name: String,
    pub(super) colour: usize,
    pub(super) points: Vec<(f64, f64)>,
    pub(super) line: Option<Line>,
    pub(super) marker: Option<(Marker, bool)>,
    pub(super) names: Vec<String>,
}

impl Series {
    /// Points in the colour `colour`, a number that repeats after six. Points that have no place on an axis (not
    /// finite, or not above zero on a logarithmic one) are left out and interrupt the line.
    pub fn new(name: &str, colour: usize, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            name: name.to_owned(),
            colour,
            points: points.into_iter().collect(),
            line: None,
            marker: None,
            names: Vec::new(),
        }
    }

    /// Joined by a line.
    #[must_use]
    pub fn line(self, line: Line) -> Self {
        Self { line: Some(line), ..self }
    }

    /// With a filled sign at each point.
    #[must_use]
    pub(crate) fn marker(self, marker: Marker) -> Self {
        Self { marker: Some((marker, false)), ..self }
    }

    /// With a name for each point, in their order. The name is beside the point if there is room, and is the
    /// `data-point` of its sign, for the pointer.
    #[must_use]
    pub fn named(self, names: impl IntoIterator<Item = String>) -> Self {
        Self { names: names.into_iter().collect(), ..self }
    }

    /// With a hollow sign at each point.
    #[must_use]
    pub fn hollow(self, marker: Marker) -> Self {
        Self { marker: Some((marker, true)), ..self }
    }
}

/// An upright line at a place on the x axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub(super) at: f64,
    pub(super) label: String,
    pub(super) colour: Option<usize>,
}

impl Mark {
    /// A line in the colour of text.
    pub fn new(at: f64, label: &str) -> Self {
        Self { at, label: label.to_owned(), colour: None }
    }

    /// In the colour of a series.
    #[must_use]
    pub fn colour(self, colour: usize) -> Self {
        Self { colour: Some(colour), ..self }
    }
}
