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
///
/// The longest step waits for most bits. So whether the top is clear after it is computed beside it, at both places
/// that may come to the top.
#[track_caller]
pub fn normalise<'g>(value: Signal<'g>, name: &str) -> Normalised<'g> {
    let width = value.width();
    let longest = 1 << (width - 1).ilog2();
    let mut shifted = value;
    let mut counted = Vec::new();
    let mut step = longest;
    while step > 0 {
        let clear = match counted.last() {
            Some(&moves) if 2 * step == longest => {
                let stays = value.high(step).is_zero();
                let moved = value.low(width - longest);
                Signal::select(moves, moved.high(step.min(moved.width())).is_zero(), stays)
            }
            _ => shifted.high(step).is_zero(),
        };
        let clear = clear.named(&format!("{name}_top_{step}_clear"));
        counted.push(clear);
        let moved = shifted.low(width - step).append_zeros(step);
        shifted = clear.select(moved, shifted).named(&format!("{name}_by_{step}"));
        step /= 2;
    }
    Normalised { value: shifted, zeros: Signal::join(&counted) }
}
