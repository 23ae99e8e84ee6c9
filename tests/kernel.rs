//! The reference kernel: against Algorithm 1 written out plainly, and its readings against each other.

mod support;

use contact_afu::kernel::{ContactRecord, Fields, Flow, PairRecord, Reference, contact};
use contact_afu::number::{Format, Number};
use contact_afu::pairs::Set;
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Sub, SubAssign};
use support::{Words, halves};

/// Algorithm 1 as the Open Dynamics Engine has it, branches and all.
fn algorithm_1(pair: &PairRecord) -> ContactRecord {
    let [x1, y1, z1, r1, x2, y2, z2, r2] = pair.values();
    let finite = pair.values().iter().all(|v| v.is_finite());
    if !finite || r1 < 0.0 || r2 < 0.0 {
        return ContactRecord([0, 0, 0, 0, 0, 0, 0, 8]);
    }
    let (dx, dy, dz) = (x1 - x2, y1 - y2, z1 - z2);
    let d = ((dx * dx + dy * dy) + dz * dz).sqrt();
    if d > r1 + r2 {
        return ContactRecord([0, 0, 0, 0, 0, 0, 0, 2]);
    }
    let (numbers, flags) = if d <= 0.0 {
        ([x1, y1, z1, 1.0, 0.0, 0.0, r1 + r2], 5)
    } else {
        let inverse = 1.0 / d;
        let (nx, ny, nz) = (dx * inverse, dy * inverse, dz * inverse);
        let k = 0.5 * ((r2 - r1) - d);
        ([x1 + nx * k, y1 + ny * k, z1 + nz * k, nx, ny, nz, (r1 + r2) - d], 7)
    };
    let mut record = [flags; 8];
    for (word, number) in record.iter_mut().zip(numbers) {
        *word = if number.is_nan() { 0x7FC0_0000 } else { number.to_bits() };
    }
    ContactRecord(record)
}

/// Random pairs, at the corners more often than not.
fn for_random_pairs(count: u64, check: impl Fn(PairRecord) + Sync) {
    halves(count, |part| {
        let mut words = Words::new(8, 23, part.start + 7);
        for i in part {
            let mut pair = [0; 4].map(|_| words.two());
            if i % 4 != 0 {
                // Finite coordinates, radii that are not negative.
                for (first, second) in &mut pair {
                    *first &= !(1 << 30);
                    *second &= !(1 << 30);
                }
                pair[3].0 &= 0x7FFF_FFFF;
                pair[3].1 &= 0x7FFF_FFFF;
            }
            if i % 5 == 0 {
                // One scale for everything: contacts that are neither certain nor far.
                let scale = words.one() as u32 & 0x3F80_0000;
                for (first, second) in &mut pair {
                    *first = *first & 0x80FF_FFFF | u128::from(scale);
                    *second = *second & 0x80FF_FFFF | u128::from(scale);
                }
            }
            let [(x1, x2), (y1, y2), (z1, z2), (r1, r2)] = pair.map(|(a, b)| (a as u32, b as u32));
            check(PairRecord([x1, y1, z1, r1, x2, y2, z2, r2]));
        }
    });
}

#[test]
fn a_real_contact() {
    // Touching exactly, along x.
    let pair = PairRecord::from_spheres([0.0, 0.0, 0.0, 0.5], [1.0, 0.0, 0.0, 0.5]);
    let contact = Reference::new(Format::BINARY32, Fields::ALL).run(&pair);
    assert_eq!(contact.flow(), Some(Flow::Real));
    assert_eq!((contact.position(), contact.normal(), contact.depth()), ([0.5, 0.0, 0.0], [-1.0, 0.0, 0.0], 0.0));
}

#[test]
fn a_grazing_contact() {
    let pair = PairRecord::from_spheres([1.0, 2.0, 3.0, 0.5], [1.0, 2.0, 3.0, 0.25]);
    for format in [Format::BINARY32, Format::WIDE] {
        let contact = Reference::new(format, Fields::ALL).run(&pair);
        assert_eq!(contact.flow(), Some(Flow::Grazing));
        assert_eq!((contact.position(), contact.normal(), contact.depth()), ([1.0, 2.0, 3.0], [1.0, 0.0, 0.0], 0.75));
    }
}

#[test]
fn the_reference_is_algorithm_1() {
    let reference = Reference::new(Format::BINARY32, Fields::ALL);
    for_random_pairs(2_000_000, |pair| {
        assert_eq!(reference.run(&pair), algorithm_1(&pair), "{pair:x?}");
    });
}

#[test]
fn soft_binary32_is_f32() {
    for fields in [Fields::ALL, Fields::HIT, Fields { normal: false, ..Fields::ALL }] {
        let reference = Reference::new(Format::BINARY32, fields);
        for_random_pairs(1_000_000, |pair| {
            assert_eq!(reference.run_soft(&pair), reference.run(&pair), "{pair:x?}");
        });
    }
}

/// A field asked for has the same bits whatever else is asked for, and so has the decision.
#[test]
fn fields_do_not_change_each_other() {
    for format in ["paper", "wide", "half", "e6f9z"].map(|name| name.parse::<Format>().unwrap()) {
        let whole = Reference::new(format, Fields::ALL);
        for_random_pairs(400_000, |pair| {
            let expected = whole.run(&pair);
            let contact = Reference::new(format, Fields::HIT).run(&pair);
            assert_eq!(contact.0, [0, 0, 0, 0, 0, 0, 0, expected.flags()], "{format}: {pair:x?}");
            let fields = Fields { normal: false, ..Fields::ALL };
            let mut contact = Reference::new(format, fields).run(&pair);
            contact.0[3..6].copy_from_slice(&expected.0[3..6]);
            assert_eq!(contact, expected, "{format}: {pair:x?}");
        });
    }
}

thread_local! {
    /// Whether an operation of [`Watched`] overflowed or underflowed.
    static RAISED: Cell<bool> = const { Cell::new(false) };
}

/// An `f32` that notices IEEE overflow (a finite operation gives infinity) and underflow (tiny and inexact).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Watched(f32);

impl Watched {
    /// `result`, of which `exact` says whether it is what the operation is without rounding.
    fn watch(result: f32, finite: bool, exact: bool) -> Self {
        let overflow = result.is_infinite() && finite;
        let underflow = result.abs() <= f32::MIN_POSITIVE && !exact;
        RAISED.set(RAISED.get() | overflow | underflow);
        Self(result)
    }
}

macro_rules! watched {
    ($($trait:ident::$method:ident, $assign:ident::$assign_method:ident, $exact:ident;)*) => {$(
        impl $trait for Watched {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                let result = self.0.$method(other.0);
                let exact = $exact(self.0.into(), other.0.into(), result.into());
                Self::watch(result, self.0.is_finite() && other.0.is_finite(), exact)
            }
        }

        impl $assign for Watched {
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
    )*};
}

/// A sum that is tiny is exact.
const fn sum_is_exact(_: f64, _: f64, _: f64) -> bool {
    true
}

/// The product of two binary32 numbers is exact in binary64.
fn product_is_exact(a: f64, b: f64, result: f64) -> bool {
    a * b == result
}

fn quotient_is_exact(a: f64, b: f64, result: f64) -> bool {
    b * result == a
}

watched! {
    Add::add, AddAssign::add_assign, sum_is_exact;
    Sub::sub, SubAssign::sub_assign, sum_is_exact;
    Mul::mul, MulAssign::mul_assign, product_is_exact;
    Div::div, DivAssign::div_assign, quotient_is_exact;
}

impl Number for Watched {
    type Bool = bool;

    fn constant(self, value: f64) -> Self {
        Self(value as f32)
    }

    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    fn recip(self) -> Self {
        if self.0 == 0.0 { Self(f32::INFINITY) } else { Self(1.0) / self }
    }

    fn gt(self, other: Self) -> bool {
        self.0 > other.0
    }

    fn le(self, other: Self) -> bool {
        self.0 <= other.0
    }

    fn root_exceeds(self, bound: Self) -> bool {
        self.0.root_exceeds(bound.0)
    }

    fn select(condition: bool, yes: Self, no: Self) -> Self {
        if condition { yes } else { no }
    }

    fn to(self, _: Format) -> Self {
        self
    }
}

/// Whether the pair's own flow in f32 overflows or underflows.
fn raises(pair: &PairRecord, flow: Flow) -> bool {
    // Only a real contact computes more than the decision does.
    let fields = if flow == Flow::Real { Fields::ALL } else { Fields::HIT };
    RAISED.set(false);
    let spheres = pair.read(|word| Watched(f32::from_bits(word)));
    let _ = contact(spheres, true, Format::BINARY32, Format::BINARY32, fields);
    RAISED.get()
}

/// What the default arithmetic promises.
#[test]
fn wide_is_binary32_wherever_that_neither_overflows_nor_underflows() {
    let (paper, wide) = (Reference::new(Format::BINARY32, Fields::ALL), Reference::new(Format::WIDE, Fields::ALL));
    let mut flows = [0; 4];
    let (mut raised, mut different) = (0, 0);
    for pair in Set::Random(1_000_000).pairs(5) {
        let (expected, found) = (paper.run(&pair), wide.run(&pair));
        let flow = expected.flow().unwrap();
        if flow != Flow::Invalid && raises(&pair, flow) {
            raised += 1;
            different += u32::from(expected != found);
        } else {
            assert_eq!(found, expected, "{pair:x?}");
            flows[flow as usize] += 1;
        }
    }
    // The test means something: each flow is there, and where f32 fails the two do differ.
    assert!(flows.iter().all(|&count| count > 10_000), "{flows:?}");
    assert!(different > 10_000, "{different} of {raised} differ");
}
