//! Random pairs that reach every flow and every corner of the format.

use super::makers;
use super::source::{LARGEST, Source, UNIT};
use crate::query::{PAIR_WORDS, PairRecord, Query, Rule};

/// The functions that make a pair of spheres. Function i mod 10 makes pair i, so ten pairs include every flow.
pub(super) const KINDS: [fn(&mut Source) -> PairRecord; 10] = [
    Source::ordinary,
    Source::one_scale,
    Source::near_tangent,
    Source::tangent,
    Source::coincident,
    Source::any_exponents,
    Source::tiny,
    Source::huge,
    Source::any_words,
    Source::invalid,
];

/// `count` pairs. The first n of them are the same for every count of at least n.
///
/// Only integers and correctly rounded operations are used, so every machine makes the same pairs.
pub fn pairs(query: Query, count: u64, seed: u64) -> Vec<PairRecord> {
    let kinds = makers::of(query).random;
    let mut source = Source::new(seed);
    (0..count).map(|i| kinds[i as usize % kinds.len()](&mut source)).collect()
}

impl Source {
    /// Numbers around 1: contact or not, about equally often.
    pub(super) fn ordinary(&mut self) -> PairRecord {
        self.spheres((UNIT - 4, UNIT), (UNIT - 2, UNIT))
    }

    /// Numbers around some power of two, anywhere in the range.
    fn one_scale(&mut self) -> PairRecord {
        let scale = 4 + self.below(LARGEST - 4);
        self.spheres((scale - 3, scale), (scale - 2, scale))
    }

    /// The sum of the radii within a few ulp of the distance, at any scale.
    fn near_tangent(&mut self) -> PairRecord {
        let scale = 8 + self.below(LARGEST - 12);
        self.near_tangent_at(scale)
    }

    /// The same at the scale of a biased exponent, from 5 to 250.
    pub(super) fn near_tangent_at(&mut self, scale: u32) -> PairRecord {
        let [x1, y1, z1, x2, y2, z2] = [(); 6].map(|()| self.signed(scale - 4, scale));
        let (dx, dy, dz) = (x1 - x2, y1 - y2, z1 - z2);
        // Root and squares of numbers around 1, then back to the scale.
        let unit = f32::from_bits((LARGEST - scale) << 23);
        let (ux, uy, uz) = (dx * unit, dy * unit, dz * unit);
        let distance = ((ux * ux + uy * uy) + uz * uz).sqrt() / unit;
        let r1 = distance * (self.below(1 << 10) as f32 / 1024.0);
        let ulps = self.below(9);
        let r2 = f32::from_bits(((distance - r1).to_bits() + ulps).saturating_sub(4));
        PairRecord::from_spheres([x1, y1, z1, r1], [x2, y2, z2, r2])
    }

    /// Spheres that touch exactly: their distance is a small integer times a power of two.
    fn tangent(&mut self) -> PairRecord {
        const STEPS: [([i32; 3], u32); 6] =
            [([1, 0, 0], 1), ([3, 4, 0], 5), ([1, 2, 2], 3), ([2, 3, 6], 7), ([8, 9, 12], 17), ([20, 21, 0], 29)];
        let (step, distance) = STEPS[self.below(6) as usize];
        // Beyond the middle of the range on either side, the squares leave the range and are no longer exact.
        let unit = f32::from_bits((UNIT - 40 + self.below(80)) << 23);
        let turn = self.below(3) as usize;
        let centre = [(); 3].map(|()| self.below(2001) as i32 - 1000);
        let other: [i32; 3] = std::array::from_fn(|axis| {
            let step = step[(axis + turn) % 3];
            if self.bits() & 1 == 0 { centre[axis] + step } else { centre[axis] - step }
        });
        let r1 = self.below(distance + 1);
        let sphere = |[x, y, z]: [i32; 3], r: u32| [x as f32, y as f32, z as f32, r as f32].map(|v| v * unit);
        PairRecord::from_spheres(sphere(centre, r1), sphere(other, distance - r1))
    }

    /// The same centre for both: Flow 2, except for a sign of zero or an ulp now and then.
    fn coincident(&mut self) -> PairRecord {
        let mut pair = self.spheres((0, LARGEST), (0, LARGEST - 1));
        for axis in 0..3 {
            match self.below(16) {
                0 => (pair.0[axis], pair.0[axis + 4]) = (0, 0x8000_0000),
                1 => pair.0[axis + 4] = pair.0[axis] ^ 1,
                _ => pair.0[axis + 4] = pair.0[axis],
            }
        }
        if self.below(4) == 0 {
            pair.0[3] = 0x8000_0000; // a radius of -0 is a radius
        }
        pair
    }

    /// Every exponent is equally likely.
    fn any_exponents(&mut self) -> PairRecord {
        self.spheres((0, LARGEST), (0, LARGEST))
    }

    /// Zeros of both signs, subnormals and the smallest normal numbers.
    fn tiny(&mut self) -> PairRecord {
        let mut pair = self.spheres((0, 2), (0, 2));
        for word in &mut pair.0 {
            match self.below(8) {
                0 => *word &= 0x8000_0000,
                1 => *word = *word & 0x8000_0000 | 1,
                2 => *word = *word & 0x8000_0000 | 0x7F_FFFF,
                _ => {}
            }
        }
        pair
    }

    /// Numbers whose squares, sums or differences overflow.
    fn huge(&mut self) -> PairRecord {
        self.spheres((UNIT + 60, LARGEST), (UNIT + 60, LARGEST))
    }

    /// Any words.
    pub(super) fn any_words(&mut self) -> PairRecord {
        PairRecord([(); PAIR_WORDS].map(|()| self.bits()))
    }

    /// An ordinary pair except for one word: a NaN, an infinity or a negative radius.
    fn invalid(&mut self) -> PairRecord {
        let pair = self.ordinary();
        self.spoil(Query::SphereSphere, pair)
    }

    /// The pair with a word that breaks its rule.
    pub(super) fn spoil(&mut self, query: Query, mut pair: PairRecord) -> PairRecord {
        let inputs = query.shape().inputs;
        let place = self.below(inputs.len() as u32) as usize;
        let sign = self.bits() & 0x8000_0000;
        pair.0[place] = match self.below(3) {
            0 => sign | 0x7F80_0000,
            1 => sign | 0x7F80_0000 | (1 + self.below(0x7F_FFFF)),
            _ if inputs[place].rule == Rule::NotNegative => 0x8000_0000 | (1 + self.below(0x7F7F_FFFF)),
            _ => sign | 0x7FC0_0000,
        };
        pair
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Reference;
    use crate::number::Format;
    use crate::query::{Fields, Flow};

    fn flows(pairs: &[PairRecord]) -> [usize; 4] {
        let contacts = Reference::new(Format::WIDE, Fields::ALL).run_all(pairs);
        Flow::ALL.map(|flow| contacts.iter().filter(|contact| contact.flow() == Some(flow)).count())
    }

    #[test]
    fn every_flow_is_well_represented() {
        let pairs = pairs(Query::SphereSphere, 100_000, 1);
        let flows = flows(&pairs);
        assert!(flows.iter().all(|&count| count > 4_000), "{flows:?}");
        assert!(pairs.iter().any(|pair| pair.0.contains(&0x8000_0000)), "a negative zero");
        assert!(pairs.iter().any(|pair| pair.0.contains(&1)), "a smallest subnormal");
    }

    #[test]
    fn each_kind_is_what_its_name_says() {
        let pairs = pairs(Query::SphereSphere, 100_000, 2);
        let kind = |i: usize| -> Vec<_> { pairs.iter().skip(i).step_by(KINDS.len()).copied().collect() };
        let all = 100_000 / KINDS.len();
        let [invalid, fake, _, real] = flows(&kind(2));
        assert!(invalid == 0 && fake > all / 4 && real > all / 4, "near tangent: {fake} apart, {real} touch");
        let contacts = Reference::new(Format::BINARY32, Fields::ALL).run_all(&kind(3));
        let touching = contacts.iter().filter(|c| c.flow() == Some(Flow::Real) && c.depth() == 0.0);
        assert_eq!(touching.count(), all, "tangent");
        assert!(flows(&kind(4))[2] > all / 2, "coincident");
        assert_eq!(flows(&kind(9))[0], all, "invalid");
        for valid in [0, 1, 2, 3, 5, 7] {
            assert_eq!(flows(&kind(valid))[0], 0, "kind {valid}");
        }
    }

    #[test]
    fn a_seed_gives_the_same_pairs_for_good() {
        assert_eq!(pairs(Query::SphereSphere, 20, 7)[..], pairs(Query::SphereSphere, 1000, 7)[..20]);
        assert_ne!(pairs(Query::SphereSphere, 20, 7), pairs(Query::SphereSphere, 20, 8));
        let sum = pairs(Query::SphereSphere, 1000, 0)
            .iter()
            .flat_map(|pair| pair.0)
            .fold(0_u64, |sum, word| sum.rotate_left(5) ^ u64::from(word));
        assert_eq!(sum, 6_429_847_647_678_066_930, "another machine or another version made these pairs otherwise");
    }
}
