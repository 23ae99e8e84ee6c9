//! Hard pairs: floating-point engines miss their contacts, invent contacts, or lose the direction.

use super::makers::categories;
use super::source::{LARGEST, Source, UNIT};
use crate::query::{PairRecord, Query};

/// One way in which a pair can be hard.
#[derive(Clone, Copy, Debug)]
pub struct Category {
    pub(super) query: Query,
    pub(super) name: &'static str,
    pub(super) about: &'static str,
    pub(super) number: u64,
    pub(super) make: fn(&mut Source) -> PairRecord,
}

/// Every category of two spheres. Pair i of `hard:N` belongs to category i mod 17.
pub const CATEGORIES: [Category; 17] = {
    const fn of(number: u64, name: &'static str, about: &'static str, make: fn(&mut Source) -> PairRecord) -> Category {
        Category { query: Query::SphereSphere, name, about, number, make }
    }
    [
        of(0, "ordinary", "coordinates and radii around 1", Source::ordinary),
        of(1, "near-tangent", "the sum of the radii within a few ulp of the distance", Source::near_tangent_ordinary),
        of(2, "ulps-apart", "centres one or two ulp apart", Source::ulps_apart),
        of(3, "subnormal", "a subnormal separation", Source::subnormal),
        of(4, "underflow", "the squared distance underflows in binary32", Source::underflow),
        of(5, "overflow", "the squared distance overflows in binary32", Source::overflow),
        of(6, "far", "coordinates of 1e5 to 1e8, radii about 1", Source::far),
        of(7, "ratio", "radii that differ up to 1e7 times", Source::ratio),
        of(8, "tangent", "exactly tangent, or one ulp to a side", Source::tangent_quadruple),
        of(9, "internal", "exactly tangent from inside, or one ulp to a side", Source::internal_tangent),
        of(10, "axis", "centres on an axis", Source::axis),
        of(11, "log-uniform", "every exponent as likely as any other", Source::log_uniform),
        of(12, "extreme-scale", "near tangent at a scale of 1e36 or 1e-36", Source::extreme_scale),
        of(13, "largest", "coordinates and radii near the largest finite number", Source::largest),
        of(14, "same-centre", "coincident centres, signed zeros, zero radii", Source::same_centre),
        of(15, "cancel", "1 to 277 bits of s - d cancel", Source::cancel),
        of(16, "sideways", "tangent along an axis, but for a tiny step to the side", Source::sideways),
    ]
};

impl Category {
    /// The name, in lower case.
    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// What makes the pairs hard, in a few words.
    pub const fn about(&self) -> &'static str {
        self.about
    }

    /// `count` pairs, all valid. The first n of them are the same for every count of at least n.
    pub fn pairs(self, count: u64, seed: u64) -> impl Iterator<Item = PairRecord> {
        // Categories are independent of one another, because each has its own stream.
        let mut source = Source::new(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(self.number));
        let (query, make) = (self.query, self.make);
        // A number near the largest may become an infinity: such a pair is drawn again.
        let mut valid = std::iter::repeat_with(move || make(&mut source)).filter(move |pair| pair.is_valid(query));
        (0..count).filter_map(move |_| valid.next())
    }
}

/// `count` pairs of all categories in turn.
pub fn pairs(query: Query, count: u64, seed: u64) -> Vec<PairRecord> {
    let categories = categories(query);
    let of_each = count.div_ceil(categories.len() as u64);
    let mut streams: Vec<_> = categories.iter().map(|category| category.pairs(of_each, seed)).collect();
    (0..count).filter_map(|i| streams[i as usize % categories.len()].next()).collect()
}

impl Source {
    /// Coordinates and radii of one range of exponents.
    fn within(&mut self, low: u32, high: u32) -> PairRecord {
        self.spheres((low, high), (low, high))
    }

    fn near_tangent_ordinary(&mut self) -> PairRecord {
        let scale = UNIT - 8 + self.below(16);
        self.near_tangent_at(scale)
    }

    fn ulps_apart(&mut self) -> PairRecord {
        let mut pair = self.ordinary();
        let axis = self.below(3) as usize;
        for i in 0..3 {
            let ulps = if i == axis { 1 + self.below(2) } else { self.below(3) };
            pair.0[i + 4] = if self.flip() { pair.0[i] + ulps } else { pair.0[i] - ulps };
        }
        if self.below(4) == 0 {
            // With radii as small as the step, the step decides.
            for i in [3, 7] {
                pair.0[i] = self.positive(UNIT - 26, UNIT - 22).to_bits();
            }
        }
        pair
    }

    fn subnormal(&mut self) -> PairRecord {
        let radii = if self.flip() { (0, 1) } else { (UNIT - 2, UNIT) };
        self.spheres((0, 0), radii)
    }

    fn underflow(&mut self) -> PairRecord {
        let low = 2 + self.below(UNIT - 66);
        self.within(low, low + 3)
    }

    fn overflow(&mut self) -> PairRecord {
        let low = UNIT + 63 + self.below(59);
        self.within(low, low + 3)
    }

    fn far(&mut self) -> PairRecord {
        let p1 = [(); 3].map(|()| self.signed(UNIT + 17, UNIT + 26));
        let p2 = p1.map(|c| c + self.signed(UNIT - 3, UNIT));
        let [r1, r2] = [(); 2].map(|()| self.positive(UNIT - 1, UNIT));
        pair((p1, r1), (p2, r2))
    }

    fn ratio(&mut self) -> PairRecord {
        let p1 = [(); 3].map(|()| self.signed(UNIT - 4, UNIT));
        let r1 = self.positive(UNIT - 1, UNIT);
        let r2 = self.positive(UNIT - 24, UNIT - 1);
        let step = [(); 3].map(|()| self.signed(UNIT - 4, UNIT));
        let length = ((step[0] * step[0] + step[1] * step[1]) + step[2] * step[2]).sqrt();
        // From 15/16 of touching to 17/16, and near touching half of the time.
        let reach = if self.flip() { 1.0 } else { 0.9375 + self.below(1 << 10) as f32 / 8192.0 };
        let scale = (r1 + r2) * reach / length;
        let p2 = [0, 1, 2].map(|i| p1[i] + step[i] * scale);
        if self.flip() { pair((p1, r1), (p2, r2)) } else { pair((p2, r2), (p1, r1)) }
    }

    /// A Pythagorean quadruple below 2^20 (by Euler's formula from four integers below 2^9), rotated and with random
    /// signs.
    fn quadruple(&mut self) -> ([i32; 3], i32) {
        let [m, n, p, q] = [(); 4].map(|()| self.below(512) as i32);
        let legs = [m * m + n * n - p * p - q * q, 2 * (m * q + n * p), 2 * (n * q - m * p)];
        let turn = self.below(3) as usize;
        let step = [0, 1, 2].map(|i| if self.flip() { legs[(i + turn) % 3] } else { -legs[(i + turn) % 3] });
        (step, m * m + n * n + p * p + q * q)
    }

    /// Spheres on integer points times a power of two, with the radii `r1` and the rest of the distance.
    fn on_quadruple(&mut self, radii: impl Fn(&mut Self, i32) -> [i32; 2]) -> PairRecord {
        let unit = f32::from_bits((UNIT - 60 + self.below(80)) << 23);
        let (step, distance) = self.quadruple();
        let p1 = [(); 3].map(|()| self.below(1 << 23) as i32 - (1 << 22));
        let p2 = [0, 1, 2].map(|i| p1[i] + step[i]);
        let [r1, r2] = radii(self, distance);
        let real = |v: i32| v as f32 * unit;
        let mut pair = pair((p1.map(real), real(r1)), (p2.map(real), real(r2)));
        let which = if self.flip() { 3 } else { 7 };
        match self.below(3) {
            0 => pair.0[which] += 1,
            1 => pair.0[which] = pair.0[which].saturating_sub(1),
            _ => {}
        }
        pair
    }

    fn tangent_quadruple(&mut self) -> PairRecord {
        self.on_quadruple(|source, distance| {
            let r1 = source.below(distance as u32 + 1) as i32;
            [r1, distance - r1]
        })
    }

    fn internal_tangent(&mut self) -> PairRecord {
        self.on_quadruple(|source, distance| {
            let small = source.below(1 << 20) as i32;
            if source.flip() { [small, small + distance] } else { [small + distance, small] }
        })
    }

    fn axis(&mut self) -> PairRecord {
        let mut pair = self.ordinary();
        let axis = self.below(3) as usize;
        for i in (0..3).filter(|&i| i != axis) {
            pair.0[i + 4] = pair.0[i];
        }
        if self.flip() {
            // Touching, as nearly as binary32 can represent it.
            let [x1, x2, r1] = [axis, axis + 4, 3].map(|i| f32::from_bits(pair.0[i]));
            pair.0[7] = ((x1 - x2).abs() - r1).max(0.0).to_bits();
        }
        pair
    }

    fn log_uniform(&mut self) -> PairRecord {
        self.within(0, LARGEST)
    }

    fn extreme_scale(&mut self) -> PairRecord {
        let scale = if self.flip() { UNIT + 119 } else { UNIT - 119 };
        self.near_tangent_at(scale)
    }

    fn largest(&mut self) -> PairRecord {
        self.spheres((LARGEST - 1, LARGEST), (LARGEST - 2, LARGEST))
    }

    fn same_centre(&mut self) -> PairRecord {
        let mut pair = self.within(0, LARGEST);
        for axis in 0..3 {
            if self.below(4) == 0 {
                pair.0[axis] &= 0x8000_0000;
            }
            pair.0[axis + 4] = pair.0[axis];
            if pair.0[axis] << 1 == 0 && self.flip() {
                pair.0[axis + 4] ^= 0x8000_0000;
            }
        }
        for radius in [3, 7] {
            match self.below(4) {
                0 => pair.0[radius] = 0,
                1 => pair.0[radius] = 0x8000_0000,
                _ => {}
            }
        }
        // Two in four are the same sphere.
        if self.flip() {
            pair.0[7] = pair.0[3];
        }
        pair
    }

    /// Along an axis, a sphere that reaches to the origin and a tiny one beyond it: the sum of the radii and the
    /// distance agree in this number of bits.
    fn cancel(&mut self) -> PairRecord {
        let bits = 1 + self.below(277) as i32;
        let lowest = (bits - 150).max(-126);
        let high = lowest + self.below((128 - lowest) as u32) as i32;
        // The largest of all numbers below 2^(high + 1).
        let large = f32::from_bits(((high + 127) as u32) << 23 | 0x7F_FFFF);
        let unit = power_of_two(high + 1 - bits);
        // A contact as deep as the unit, a touch, and a miss by a unit.
        let (x2, r2) = [(-unit, 2.0 * unit), (-unit, unit), (-2.0 * unit, unit)][self.below(3) as usize];
        self.along_an_axis((large, large), (x2, r2), 0.0)
    }

    /// Radii that touch along an axis exactly, or overlap in the last place, and a step to the side that is far below
    /// the last place.
    fn sideways(&mut self) -> PairRecord {
        let scale = self.below(60) as i32 - 30;
        let [r1, r2] = [(); 2].map(|()| power_of_two(scale) * (1 + self.below(1 << 22)) as f32);
        let side = power_of_two(scale + self.below(60) as i32 - 40);
        let nearer = if self.flip() { power_of_two(scale - self.below(2) as i32 * 24) } else { 0.0 };
        self.along_an_axis((r1 + r2, r1), (nearer, r2), side)
    }

    /// Two spheres at places along a random axis, the second moved to the side; either may come first.
    fn along_an_axis(&mut self, (x1, r1): (f32, f32), (x2, r2): (f32, f32), side: f32) -> PairRecord {
        let axis = self.below(3) as usize;
        let sign = if self.flip() { 1.0 } else { -1.0 };
        let (mut p1, mut p2) = ([0.0; 3], [0.0; 3]);
        (p1[axis], p2[axis]) = (sign * x1, sign * x2);
        p2[(axis + 1) % 3] = side;
        if self.flip() { pair((p1, r1), (p2, r2)) } else { pair((p2, r2), (p1, r1)) }
    }

    pub(super) fn flip(&mut self) -> bool {
        self.bits() & 1 == 0
    }
}

/// 2^`exponent`, from −149 to 127.
fn power_of_two(exponent: i32) -> f32 {
    if exponent < -126 {
        f32::from_bits(1 << (exponent + 149))
    } else {
        f32::from_bits(((exponent + 127) as u32) << 23)
    }
}

fn pair(([x1, y1, z1], r1): ([f32; 3], f32), ([x2, y2, z2], r2): ([f32; 3], f32)) -> PairRecord {
    PairRecord::from_spheres([x1, y1, z1, r1], [x2, y2, z2, r2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Truth;
    use crate::query::Flow;

    #[test]
    fn every_category_is_valid_and_what_its_name_says() {
        for category in CATEGORIES {
            let name = category.name();
            let pairs: Vec<_> = category.pairs(400, 1).collect();
            let truths: Vec<_> = pairs.iter().map(Truth::of).collect();
            let of = |flow| truths.iter().filter(|truth| truth.flow() == flow).count();
            assert_eq!(of(Flow::Invalid), 0, "{name}");
            let touching = |truth: &&Truth| truth.depth().is_some_and(|depth| depth.is_zero());
            let (real, fake, coincident) = (of(Flow::Real), of(Flow::Fake), of(Flow::Coincident));
            match name {
                "same-centre" => assert_eq!(coincident, 400),
                "tangent" => assert!(truths.iter().filter(touching).count() > 100),
                "internal" => assert_eq!(real, 400),
                "ratio" | "far" | "ulps-apart" | "subnormal" => assert!(real > 40, "{name}: {real} touch"),
                _ => assert!(real > 40 && fake > 40, "{name}: {real} touch, {fake} do not"),
            }
        }
    }

    /// With this seed, a category once produced an infinity among its 60 000 pairs.
    #[test]
    fn what_overflows_is_drawn_again() {
        for category in CATEGORIES {
            assert_eq!(
                category.pairs(60_000, 5).filter(|pair| pair.is_valid(Query::SphereSphere)).count(),
                60_000,
                "{}",
                category.name()
            );
        }
    }

    #[test]
    fn a_seed_gives_the_same_pairs_for_good() {
        assert_eq!(pairs(Query::SphereSphere, 40, 7)[..], pairs(Query::SphereSphere, 1000, 7)[..40]);
        assert_ne!(pairs(Query::SphereSphere, 40, 7), pairs(Query::SphereSphere, 40, 8));
        assert_eq!(pairs(Query::SphereSphere, 40, 7)[20], CATEGORIES[3].pairs(2, 7).last().unwrap());
        let words = pairs(Query::SphereSphere, 1700, 0).into_iter().flat_map(|pair| pair.0);
        let sum = words.fold(0_u64, |sum, word| sum.rotate_left(5) ^ u64::from(word));
        assert_eq!(sum, 8_010_911_902_353_169_898, "another machine or another version made these pairs otherwise");
    }
}
