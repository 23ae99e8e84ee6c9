//! Logarithmic shifters: one two-way choice for each bit of the distance.

use crate::hdl::Signal;

/// `value` shifted left by `distance`; what leaves at the top is lost. Steps are named as in `name_by_8`.
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
    // Bits of the distance that are worth the whole width and more move everything out at once.
    let levels = (0..distance.width()).take_while(|&level| step(level) < width).count() as u32;
    let mut shifted = value;
    let mut sticky = value.graph().constant(1, 0);
    for level in (0..levels).rev() {
        let (step, taken) = (step(level), distance.bit(level));
        sticky = sticky | (taken & shifted.low(step).any()).named(&format!("{name}_by_{step}_loses"));
        shifted = taken.select(shifted.drop_low(step).extend(width), shifted).named(&format!("{name}_by_{step}"));
    }
    if levels == distance.width() {
        return (shifted, sticky);
    }
    let far = distance.drop_low(levels).any().named(&format!("{name}_far"));
    (shifted.gate(!far), far.select(value.any(), sticky))
}

/// How far a level of the shifter moves; beyond any width from the 31st bit on.
fn step(level: u32) -> u32 {
    1_u32.checked_shl(level).unwrap_or(u32::MAX)
}
