//! Moves a value's leading one to the top. Counting and shifting use the same steps, which takes less logic than a
//! count followed by a shifter.

use crate::hdl::Signal;

/// A value without leading zeros.
#[derive(Clone, Copy)]
pub struct Normalised<'g> {
    /// As wide as the value; the top bit is set unless the value is zero.
    pub value: Signal<'g>,
    /// The number of leading zeros; for zero, the largest count.
    pub zeros: Signal<'g>,
}

/// `value` (at least 2 bits) shifted left until its top bit is set. Steps are named as in `name_by_8`.
#[track_caller]
pub fn normalise<'g>(value: Signal<'g>, name: &str) -> Normalised<'g> {
    let width = value.width();
    let mut shifted = value;
    let mut counted = Vec::new();
    for level in (0..=(width - 1).ilog2()).rev() {
        let step = 1 << level;
        let clear = shifted.high(step).is_zero().named(&format!("{name}_top_{step}_clear"));
        counted.push(clear);
        let moved = shifted.low(width - step).append_zeros(step);
        shifted = clear.select(moved, shifted).named(&format!("{name}_by_{step}"));
    }
    Normalised { value: shifted, zeros: Signal::join(&counted) }
}
