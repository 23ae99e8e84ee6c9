//! The comparisons of a box with 16 boxes and of a sphere with 16 spheres, for the instruction sets of a processor.

use super::rows::{Boxes, ROW, Row};
use super::{Bounds, Sphere};

/// Compares a box or a sphere with 16 columns, and returns one bit for each.
pub(super) trait Lanes: Copy {
    /// The columns whose box meets `bounds`.
    fn meeting(self, boxes: &Boxes, bounds: &Bounds) -> u16;

    /// The columns whose sphere may touch `sphere`, in binary32 and with a margin: see [`may_touch`].
    fn near(self, row: &Row, sphere: &Sphere) -> u16;
}

/// Rounding errors of a squared distance and of a squared sum of radii, many times over: relative, and absolute for
/// squares that underflow.
const MARGIN: f32 = 1.0 + 1.0 / (1 << 18) as f32;
const LEAST: f32 = f32::MIN_POSITIVE;

/// False only if no arithmetic with binary32's precision or more calls these spheres a contact.
///
/// Differences and sums are within 2^-23 of the true ones, rounded toward zero or to nearest, so squares are within
/// some 2^-20. A squared distance that overflows is above every squared sum that does not. A NaN compares as touching.
#[inline(always)]
fn may_touch(first: [f32; 4], second: [f32; 4]) -> bool {
    let [x, y, z] = [0, 1, 2].map(|axis| first[axis] - second[axis]);
    let sum = first[3] + second[3];
    let is_apart = (x * x + y * y) + z * z > sum * sum * MARGIN + LEAST;
    !is_apart
}

#[inline(always)]
fn mask(of: impl Fn(usize) -> bool) -> u16 {
    (0..ROW).fold(0, |mask, column| mask | u16::from(of(column)) << column)
}

/// Any processor.
#[derive(Clone, Copy)]
pub(super) struct Portable;

impl Lanes for Portable {
    #[inline(always)]
    fn meeting(self, boxes: &Boxes, bounds: &Bounds) -> u16 {
        let mut meets = [true; ROW];
        for axis in 0..3 {
            for (column, meets) in meets.iter_mut().enumerate() {
                *meets &= boxes.low[axis][column] <= bounds.high[axis];
                *meets &= bounds.low[axis] <= boxes.high[axis][column];
            }
        }
        mask(|column| meets[column])
    }

    #[inline(always)]
    fn near(self, row: &Row, sphere: &Sphere) -> u16 {
        let sphere = sphere.values();
        mask(|column| may_touch(row.values.map(|value| value[column]), sphere))
    }
}

#[cfg(target_arch = "x86_64")]
pub(super) use x86::{Avx2, Avx512};

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use super::{LEAST, Lanes, MARGIN};
    use crate::spheres::rows::{Boxes, Row};
    use crate::spheres::{Bounds, Sphere};

    /// A processor with an instruction set, and its comparisons.
    macro_rules! processor {
        ($(#[$about:meta])* $name:ident, $set:tt, $meeting:ident, $near:ident) => {
            $(#[$about])*
            #[derive(Clone, Copy)]
            pub(crate) struct $name(());

            impl $name {
                /// `None` if the processor lacks the instruction set.
                pub(crate) fn new() -> Option<Self> {
                    is_x86_feature_detected!($set).then_some(Self(()))
                }
            }

            impl Lanes for $name {
                #[inline(always)]
                fn meeting(self, boxes: &Boxes, bounds: &Bounds) -> u16 {
                    // SAFETY: `new` found the instruction set.
                    unsafe { $meeting(boxes, bounds) }
                }

                #[inline(always)]
                fn near(self, row: &Row, sphere: &Sphere) -> u16 {
                    // SAFETY: `new` found the instruction set.
                    unsafe { $near(row, sphere) }
                }
            }
        };
    }

    processor! {
        /// A processor with AVX2: 16 columns are two registers per axis or word.
        Avx2, "avx2", meeting_avx2, near_avx2
    }
    processor! {
        /// A processor with AVX-512: 16 columns are one register per axis or word.
        Avx512, "avx512f", meeting_avx512, near_avx512
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn meeting_avx2(boxes: &Boxes, bounds: &Bounds) -> u16 {
        let apart = |half: usize| {
            let mut apart = _mm256_setzero_si256();
            for axis in 0..3 {
                // SAFETY: each array has 16 numbers, of which this loads the lower or the upper 8.
                let [low, high] = [&boxes.low[axis], &boxes.high[axis]]
                    .map(|edges| unsafe { _mm256_loadu_si256(edges.as_ptr().add(8 * half).cast()) });
                let is_above = _mm256_cmpgt_epi32(low, _mm256_set1_epi32(bounds.high[axis]));
                let is_below = _mm256_cmpgt_epi32(_mm256_set1_epi32(bounds.low[axis]), high);
                apart = _mm256_or_si256(apart, _mm256_or_si256(is_above, is_below));
            }
            _mm256_movemask_ps(_mm256_castsi256_ps(apart)) as u16
        };
        !(apart(0) | apart(1) << 8)
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn near_avx2(row: &Row, sphere: &Sphere) -> u16 {
        let values = sphere.values();
        let apart = |half: usize| {
            let [x, y, z, r] = row.values.each_ref().map(|column| {
                // SAFETY: each array has 16 numbers, of which this loads the lower or the upper 8.
                unsafe { _mm256_loadu_ps(column.as_ptr().add(8 * half)) }
            });
            let apart = |column, value| _mm256_sub_ps(column, _mm256_set1_ps(value));
            let square = |value| _mm256_mul_ps(value, value);
            let sum = square(_mm256_add_ps(r, _mm256_set1_ps(values[3])));
            let [x, y, z] = [(x, values[0]), (y, values[1]), (z, values[2])].map(|(c, v)| square(apart(c, v)));
            let distance = _mm256_add_ps(_mm256_add_ps(x, y), z);
            let bound = _mm256_add_ps(_mm256_mul_ps(sum, _mm256_set1_ps(MARGIN)), _mm256_set1_ps(LEAST));
            _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(distance, bound)) as u16
        };
        !(apart(0) | apart(1) << 8)
    }

    #[inline]
    #[target_feature(enable = "avx512f")]
    fn meeting_avx512(boxes: &Boxes, bounds: &Bounds) -> u16 {
        let mut meets = u16::MAX;
        for axis in 0..3 {
            // SAFETY: each array has 16 numbers.
            let [low, high] =
                [&boxes.low[axis], &boxes.high[axis]].map(|edges| unsafe { _mm512_loadu_epi32(edges.as_ptr()) });
            meets &= _mm512_cmple_epi32_mask(low, _mm512_set1_epi32(bounds.high[axis]));
            meets &= _mm512_cmple_epi32_mask(_mm512_set1_epi32(bounds.low[axis]), high);
        }
        meets
    }

    #[inline]
    #[target_feature(enable = "avx512f")]
    fn near_avx512(row: &Row, sphere: &Sphere) -> u16 {
        let values = sphere.values();
        // SAFETY: each array has 16 numbers.
        let [x, y, z, r] = row.values.each_ref().map(|column| unsafe { _mm512_loadu_ps(column.as_ptr()) });
        let apart = |column, value| _mm512_sub_ps(column, _mm512_set1_ps(value));
        let square = |value| _mm512_mul_ps(value, value);
        let sum = square(_mm512_add_ps(r, _mm512_set1_ps(values[3])));
        let [x, y, z] = [(x, values[0]), (y, values[1]), (z, values[2])].map(|(c, v)| square(apart(c, v)));
        let distance = _mm512_add_ps(_mm512_add_ps(x, y), z);
        let bound = _mm512_add_ps(_mm512_mul_ps(sum, _mm512_set1_ps(MARGIN)), _mm512_set1_ps(LEAST));
        !_mm512_cmp_ps_mask::<_CMP_GT_OQ>(distance, bound)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Reference;
    use crate::number::Format;
    use crate::pairs::Set;
    use crate::query::{Fields, Query};

    /// On random, hard and nearly tangent pairs no contact of any arithmetic is put aside, and many others are.
    #[test]
    fn no_contact_is_called_apart() {
        let pairs = [Set::Random(40_000).pairs(5), Set::Hard(40_000).pairs(5)].concat();
        let references = ["e10f23z", "e10f23zt", "e11f52"]
            .map(|format| Reference::new(format.parse().expect("a format"), Fields::HIT))
            .into_iter()
            .chain([Reference::exact(Fields::HIT), Reference::new(Format::WIDE, Fields::HIT)]);
        for reference in references {
            let (contacts, _) = reference.settled(&pairs);
            let mut apart = 0;
            for (pair, contact) in pairs.iter().zip(contacts).filter(|(pair, _)| pair.is_valid(Query::SphereSphere)) {
                let [x1, y1, z1, r1, x2, y2, z2, r2] = pair.values();
                let may = may_touch([x1, y1, z1, r1], [x2, y2, z2, r2]);
                assert!(may || !contact.is_contact(), "{pair:?}");
                apart += u32::from(!may);
            }
            assert!(apart > 8_000, "{apart}");
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[test]
    fn every_instruction_set_compares_alike() {
        Avx2::new().into_iter().for_each(compares_as_portable);
        Avx512::new().into_iter().for_each(compares_as_portable);
    }

    #[cfg(target_arch = "x86_64")]
    fn compares_as_portable(wide: impl Lanes) {
        use crate::kernel::Arithmetic;
        use crate::spheres::{BoundsRule, Rows};

        let rule = BoundsRule::new(Arithmetic::Rounded(Format::WIDE), 20).expect("a rule");
        let pairs = Set::Random(800).pairs(3);
        let halves = |pair: &crate::query::PairRecord| {
            let [a, b, c, d, e, f, g, h] = pair.0;
            [Sphere([a, b, c, d]), Sphere([e, f, g, h])]
        };
        let spheres: Vec<_> = pairs.iter().flat_map(halves).collect();
        let rows = Rows::new(rule, &spheres);
        let mut bits = [0; 2];
        for row in &rows.rows {
            for sphere in &spheres {
                let bounds = rule.bounds(*sphere);
                let [meeting, near] = [wide.meeting(&row.boxes, &bounds), wide.near(row, sphere)];
                assert_eq!(meeting, Portable.meeting(&row.boxes, &bounds));
                assert_eq!(near, Portable.near(row, sphere), "{sphere:?}");
                bits[0] += meeting.count_ones();
                bits[1] += near.count_ones();
            }
        }
        assert!(bits[0] > 1000 && bits[1] > 1000, "{bits:?}");
    }
}
