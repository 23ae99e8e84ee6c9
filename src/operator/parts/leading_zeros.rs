//! Counts the leading zeros by a tree of two-way choices, whose depth is the logarithm of the width.

use crate::hdl::Signal;

/// The number of leading zeros of `value` (at least 2 bits), and whether all its bits are clear. Inner values are named
/// after `name` and the bits of `value` that they describe.
///
/// The count has ⌈log2 width⌉ bits. For a value with all bits clear it is width − 1.
#[track_caller]
pub fn leading_zeros<'g>(value: Signal<'g>, name: &str) -> (Signal<'g>, Signal<'g>) {
    let clear = value.is_zero().named(&format!("{name}_is_zero"));
    (tree(value, 0, name).unwrap_or(clear), clear)
}

/// The count in a part whose lowest bit is the whole's bit `low`; a part of one bit has no count.
fn tree<'g>(part: Signal<'g>, low: u32, name: &str) -> Option<Signal<'g>> {
    let width = part.width();
    if width < 2 {
        return None;
    }
    // The upper part is a power of two wide, so that its width is the new bit of the count.
    let upper_width = 1 << (width - 1).ilog2();
    let lower_width = width - upper_width;
    let upper = part.high(upper_width);
    let upper_clear = upper.is_zero();
    let upper_count = tree(upper, low + lower_width, name);
    let Some(upper_count) = upper_count else { return Some(upper_clear) };
    let upper_clear = upper_clear.named(&format!("{name}_{}_{}_is_zero", low + width - 1, low + lower_width));
    let lower_count = match tree(part.low(lower_width), low, name) {
        Some(count) => count.extend(upper_width.ilog2()),
        None => upper_count.same(0),
    };
    let rest = upper_clear.select(lower_count, upper_count);
    Some(upper_clear.concat(rest).named(&format!("{name}_{}_{low}_zeros", low + width - 1)))
}
