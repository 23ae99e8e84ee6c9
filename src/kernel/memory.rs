//! Record formats that are shorter than binary32: pairs are rounded to them when they are written, and results are
//! widened, which is exact.

use crate::number::{Format, Number, Rounding, Soft};
use crate::query::PairRecord;

/// True if records in this format are the binary32 words themselves.
#[inline]
const fn is_binary32(record: Format) -> bool {
    record.exponent_bits() == 8 && record.fraction_bits() == 23
}

/// The word of `record` for a binary32 word: rounded to the nearest, ties to even, whatever the format's own rounding
/// (IEEE 754-2019, clause 5.4.2). Overflow gives an infinity; a NaN becomes the canonical one. Words of binary32 stay
/// as they are.
pub fn narrow(word: u32, record: Format) -> u32 {
    if is_binary32(record) {
        return word;
    }
    Soft::from_bits(Format::BINARY32, word.into()).to(record.with_rounding(Rounding::Nearest)).bits() as u32
}

/// The binary32 word of a word of `record`, which has no more exponent or fraction bits: the same number. The mapping
/// is one-to-one: a NaN keeps its fraction in the leading bits.
pub fn widen(word: u32, record: Format) -> u32 {
    if is_binary32(record) {
        return word;
    }
    let bits = u128::from(word);
    if bits & record.infinity_bits() != record.infinity_bits() {
        return Soft::from_bits(record, bits).to(Format::BINARY32).bits() as u32;
    }
    let sign = u32::from(bits & record.sign_mask() != 0) << 31;
    let fraction = (bits & record.fraction_mask()) as u32;
    sign | 0x7F80_0000 | fraction << (23 - record.fraction_bits())
}

impl PairRecord {
    /// The pair as records in `record` hold it: each word [`narrow`]ed and [`widen`]ed again. A finite coordinate can
    /// become infinite, which makes the pair invalid; a negative radius can become −0, which is valid.
    #[must_use]
    pub fn rounded(self, record: Format) -> Self {
        if is_binary32(record) { self } else { Self(self.0.map(|word| widen(narrow(word, record), record))) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::query::Query;

    #[test]
    fn every_word_of_16_bits_comes_back_as_it_was() {
        for record in [Format::HALF, Format::BFLOAT] {
            let mut seen = std::collections::HashSet::new();
            for word in 0..=0xFFFF {
                let wide = widen(word, record);
                assert!(seen.insert(wide), "{word:#x} of {record}");
                assert_eq!(
                    f32::from_bits(wide).is_finite(),
                    u128::from(word) & !record.sign_mask() < record.infinity_bits()
                );
                if !f32::from_bits(wide).is_nan() {
                    assert_eq!(narrow(wide, record), word, "{record}");
                }
            }
        }
        assert_eq!(widen(0x7E00, Format::HALF), 0x7FC0_0000, "the canonical NaN is the canonical one");
    }

    #[test]
    fn pairs_are_rounded_to_the_nearest_even() {
        let to = |record, value: f32| f32::from_bits(widen(narrow(value.to_bits(), record), record));
        // For f16: a tie down and a tie up, the largest number, an overflow, the smallest number, half of it.
        for (value, expected) in [
            (1.0 + 1.0 / 2048.0, 1.0),
            (1.0 + 3.0 / 2048.0, 1.0 + 2.0 / 1024.0),
            (65_519.996, 65_504.0),
            (65_520.0, f32::INFINITY),
            (-1e9, f32::NEG_INFINITY),
            (2.0_f32.powi(-24), 2.0_f32.powi(-24)),
            (2.0_f32.powi(-25), 0.0),
            (-1e-45, -0.0),
        ] {
            assert_eq!(to(Format::HALF, value).to_bits(), expected.to_bits(), "{value}");
        }
        // bfloat16 is the upper half of binary32: its rounding is an addition.
        for word in (0..0x7F7F_0000_u32).step_by(65_521) {
            let expected = (word + 0x7FFF + (word >> 16 & 1)) >> 16;
            assert_eq!(narrow(word, Format::BFLOAT), expected);
        }
        // The host rounds to the nearest, whatever the rounding of the arithmetic.
        let toward_zero = Format::HALF.with_rounding(Rounding::TowardZero);
        assert_eq!(to(toward_zero, 1.0 + 3.0 / 2048.0), 1.0 + 2.0 / 1024.0);
    }

    #[test]
    fn a_pair_becomes_invalid_by_what_its_record_cannot_hold() {
        let broken = |pair: PairRecord| pair.broken(Query::SphereSphere).map(|input| input.name);
        let pair = PairRecord::from_spheres([1.0, 70_000.0, 0.0, -1e-9], [0.0, 0.0, 0.0, 0.5]);
        assert_eq!(broken(pair), Some("r1"));
        assert_eq!(broken(pair.rounded(Format::HALF)), Some("y1"), "and the radius is -0 there");
        assert_eq!(broken(pair.rounded(Format::BFLOAT)), Some("r1"));
        assert_eq!(pair.rounded(Format::BINARY32), pair);
    }
}
