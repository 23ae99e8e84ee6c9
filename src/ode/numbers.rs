//! Ranges of the numbers that ODE accepts. Outside them, an assertion in ODE ends the process.

use super::Error;
use std::ops::RangeInclusive;

/// The largest coordinate, radius, force or density: 2^27.
///
/// ODE's hash space counts cells with an `int`, and cells are at least 1/8 wide. Within this bound, neither that count
/// nor any product of a step in `f64` overflows.
pub(super) const LARGEST: f64 = 134_217_728.0;
/// The smallest radius, density or time: 2^-27. A mass must not become 0.
pub(super) const SMALLEST: f64 = 1.0 / LARGEST;

/// `value` if it is in the range. A NaN is in no range.
pub(super) fn within(what: &'static str, value: f64, range: RangeInclusive<f64>) -> Result<f64, Error> {
    if range.contains(&value) {
        return Ok(value);
    }
    Err(Error::Number { what, value, least: *range.start(), most: *range.end() })
}

/// Numbers of either sign that a step may use.
pub(super) fn signed(what: &'static str, values: [f64; 3]) -> Result<[f64; 3], Error> {
    for value in values {
        within(what, value, -LARGEST..=LARGEST)?;
    }
    Ok(values)
}

/// A number that must not be zero.
pub(super) fn positive(what: &'static str, value: f64) -> Result<f64, Error> {
    within(what, value, SMALLEST..=LARGEST)
}
