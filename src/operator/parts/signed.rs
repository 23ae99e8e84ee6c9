//! Exponents inside an operator: two's complement, exactly as wide as their range needs.

use crate::hdl::Signal;

/// A two's complement value and its known range, for operands that are finite and not zero.
///
/// The range decides the width, and whether overflow or underflow can happen. Logic for what cannot happen is not
/// built. For special operands the value may wrap, and [`super::Special`] then selects the result.
#[derive(Clone, Copy)]
pub struct Signed<'g> {
    bits: Signal<'g>,
    min: i64,
    max: i64,
    /// The value that this one exceeds by a constant, and that constant. Another constant is then one addition from
    /// there, not two.
    offset_from: Option<(Signal<'g>, i64)>,
}

/// Bits of two's complement that hold both ends.
fn width_for(min: i64, max: i64) -> u32 {
    let bits = |value: i64| 64 - if value < 0 { value.leading_ones() } else { value.leading_zeros() };
    1 + bits(min).max(bits(max))
}

impl<'g> Signed<'g> {
    /// An unsigned field in `min..=max`.
    #[track_caller]
    pub fn unsigned(field: Signal<'g>, min: i64, max: i64) -> Self {
        let width = width_for(min, max).max(field.width() + 1);
        Self { bits: field.extend(width), min, max, offset_from: None }
    }

    /// The same value with a smaller range, which its construction does not show.
    #[must_use]
    pub fn with_range(self, min: i64, max: i64) -> Self {
        let width = width_for(min, max);
        Self { bits: self.bits(width), min, max, offset_from: None }
    }

    /// Smallest value.
    pub fn min(self) -> i64 {
        self.min
    }

    /// Largest value.
    pub fn max(self) -> i64 {
        self.max
    }

    /// Gives the value a name in the generated Verilog.
    #[track_caller]
    #[must_use]
    pub fn named(self, name: &str) -> Self {
        Self { bits: self.bits.named(name), ..self }
    }

    /// The low `width` bits of the two's complement, sign-extended where there are fewer.
    #[track_caller]
    pub fn bits(self, width: u32) -> Signal<'g> {
        match width.checked_sub(self.bits.width()) {
            None | Some(0) => self.bits.low(width),
            Some(more) => self.bits.msb().repeat(more).concat(self.bits),
        }
    }

    fn constant(self, width: u32, value: i64) -> Signal<'g> {
        self.bits.graph().constant(width, value as u128 & ((1 << width) - 1))
    }

    /// Sum.
    #[track_caller]
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        let (min, max) = (self.min + other.min, self.max + other.max);
        let width = width_for(min, max);
        Self { bits: self.bits(width) + other.bits(width), min, max, offset_from: None }
    }

    /// Sum and one more, by the carry into the adder.
    #[track_caller]
    #[must_use]
    pub fn plus_and_one(self, other: Self) -> Self {
        let (min, max) = (self.min + other.min + 1, self.max + other.max + 1);
        let width = width_for(min, max);
        let one = self.bits.graph().constant(1, 1);
        Self {
            bits: (self.bits(width).concat(one) + other.bits(width).concat(one)).named("sum_and_carry").drop_low(1),
            min,
            max,
            offset_from: None,
        }
    }

    /// Minus `bias` + 1, which is a power of two, so the bits below it do not change.
    #[track_caller]
    #[must_use]
    pub fn minus_bias_and_one(self, bias: i32) -> Self {
        let by = i64::from(bias) + 1;
        let low = by.trailing_zeros();
        let whole = self.offset(-by);
        let high = self.bits(whole.bits.width()).drop_low(low);
        let bits = high.minus(1).concat(self.bits.low(low));
        Self { bits, offset_from: None, ..whole }
    }

    /// Difference.
    #[track_caller]
    #[must_use]
    pub fn minus(self, other: Self) -> Self {
        let (min, max) = (self.min - other.max, self.max - other.min);
        let width = width_for(min, max);
        Self { bits: self.bits(width) - other.bits(width), min, max, offset_from: None }
    }

    /// Sum with a constant.
    #[track_caller]
    #[must_use]
    pub fn offset(self, by: i64) -> Self {
        let (min, max) = (self.min + by, self.max + by);
        let width = width_for(min, max);
        let bits = match by {
            0.. => self.bits(width) + self.constant(width, by),
            _ => self.bits(width) - self.constant(width, -by),
        };
        Self { bits, min, max, offset_from: Some((self.bits, by)) }
    }

    /// A constant minus this.
    #[track_caller]
    #[must_use]
    pub fn subtracted_from(self, from: i64) -> Self {
        let (min, max) = (from - self.max, from - self.min);
        let (bits, by) = self.offset_from.unwrap_or((self.bits, 0));
        // The value that it is an offset of may be wider than the result.
        let width = width_for(min, max);
        let subtrahend = Self { bits, ..self }.bits(width);
        Self { bits: self.constant(width, from - by) - subtrahend, min, max, offset_from: None }
    }

    /// Half, rounded down.
    #[must_use]
    pub fn half(self) -> Self {
        Self { bits: self.bits.drop_low(1), min: self.min >> 1, max: self.max >> 1, offset_from: None }
    }

    /// Twice.
    #[must_use]
    pub fn twice(self) -> Self {
        Self { bits: self.bits.append_zeros(1), min: 2 * self.min, max: 2 * self.max, offset_from: None }
    }

    /// This where `condition` (1 bit) is set, else zero.
    #[track_caller]
    #[must_use]
    pub fn gate(self, condition: Signal<'g>) -> Self {
        Self { bits: self.bits.gate(condition), min: self.min.min(0), max: self.max.max(0), offset_from: None }
    }

    /// One more where `bit` is set.
    #[track_caller]
    #[must_use]
    pub fn plus_bit(self, bit: Signal<'g>) -> Self {
        self.plus(Self { bits: bit.extend(2), min: 0, max: 1, offset_from: None })
    }

    /// One bit: below zero.
    #[track_caller]
    pub fn is_negative(self) -> Signal<'g> {
        if self.min >= 0 { self.bits.graph().constant(1, 0) } else { self.bits.msb() }
    }

    /// One bit: at least `bound`.
    #[track_caller]
    pub fn at_least(self, bound: i64) -> Signal<'g> {
        match (self.max < bound, self.min >= bound) {
            (true, _) => self.bits.graph().constant(1, 0),
            (_, true) => self.bits.graph().constant(1, 1),
            _ if bound > 0 => !self.is_negative() & self.magnitude_at_least(bound as u64),
            _ => !self.offset(-bound).is_negative(),
        }
    }

    /// The comparison for a bound above zero and a value that is not negative. A power of two and one less need no
    /// subtraction.
    fn magnitude_at_least(self, bound: u64) -> Signal<'g> {
        let low = bound.trailing_ones();
        if bound.is_power_of_two() {
            self.bits.drop_low(bound.trailing_zeros()).any()
        } else if bound >> low == 0 {
            self.bits.drop_low(low).any() | self.bits.low(low).all()
        } else {
            !self.bits.less_than(self.constant(self.bits.width(), bound as i64))
        }
    }

    /// One bit: equal to `value`.
    #[track_caller]
    pub fn is(self, value: i64) -> Signal<'g> {
        self.bits.equals(self.constant(self.bits.width(), value))
    }
}
