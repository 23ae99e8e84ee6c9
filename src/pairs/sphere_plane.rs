//! Spheres and planes: random pairs that reach every flow, and hard ones.

use super::hard::Category;
use super::source::{LARGEST, Source, UNIT};
use crate::query::{PairRecord, Query};

/// The functions that make random pairs. Function i mod 8 makes pair i.
pub(super) const KINDS: [fn(&mut Source) -> PairRecord; 8] = [
    Source::before_a_plane,
    Source::near_a_plane,
    Source::on_an_axis,
    Source::any_exponents_and_a_plane,
    Source::tiny_and_a_plane,
    Source::huge_and_a_plane,
    Source::any_words,
    Source::invalid_and_a_plane,
];

/// Every hard category. Pair i of `hard:N` belongs to category i mod 12.
pub(super) const CATEGORIES: [Category; 12] = {
    const fn of(number: u64, name: &'static str, about: &'static str, make: fn(&mut Source) -> PairRecord) -> Category {
        Category { query: Query::SpherePlane, name, about, number, make }
    }
    [
        of(0, "ordinary", "coordinates, radius and distance around 1", Source::before_a_plane),
        of(1, "near-tangent", "the depth within a few ulp of what it is made of", Source::near_a_plane),
        of(2, "tangent", "exactly tangent along an axis, or one ulp to a side", Source::on_an_axis),
        of(3, "far", "centre and plane at 1e5 to 1e8, radius about 1", Source::far_with_its_plane),
        of(4, "along", "the centre far along the plane, so that the products cancel", Source::far_along_its_plane),
        of(5, "flat", "a normal with components down to the smallest numbers", Source::before_a_flat_plane),
        of(6, "ratio", "a radius up to 1e7 times smaller than the distance", Source::small_at_a_plane),
        of(7, "subnormal", "subnormal coordinates, radius and distance", Source::tiny_and_a_plane),
        of(8, "underflow", "products that underflow in binary32", Source::underflow_at_a_plane),
        of(9, "largest", "sums that overflow in binary32", Source::huge_and_a_plane),
        of(10, "point", "radii of zero, of either sign, on the plane and beside it", Source::point_at_a_plane),
        of(11, "log-uniform", "every exponent as likely as any other", Source::any_exponents_and_a_plane),
    ]
};

/// The product of a normal and a point in plain binary32, in the kernel's order.
fn along([nx, ny, nz]: [f32; 3], [x, y, z]: [f32; 3]) -> f32 {
    (nx * x + ny * y) + nz * z
}

fn pair([x, y, z]: [f32; 3], r: f32, [nx, ny, nz]: [f32; 3], d: f32) -> PairRecord {
    PairRecord::from_sphere_and_plane([x, y, z, r], [nx, ny, nz, d])
}

impl Source {
    /// A vector of length 1, except for rounding.
    fn unit(&mut self) -> [f32; 3] {
        let v = [(); 3].map(|()| self.signed(UNIT - 6, UNIT));
        let length = ((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]).sqrt();
        v.map(|component| component / length)
    }

    /// A vector along an axis.
    fn axis_vector(&mut self) -> ([f32; 3], usize) {
        let axis = self.below(3) as usize;
        let mut n = [0.0; 3];
        n[axis] = if self.flip() { 1.0 } else { -1.0 };
        (n, axis)
    }

    fn centre(&mut self, low: u32, high: u32) -> [f32; 3] {
        [(); 3].map(|()| self.signed(low, high))
    }

    /// Numbers around 1: contact or not, about equally often.
    fn before_a_plane(&mut self) -> PairRecord {
        let n = self.unit();
        pair(self.centre(UNIT - 4, UNIT), self.positive(UNIT - 2, UNIT), n, self.signed(UNIT - 3, UNIT))
    }

    /// At any scale: the plane's distance within a few ulp of where the sphere touches it.
    fn near_a_plane(&mut self) -> PairRecord {
        let scale = 8 + self.below(LARGEST - 16);
        let (n, c) = (self.unit(), self.centre(scale - 4, scale));
        self.touching(n, c, scale)
    }

    /// A plane that the sphere touches, except for a few ulp of its distance.
    fn touching(&mut self, n: [f32; 3], c: [f32; 3], scale: u32) -> PairRecord {
        let r = self.positive(scale - 5, scale - 1);
        let d = along(n, c) - r;
        let ulps = self.below(9);
        let bits = (d.to_bits() & 0x7FFF_FFFF).saturating_add(ulps).saturating_sub(4);
        pair(c, r, n, f32::from_bits(d.to_bits() & 0x8000_0000 | bits))
    }

    /// Integers times a power of two: tangent, or one ulp of the distance away from it.
    fn on_an_axis(&mut self) -> PairRecord {
        let unit = f32::from_bits((UNIT - 100 + self.below(200)) << 23);
        let (n, axis) = self.axis_vector();
        let c = [(); 3].map(|()| (self.below(1 << 22) as f32 - (1 << 21) as f32) * unit);
        let r = self.below(1 << 21) as f32 * unit;
        let d = n[axis] * c[axis] - r;
        let bits = match self.below(3) {
            0 => d.to_bits().saturating_add(1),
            1 if d != 0.0 => d.to_bits() - 1,
            _ => d.to_bits(),
        };
        pair(c, r, n, f32::from_bits(bits))
    }

    fn far_with_its_plane(&mut self) -> PairRecord {
        let (n, c) = (self.unit(), self.centre(UNIT + 17, UNIT + 26));
        pair(c, self.positive(UNIT - 1, UNIT), n, along(n, c) + self.signed(UNIT - 3, UNIT + 1))
    }

    /// The centre is a multiple of a vector in the plane, plus a small offset.
    fn far_along_its_plane(&mut self) -> PairRecord {
        let (n, far) = (self.unit(), self.positive(UNIT + 8, UNIT + 30));
        let turn = self.below(3) as usize;
        let mut c = [0.0; 3];
        let (i, j) = (turn, (turn + 1) % 3);
        (c[i], c[j]) = (-n[j] * far, n[i] * far);
        let near = self.centre(UNIT - 4, UNIT);
        let c = [0, 1, 2].map(|axis| c[axis] + near[axis]);
        let d = along(n, near) + self.signed(UNIT - 3, UNIT);
        pair(c, self.positive(UNIT - 2, UNIT), n, d)
    }

    /// A normal nearly along an axis: the other components at any scale below it.
    fn before_a_flat_plane(&mut self) -> PairRecord {
        let (mut n, axis) = self.axis_vector();
        for other in [(axis + 1) % 3, (axis + 2) % 3] {
            n[other] = self.signed(0, UNIT - 13);
        }
        let scale = UNIT - 10 + self.below(40);
        let c = self.centre(scale - 4, scale);
        self.touching(n, c, scale)
    }

    fn small_at_a_plane(&mut self) -> PairRecord {
        let (n, c) = (self.unit(), self.centre(UNIT - 2, UNIT + 2));
        let r = self.positive(UNIT - 24, UNIT - 1);
        // From half a radius inside to as much outside, as nearly as binary32 can represent it.
        let reach = self.below(1 << 10) as f32 / 1024.0 + 0.5;
        pair(c, r, n, along(n, c) - r * reach)
    }

    fn tiny_and_a_plane(&mut self) -> PairRecord {
        let n = if self.flip() { self.unit() } else { self.axis_vector().0 };
        let mut made = pair(self.centre(0, 2), self.positive(0, 2), n, self.signed(0, 2));
        for word in [0, 1, 2, 3, 7] {
            match self.below(8) {
                0 => made.0[word] &= 0x8000_0000,
                1 => made.0[word] = made.0[word] & 0x8000_0000 | 1,
                _ => {}
            }
        }
        made
    }

    /// Components and coordinates so small that their products are subnormal or zero.
    fn underflow_at_a_plane(&mut self) -> PairRecord {
        let (mut n, axis) = self.axis_vector();
        for other in [(axis + 1) % 3, (axis + 2) % 3] {
            n[other] = self.signed(2, 60);
        }
        let low = 2 + self.below(60);
        let mut c = self.centre(low, low + 3);
        if self.flip() {
            c[axis] = 0.0;
        }
        pair(c, self.positive(low - 2, low), n, self.signed(low - 2, low + 1))
    }

    /// Numbers next to the largest one.
    fn huge_and_a_plane(&mut self) -> PairRecord {
        let n = self.unit();
        let c = self.centre(LARGEST - 2, LARGEST);
        // On both sides of the plane, but never near it.
        let d = self.signed(LARGEST - 3, LARGEST);
        pair(c, self.positive(LARGEST - 3, LARGEST), n, d)
    }

    fn point_at_a_plane(&mut self) -> PairRecord {
        let (n, c) = if self.flip() {
            (self.axis_vector().0, self.centre(UNIT - 10, UNIT + 10))
        } else {
            (self.unit(), self.centre(UNIT - 3, UNIT))
        };
        let r = if self.flip() { 0.0 } else { -0.0 };
        let d = along(n, c);
        let bits = match self.below(3) {
            0 => d.to_bits().saturating_add(1),
            1 if d != 0.0 => d.to_bits() - 1,
            _ => d.to_bits(),
        };
        pair(c, r, n, f32::from_bits(bits))
    }

    /// Every exponent is equally likely, except for the normal's.
    fn any_exponents_and_a_plane(&mut self) -> PairRecord {
        let n = self.unit();
        pair(self.centre(0, LARGEST), self.positive(0, LARGEST), n, self.signed(0, LARGEST))
    }

    fn invalid_and_a_plane(&mut self) -> PairRecord {
        let made = self.before_a_plane();
        self.spoil(Query::SpherePlane, made)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Set, categories};
    use super::*;
    use crate::kernel::{Reference, Truth};
    use crate::number::Format;
    use crate::query::{Fields, Flow};

    #[test]
    fn every_flow_of_a_plane_is_well_represented() {
        let pairs = Set::Random(80_000).pairs_of(Query::SpherePlane, 1).expect("a set of every query");
        let contacts = Reference::new(Format::WIDE, Fields::ALL).of_query(Query::SpherePlane).run_all(&pairs);
        let of = |flow| contacts.iter().filter(|contact| contact.flow() == Some(flow)).count();
        assert_eq!(of(Flow::Coincident), 0);
        assert!([Flow::Invalid, Flow::Fake, Flow::Real].map(of).iter().all(|&count| count > 4_000));
        let sum = pairs.iter().flat_map(|pair| pair.0).fold(0_u64, |sum, word| sum.rotate_left(5) ^ u64::from(word));
        assert_eq!(sum, 3_775_139_948_680_282_862, "another machine or another version made these pairs otherwise");
    }

    #[test]
    fn every_category_of_planes_is_valid_and_has_both_answers() {
        for category in categories(Query::SpherePlane) {
            let pairs: Vec<_> = category.pairs(400, 1).collect();
            let truths: Vec<_> = pairs.iter().map(|pair| Truth::of_query(Query::SpherePlane, pair)).collect();
            let real = truths.iter().filter(|truth| truth.flow() == Flow::Real).count();
            assert!(truths.iter().all(|truth| truth.flow() != Flow::Invalid), "{}", category.name());
            assert!((40..360).contains(&real), "{}: {real} of 400 touch", category.name());
            // The promise of a normal is kept as well as binary32 can keep it.
            for pair in &pairs {
                let [_, _, _, _, nx, ny, nz, _] = pair.values().map(f64::from);
                assert!(((nx * nx + ny * ny + nz * nz).sqrt() - 1.0).abs() < 3e-7, "{}: {pair:?}", category.name());
            }
        }
    }
}
