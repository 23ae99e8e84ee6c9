//! The box of a sphere in hardware: the twin of [`crate::spheres::BoundsRule`], bit for bit.
//!
//! A box is six numbers of the same width, the three lowest above the three highest. They are the integers of
//! [`crate::spheres::Bounds`] with the sign inverted, so that they compare without sign.

use std::sync::Arc;

use crate::hdl::{BuildErrors, DelayModel, Graph, Module, Signal, cut};
use crate::number::Format;
use crate::operator;
use crate::spheres::BoundsRule;

/// Bits of a word of a sphere.
const WORD: u32 = 32;
/// Bits of a sphere.
pub(in crate::afu) const SPHERE_BITS: u32 = 4 * WORD;

/// Builds the module `sphere_box`: `sphere` to `box`. Without `present`, or if the sphere is invalid, the box meets
/// no other. The output `invalid` is set for a sphere that is present and invalid.
pub(super) fn sphere_box(rule: BoundsRule, model: &DelayModel, clock_mhz: f64) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("sphere_box");
    graph.about(format!("the box of a sphere: its radius and {} units more", rule.radius_units()));
    graph.about("on each side of its centre, as integers that have the order of the numbers");
    let sphere = graph.input("sphere", SPHERE_BITS);
    let present = graph.input("present", 1);
    let words = ["x", "y", "z", "r"].into_iter().zip(0..);
    let [x, y, z, r] = words
        .map(|(name, word)| sphere.slice(WORD * word, WORD).named(name))
        .collect::<Vec<_>>()
        .try_into()
        .unwrap_or([present; 4]);

    // A NaN, an infinity or a negative radius (−0 is none) makes a sphere invalid.
    let fraction = Format::BINARY32.fraction_bits();
    let is_negative = r.msb() & r.low(WORD - 1).any();
    let broken = [x, y, z, r]
        .into_iter()
        .fold(is_negative, |any, word| any | word.slice(fraction, WORD - 1 - fraction).all())
        .named("is_broken");

    // The sum of a magnitude and a few units is infinity or less, unless it passes it.
    let infinity = u128::from(f32::INFINITY.to_bits());
    let magnitude = r.low(WORD - 1).extend(WORD);
    let increased = magnitude.plus(rule.radius_units().into()).named("r_increased");
    let passes = increased.greater_than(increased.same(infinity));
    let radius = passes.select(increased.same(infinity), increased).named("r_of_box");

    let exists = (present & !broken).named("exists");
    let edge = |(centre, name), is_low: bool| {
        let side = if is_low { "low" } else { "high" };
        let name = format!("{side}_{name}");
        let edge = operator::sum(centre, radius, Format::BINARY32, is_low).named(&format!("{name}_edge"));
        let code = code(edge, rule.bits()).named(&format!("{name}_code"));
        // Of no sphere the lowest is above all numbers, the highest below all.
        if is_low { code | (!exists).repeat(rule.bits()) } else { code.gate(exists) }
    };
    let named = [(x, "x"), (y, "y"), (z, "z")];
    let lows = named.map(|word| edge(word, true));
    let highs = named.map(|word| edge(word, false));
    graph.output("box", Signal::join(&[lows, highs].concat()));
    graph.output("invalid", present & broken);
    cut(&*graph.finish()?, model, clock_mhz)
}

/// The upper `bits` bits of the integer of a binary32 number, its sign inverted.
fn code(number: Signal<'_>, bits: u32) -> Signal<'_> {
    let magnitude = number.low(WORD - 1).extend(WORD);
    let code = number.msb().select(magnitude.same(0) - magnitude, magnitude);
    let offset = (!code.msb()).concat(code.low(WORD - 1));
    offset.high(bits)
}

/// A box in hardware.
#[derive(Clone, Copy)]
pub(super) struct Edges<'g> {
    low: [Signal<'g>; 3],
    high: [Signal<'g>; 3],
}

impl<'g> Edges<'g> {
    /// The parts of a box.
    pub(super) fn of(bounds: Signal<'g>) -> Self {
        let bits = bounds.width() / 6;
        let part = |index: u32| bounds.slice(index * bits, bits);
        Self { low: [part(5), part(4), part(3)], high: [part(2), part(1), part(0)] }
    }

    /// The box as one value.
    fn joined(self) -> Signal<'g> {
        Signal::join(&[self.low, self.high].concat())
    }

    /// For each axis and side whether the edges leave room for a common point, and one bit more.
    fn sides(self, other: Self) -> Vec<Signal<'g>> {
        let pairs = self.low.into_iter().zip(other.high).chain(other.low.into_iter().zip(self.high));
        pairs.map(|(low, high)| low.at_most(high)).collect()
    }

    /// The box around both, or `other` alone.
    pub(super) fn around(self, other: Self, only_other: Signal<'g>) -> Signal<'g> {
        let side = |own: Signal<'g>, other: Signal<'g>, keeps: Signal<'g>| (keeps & !only_other).select(own, other);
        let each = |axis: usize| {
            let ([low, other_low], [high, other_high]) =
                ([self.low[axis], other.low[axis]], [self.high[axis], other.high[axis]]);
            [side(low, other_low, low.less_than(other_low)), side(high, other_high, high.greater_than(other_high))]
        };
        let [x, y, z] = [0, 1, 2].map(each);
        Self { low: [x[0], y[0], z[0]], high: [x[1], y[1], z[1]] }.joined()
    }
}

/// Cycles from two boxes to whether they meet.
pub(super) const CYCLES_TO_MEET: u32 = 2;

/// One bit: the boxes had a point in common [two cycles](CYCLES_TO_MEET) ago.
pub(super) fn meet<'g>(one: Signal<'g>, other: Signal<'g>, name: &str) -> Signal<'g> {
    let sides = Edges::of(one).sides(Edges::of(other));
    let sides = Signal::join(&sides).delay(1).named(&format!("{name}_by_side"));
    sides.all().delay(1).named(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hdl::Evaluator;
    use crate::kernel::Arithmetic;
    use crate::number::Format;
    use crate::spheres::{Bounds, Sphere};

    /// Spheres at all scales, special words among them.
    fn spheres() -> Vec<Sphere> {
        use rand::{Rng, SeedableRng};
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(7);
        let special = [0, 1 << 31, 1, 0x7F7F_FFFF, 0xFF7F_FFFF, 0x7F80_0000, 0x7FC0_0000, 0x0080_0000, 0x7F7F_FFFE];
        let mut word = |_| match random.next_u32() % 4 {
            0 => special[random.next_u32() as usize % special.len()],
            1 => random.next_u32() & 0x0FFF_FFFF | 0x3800_0000,
            _ => random.next_u32(),
        };
        (0..20_000).map(|_| Sphere(std::array::from_fn(&mut word))).collect()
    }

    fn packed(bounds: Bounds, bits: u32) -> u128 {
        let empty = bounds == Bounds::EMPTY;
        let code = |value: i32, of_none: u128| {
            let offset = (i64::from(value) + (1 << (bits - 1))) as u128;
            if empty { of_none } else { offset }
        };
        let edges =
            bounds.low.map(|low| code(low, (1 << bits) - 1)).into_iter().chain(bounds.high.map(|high| code(high, 0)));
        edges.fold(0, |all, edge| all << bits | edge)
    }

    #[test]
    fn the_box_is_its_twins_bit_for_bit() {
        for (format, bits) in [(Format::WIDE, 21), (Format::WIDE, 10)] {
            let rule = BoundsRule::new(Arithmetic::Rounded(format), bits).expect("a rule");
            let module = sphere_box(rule, &DelayModel::default(), 200.0).expect("a module");
            let mut unit = Evaluator::new(&module, &[]).expect("an evaluator");
            let all = spheres();
            for (place, sphere) in all.iter().enumerate().take(4000).chain(all.iter().enumerate().skip(19_000)) {
                let words = sphere.0.map(u64::from);
                unit.set_words("sphere", &[words[0] | words[1] << 32, words[2] | words[3] << 32]);
                unit.set("present", u128::from(place % 50 != 0));
                (0..=module.latency).for_each(|_| unit.step());
                let expected = if place % 50 == 0 { Bounds::EMPTY } else { rule.bounds(*sphere) };
                assert_eq!(unit.get("box"), packed(expected, bits), "{sphere:?}");
                assert_eq!(unit.get("invalid") == 1, place % 50 != 0 && !sphere.is_valid());
            }
        }
    }
}
