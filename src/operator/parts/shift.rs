//! Logarithmic shifters: one two-way choice for each bit of the distance.

use crate::hdl::Signal;

/// `value` shifted left by `distance`. Bits that leave at the top are lost. Steps are named as in `name_by_8`.
#[track_caller]
pub fn shift_left<'g>(value: Signal<'g>, distance: Signal<'g>, name: &str) -> Signal<'g> {
    let width = value.width();
    let mut shifted = value;
    for level in (0..distance.width()).rev() {
        let step = step(level);
        let moved = if step < width { shifted.low(width - step).append_zeros(step) } else { shifted.same(0) };
        shifted = distance.bit(level).select(moved, shifted).named(&format!("{name}_by_{step}"));
    }
    shifted
}

/// `value` shifted right by `distance`, and whether a set bit was lost ("sticky").
#[track_caller]
pub fn shift_right_sticky<'g>(value: Signal<'g>, distance: Signal<'g>, name: &str) -> (Signal<'g>, Signal<'g>) {
    let width = value.width();
    let distance = capped(distance, width, &format!("{name}_distance"));
    let mut shifted = value;
    let mut sticky = value.graph().constant(1, 0);
    for level in (0..distance.width()).rev() {
        let (step, taken) = (step(level), distance.bit(level));
        sticky = sticky | (taken & shifted.low(step.min(width)).any()).named(&format!("{name}_by_{step}_loses"));
        let moved = if step < width { shifted.drop_low(step).extend(width) } else { shifted.same(0) };
        shifted = taken.select(moved, shifted).named(&format!("{name}_by_{step}"));
    }
    (shifted, sticky)
}

/// The number of bits of a distance whose largest value shifts out all of a value of `width` bits.
pub fn distance_bits(width: u32) -> u32 {
    u32::BITS - width.leading_zeros()
}

/// A distance in the bits that a value of `width` bits needs. A distance that shifts everything out and does not fit
/// becomes the largest that fits, which also shifts everything out. So this costs a gate per bit of the distance, not
/// per bit of the value. The result is named if it differs from the distance.
#[track_caller]
pub fn capped<'g>(distance: Signal<'g>, width: u32, name: &str) -> Signal<'g> {
    let levels = distance_bits(width);
    if distance.width() <= levels {
        return distance;
    }
    let far = distance.drop_low(levels).any().named(&format!("{name}_is_far"));
    (distance.low(levels) | far.repeat(levels)).named(name)
}

/// The number of places that a level of the shifter moves; more than any width from the 31st bit on.
fn step(level: u32) -> u32 {
    1_u32.checked_shl(level).unwrap_or(u32::MAX)
}
