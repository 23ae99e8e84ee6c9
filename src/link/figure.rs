//! A figure with its source.

use serde::{Deserialize, Deserializer, de::Error};

/// A value and its source.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The value, in the unit that its key ends with.
    pub value: f64,
    /// The source of the value.
    pub source: String,
}

/// Reads a time in nanoseconds, of at most a second.
pub(super) fn time<'de, D: Deserializer<'de>>(from: D) -> Result<Figure, D::Error> {
    figure(from, |value| (0.0..=1e9).contains(&value), "from 0 to 1e9")
}

/// Reads a rate in 10⁹ bytes per second.
pub(super) fn rate<'de, D: Deserializer<'de>>(from: D) -> Result<Figure, D::Error> {
    figure(from, |value| value > 0.0 && value <= 1e6, "above 0 and at most 1e6")
}

/// Reads a number of lines.
pub(super) fn count<'de, D: Deserializer<'de>>(from: D) -> Result<Figure, D::Error> {
    figure(from, |value| (1.0..=65536.0).contains(&value) && value.fract() == 0.0, "a whole number from 1 to 65536")
}

impl Figure {
    pub(super) fn optional_time<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Self>, D::Error> {
        time(from).map(Some)
    }

    pub(super) fn optional_rate<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Self>, D::Error> {
        rate(from).map(Some)
    }
}

fn figure<'de, D: Deserializer<'de>>(from: D, is_good: fn(f64) -> bool, range: &str) -> Result<Figure, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields, expecting = "a figure: { value = …, source = \"…\" }")]
    struct Written {
        value: f64,
        source: String,
    }
    let Written { value, source } = Written::deserialize(from)?;
    if !is_good(value) {
        return Err(D::Error::custom(format!("the value is {value}, but must be {range}")));
    }
    if source.trim().is_empty() {
        return Err(D::Error::custom("the source is empty: say where the figure is from"));
    }
    Ok(Figure { value, source })
}
