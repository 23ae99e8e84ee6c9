//! The fields of an operand: sign, exponent, significand and the class of its value.

use super::{Signed, leading_zeros, shift_left};
use crate::hdl::Signal;
use crate::operator::Domain;

/// The fields of a floating-point word, with names that begin with the operand's.
#[derive(Clone, Copy)]
pub struct Operand<'g> {
    prefix: &'static str,
    domain: Domain,
    /// The sign bit.
    pub sign: Signal<'g>,
    /// The biased exponent field.
    pub exponent: Signal<'g>,
    /// The fraction field.
    pub fraction: Signal<'g>,
    /// The leading bit of the significand: clear for zeros and subnormals.
    pub hidden: Signal<'g>,
}

impl<'g> Operand<'g> {
    /// Takes `word` apart.
    #[track_caller]
    pub fn unpack(word: Signal<'g>, domain: Domain, prefix: &'static str) -> Self {
        let fraction_bits = domain.fraction_bits();
        let exponent = word.slice(fraction_bits, domain.exponent_bits()).named(&format!("{prefix}_exponent"));
        Self {
            prefix,
            domain,
            sign: word.msb().named(&format!("{prefix}_sign")),
            exponent,
            fraction: word.low(fraction_bits).named(&format!("{prefix}_fraction")),
            hidden: exponent.any().named(&format!("{prefix}_hidden")),
        }
    }

    /// The prefix of the names of its fields.
    pub fn prefix(&self) -> &'static str {
        self.prefix
    }

    fn name(&self, signal: Signal<'g>, what: &str) -> Signal<'g> {
        signal.named(&format!("{}_{what}", self.prefix))
    }

    /// Exponent and fraction together, in which larger magnitudes are larger integers.
    #[track_caller]
    pub fn magnitude(&self) -> Signal<'g> {
        self.name(self.exponent.concat(self.fraction), "magnitude")
    }

    /// One bit: reads as zero, as subnormals do if they are flushed.
    #[track_caller]
    pub fn is_zero(&self) -> Signal<'g> {
        let zero = if self.domain.keeps_subnormals() { !self.hidden & self.fraction.is_zero() } else { !self.hidden };
        self.name(zero, "is_zero")
    }

    /// One bit: an infinity.
    #[track_caller]
    pub fn is_infinity(&self) -> Signal<'g> {
        self.name(self.is_special() & self.fraction.is_zero(), "is_infinity")
    }

    /// One bit: a NaN.
    #[track_caller]
    pub fn is_nan(&self) -> Signal<'g> {
        self.name(self.is_special() & self.fraction.any(), "is_nan")
    }

    /// One bit: an infinity or a NaN.
    #[track_caller]
    pub fn is_special(&self) -> Signal<'g> {
        if self.domain.is_finite() {
            return self.sign.same(0);
        }
        self.name(self.exponent.all(), "is_special")
    }

    /// Hidden bit and fraction. Where subnormals are flushed the hidden bit is always set, so that the significand
    /// of what reads as zero is of no use.
    #[track_caller]
    pub fn significand(&self) -> Signal<'g> {
        let kept = self.domain.keeps_subnormals();
        let leading = if kept { self.hidden } else { self.hidden.same(1) };
        self.name(leading.concat(self.fraction), "significand")
    }

    /// As [`Operand::significand`]; if operands are zero or normal, the significand of zero is zero.
    #[track_caller]
    pub fn true_significand(&self) -> Signal<'g> {
        if self.domain.is_normal() {
            return self.name(self.hidden.concat(self.fraction), "significand");
        }
        self.significand()
    }

    /// The biased exponent that goes with [`Operand::significand`]: that of subnormals is 1.
    #[track_caller]
    pub fn effective_exponent(&self) -> Signal<'g> {
        if !self.domain.keeps_subnormals() {
            return self.exponent;
        }
        let low = self.name(self.exponent.bit(0) | !self.hidden, "effective_exponent_0");
        self.name(self.exponent.drop_low(1).concat(low), "effective_exponent")
    }

    /// Biased exponent and significand with the leading bit set, as if the exponent had no lower limit. Only for values
    /// that are neither zero nor special.
    #[track_caller]
    pub fn normalised(&self) -> (Signed<'g>, Signal<'g>) {
        self.normalised_for(self.domain.bias())
    }

    /// The same with the exponent for another bias. If subnormals count, zero has the smallest exponent and the
    /// significand zero.
    #[track_caller]
    pub fn normalised_for(&self, bias: i32) -> (Signed<'g>, Signal<'g>) {
        let largest = i64::from(self.domain.special_exponent()) - 1;
        // Added here, where there is time, and not after the count of zeros.
        let exponent = Signed::unsigned(self.effective_exponent(), 1, largest);
        let exponent = match i64::from(bias - self.domain.bias()) {
            0 => exponent,
            by => exponent.offset(by).named(&format!("{}_rebiased_exponent", self.prefix)),
        };
        let unshifted = self.significand();
        if !self.domain.keeps_subnormals() {
            return (exponent, unshifted);
        }
        let (zeros, _) = leading_zeros(unshifted, &format!("{}_significand", self.prefix));
        let zeros = self.name(zeros, "leading_zeros");
        let significand = self.name(shift_left(unshifted, zeros, &format!("{}_normalise", self.prefix)), "normalised");
        let most = i64::from(self.domain.fraction_bits());
        let exponent = exponent
            .minus(Signed::unsigned(zeros, 0, most))
            .with_range(exponent.min() - most, exponent.max())
            .named(&format!("{}_normalised_exponent", self.prefix));
        (exponent, significand)
    }
}
