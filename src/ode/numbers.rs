//! Ranges of the numbers that ODE is given: on others, an assertion in ODE ends the process.

use super::Error;
use std::ops::RangeInclusive;

/// The largest coordinate, radius, force or density: 2^27.
///
/// ODE's hash space counts cells with an `int`, and cells are 1/8 at least. Within this bound neither that count nor,
/// in `f64`, any product of a step overflows.
pub(super) const LARGEST: f64 = 134_217_728.0;
/// The smallest radius, density or time: 2^-27. A mass must not become 0.
pub(super) const SMALLEST: f64 = 1.0 / LARGEST;

/// `value`, if it is in a range (a NaN is in none).
pub(super) fn within(what: &'static str, value: f64, range: RangeInclusive<f64>) -> Result<f64, Error> {
    if range.contains(&value) {
        return Ok(value);
    }
    Err(Error::Number { what, value, least: *range.start(), most: *range.end() })
}

/// A sum that a step can need of anything with a sign.
pub(super) fn signed(what: &'static str, values: [f64; 3]) -> Result<[f64; 3], Error> {
    for value in values {
        within(what, value, -LARGEST..=LARGEST)?;
    }
    Ok(values)
}

/// Something that must not be zero.
pub(super) fn positive(what: &'static str, value: f64) -> Result<f64, Error> {
    within(what, value, SMALLEST..=LARGEST)
}
