//! Sum and difference in a wider format, directly from narrower words. Subnormal operands need no normalisation before,
//! because the sum is normalised anyway.

use super::{Domain, Values, add, convert};
use crate::hdl::Signal;
use crate::number::Format;

/// True if every sum of two finite numbers of `from` is zero or a normal number of `to`, and each of these numbers is a
/// number of `to`.
pub fn is_direct(from: Format, to: Format) -> bool {
    to.fraction_bits() >= from.fraction_bits()
        && to.min_exponent() <= from.min_exponent() - from.fraction_bits() as i32
        && to.bias() > from.bias()
}

/// a + b, or a − b if `subtract` is set, in the format `to`. If a number may not fit there, both are converted first.
pub fn sum<'g>(a: Signal<'g>, b: Signal<'g>, from: Domain, to: Format, subtract: bool) -> Signal<'g> {
    if is_direct(from.format(), to) {
        let values = if from.is_finite() { Values::Normal } else { Values::Any };
        let to = Domain::new(to, values);
        return add::add_to(a, b, from, to, subtract, to.rounding());
    }
    let [a, b] = [a, b].map(|word| convert::convert(word, from, to));
    let to = Domain::from(to);
    add::add(a, b, to, subtract, to.rounding())
}
