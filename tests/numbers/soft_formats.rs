//! `Soft` against an independent soft-float library: every pair of words of an 8-bit format, and random words of
//! others.

use crate::support::Words;
use contact_afu::number::{Format, Number, Rounding, Soft, Subnormals};
use rustc_apfloat::FloatConvert;
use rustc_apfloat::ieee::{IeeeFloat, Semantics};
use rustc_apfloat::{Float, Round};

/// A format of the other library.
struct Other<const EXPONENT: usize, const FRACTION: usize>;

impl<const EXPONENT: usize, const FRACTION: usize> Semantics for Other<EXPONENT, FRACTION> {
    const BITS: usize = 1 + EXPONENT + FRACTION;
    const EXP_BITS: usize = EXPONENT;
}

type Peer<const EXPONENT: usize, const FRACTION: usize> = IeeeFloat<Other<EXPONENT, FRACTION>>;

fn kept(exponent: usize, fraction: usize) -> Format {
    Format::new(exponent as u32, fraction as u32, Subnormals::Kept).unwrap()
}

/// The other library's word, with our only NaN instead of its NaNs.
fn word<const E: usize, const F: usize>(value: Peer<E, F>) -> u128 {
    if value.is_nan() { kept(E, F).nan_bits() } else { value.to_bits() }
}

fn check_pair<const E: usize, const F: usize>(a: u128, b: u128) {
    let (x, y) = (Soft::from_bits(kept(E, F), a), Soft::from_bits(kept(E, F), b));
    let (p, q) = (Peer::<E, F>::from_bits(a), Peer::<E, F>::from_bits(b));
    assert_eq!((x + y).bits(), word((p + q).value), "{x:?} + {y:?}");
    assert_eq!((x - y).bits(), word((p - q).value), "{x:?} - {y:?}");
    assert_eq!((x * y).bits(), word((p * q).value), "{x:?} * {y:?}");
    assert_eq!((x / y).bits(), word((p / q).value), "{x:?} / {y:?}");
    assert_eq!(x.gt(y), p > q, "{x:?} > {y:?}");
    assert_eq!(x.le(y), p <= q, "{x:?} <= {y:?}");
    assert_eq!(x.root_exceeds(y), x.sqrt().gt(y), "root of {x:?} > {y:?}");
}

/// Like [`check_pair`], but rounded toward zero.
fn check_pair_toward_zero<const E: usize, const F: usize>(a: u128, b: u128) {
    let format = kept(E, F).with_rounding(Rounding::TowardZero);
    let (x, y) = (Soft::from_bits(format, a), Soft::from_bits(format, b));
    let (p, q) = (Peer::<E, F>::from_bits(a), Peer::<E, F>::from_bits(b));
    // The sum of opposite numbers is +0 in both libraries, also when rounding toward zero.
    assert_eq!((x + y).bits(), word(p.add_r(q, Round::TowardZero).value), "{x:?} + {y:?}");
    assert_eq!((x - y).bits(), word(p.sub_r(q, Round::TowardZero).value), "{x:?} - {y:?}");
    assert_eq!((x * y).bits(), word(p.mul_r(q, Round::TowardZero).value), "{x:?} * {y:?}");
    assert_eq!((x / y).bits(), word(p.div_r(q, Round::TowardZero).value), "{x:?} / {y:?}");
    assert_eq!(x.root_exceeds(y), x.sqrt().gt(y), "root of {x:?} > {y:?}");
    // The root is the largest number whose square is not larger than the operand. Binary64 holds the squares exactly.
    let (root, value) = (x.sqrt(), x.to_f64());
    if F <= 25 && E <= 10 && value > 0.0 && value.is_finite() {
        let next = Soft::from_bits(format, root.bits() + 1).to_f64();
        assert!(root.to_f64().powi(2) <= value && value < next * next, "root of {x:?}: {root:?}");
    }
}

fn check_conversion<const E: usize, const F: usize, const E2: usize, const F2: usize>(a: u128) {
    let ours = Soft::from_bits(kept(E, F), a).to(kept(E2, F2));
    let converted = <Peer<E, F> as FloatConvert<Peer<E2, F2>>>::convert(Peer::<E, F>::from_bits(a), &mut false);
    // A conversion within one format does not change the word, NaN included.
    let expected = if (E, F) == (E2, F2) { a } else { word(converted.value) };
    assert_eq!(ours.bits(), expected, "{a:#x} from e{E}f{F} to e{E2}f{F2}");
}

fn check_random<const E: usize, const F: usize>(count: u64) {
    crate::support::halves(count, |part| {
        let mut words = Words::new(E as u32, F as u32, part.start);
        for _ in part {
            let (a, b) = words.two();
            check_pair::<E, F>(a, b);
            check_pair_toward_zero::<E, F>(a, b);
        }
    });
}

#[test]
fn every_pair_of_an_8_bit_format() {
    for a in 0..256 {
        for b in 0..256 {
            check_pair::<5, 2>(a, b);
            check_pair_toward_zero::<5, 2>(a, b);
        }
    }
}

#[test]
fn random_pairs_of_other_formats() {
    check_random::<5, 10>(200_000);
    check_random::<5, 23>(200_000);
    check_random::<8, 7>(200_000);
    check_random::<8, 23>(200_000);
    check_random::<10, 23>(200_000);
    check_random::<11, 52>(200_000);
    check_random::<15, 30>(200_000);
    check_random::<15, 52>(200_000);
}

#[test]
fn conversions() {
    for a in 0..256 {
        check_conversion::<5, 2, 5, 2>(a);
        check_conversion::<5, 2, 8, 23>(a);
        check_conversion::<5, 2, 6, 2>(a);
    }
    for a in 0..1 << 16 {
        check_conversion::<5, 10, 5, 2>(a);
        check_conversion::<8, 7, 5, 2>(a);
        check_conversion::<8, 7, 5, 10>(a);
        check_conversion::<5, 10, 15, 52>(a);
    }
    let mut binary32 = Words::new(8, 23, 1);
    let mut wide = Words::new(10, 23, 2);
    let mut largest = Words::new(15, 52, 3);
    for _ in 0..1_000_000 {
        check_conversion::<8, 23, 10, 23>(binary32.one());
        check_conversion::<10, 23, 8, 23>(wide.one());
        check_conversion::<15, 52, 11, 52>(largest.one());
    }
}

#[test]
fn binary32_survives_the_wide_format() {
    let mut words = Words::new(8, 23, 4);
    for _ in 0..1_000_000 {
        let there = Soft::from_bits(Format::BINARY32, words.one());
        let back = there.to(Format::WIDE).to(Format::BINARY32);
        assert!(back == there || back.is_nan() && there.is_nan(), "{there:?} came back as {back:?}");
    }
}

/// The root of an 8-bit word, computed through a binary64 root: double rounding is harmless here, because 53 ≥ 2·3 + 2.
#[test]
fn every_root_and_reciprocal_of_an_8_bit_format() {
    let format = kept(5, 2);
    for a in 0..256 {
        let x = Soft::from_bits(format, a);
        let root = Peer::<11, 52>::from_bits(x.to_f64().sqrt().to_bits().into());
        let root = <Peer<11, 52> as FloatConvert<Peer<5, 2>>>::convert(root, &mut false);
        assert_eq!(x.sqrt().bits(), word(root.value), "root of {x:?}");
        let one = x.constant(1.0);
        assert_eq!(x.recip().bits(), (one / x).bits(), "1 / {x:?}");
    }
}

/// The flushing twin of an 8-bit format, computed through a format with more exponents. Results below the smallest
/// normal number, after rounding, are zeros of the same sign; and so are such operands.
#[test]
fn every_pair_of_a_flushing_8_bit_format() {
    let format = Format::new(5, 2, Subnormals::Flushed).unwrap();
    let wider = kept(8, 2);
    let flush = |x: Soft| {
        if x.to_f64().abs() < 2_f64.powi(-14) { x.constant(0.0 * x.to_f64().signum()) } else { x }
    };
    let read = |bits| flush(Soft::from_bits(kept(5, 2), bits).to(wider));
    let narrow = |x: Soft| flush(x).to(kept(5, 2)).bits();
    for a in 0..256 {
        let (x, p) = (Soft::from_bits(format, a), read(a));
        assert_eq!(x.sqrt().bits(), narrow(p.sqrt()), "root of {x:?}");
        assert_eq!(x.recip().bits(), narrow(p.recip()), "1 / {x:?}");
        for b in 0..256 {
            let (y, q) = (Soft::from_bits(format, b), read(b));
            assert_eq!((x + y).bits(), narrow(p + q), "{x:?} + {y:?}");
            assert_eq!((x - y).bits(), narrow(p - q), "{x:?} - {y:?}");
            assert_eq!((x * y).bits(), narrow(p * q), "{x:?} * {y:?}");
            assert_eq!((x / y).bits(), narrow(p / q), "{x:?} / {y:?}");
            assert_eq!(x.gt(y), p.gt(q), "{x:?} > {y:?}");
            assert_eq!(x.le(y), p.le(q), "{x:?} <= {y:?}");
            assert_eq!(x.root_exceeds(y), x.sqrt().gt(y), "root of {x:?} > {y:?}");
        }
    }
}

#[test]
#[should_panic(expected = "mixes the formats e5f2 and e8f23")]
fn mixed_formats_are_refused_by_name() {
    let _ = Soft::from_bits(kept(5, 2), 1) + Soft::from_f32(1.0);
}
