//! Choosing among bits: the lowest set one, its number, how many there are.

use super::ROW_BITS;
use crate::hdl::Signal;

/// Values that are chosen among, and bits that are counted, at once.
const OF_A_GROUP: u32 = 4;

/// Only the lowest set bit.
pub(super) fn lowest(bits: Signal<'_>) -> Signal<'_> {
    bits & (bits.same(0) - bits)
}

/// The number of the only set bit of a power of two bits; 0 if there is none.
pub(super) fn number(one_hot: Signal<'_>) -> Signal<'_> {
    let width = one_hot.width();
    let bit = |of: u32| {
        let holds: Vec<_> =
            (0..width).rev().filter(|place| place >> of & 1 == 1).map(|place| one_hot.bit(place)).collect();
        if holds.is_empty() { one_hot.graph().constant(1, 0) } else { Signal::join(&holds).any() }
    };
    let bits: Vec<_> = (0..width.ilog2().max(1)).rev().map(bit).collect();
    Signal::join(&bits)
}

/// The number of set bits. The numbers in its parts have names.
pub(super) fn count<'g>(name: &str, bits: Signal<'g>) -> Signal<'g> {
    let width = bits.width();
    if width <= OF_A_GROUP {
        let sum_bits = width.ilog2() + 1;
        let each = (0..width).map(|place| bits.bit(place).extend(sum_bits));
        return each.reduce(|sum, bit| sum + bit).unwrap_or(bits).named(name);
    }
    let half = width / 2;
    let low = count(&format!("{name}_low"), bits.low(half));
    let high = count(&format!("{name}_high"), bits.drop_low(half));
    let sum_bits = low.width().max(high.width()) + 1;
    (low.extend(sum_bits) + high.extend(sum_bits)).named(name)
}

/// The bits of `all` at the places `from`, `from + step`, ...
pub(super) fn every(all: Signal<'_>, from: u32, step: u32) -> Signal<'_> {
    let bits: Vec<_> = (from..all.width()).step_by(step as usize).map(|place| all.bit(place)).collect();
    Signal::join(&bits.into_iter().rev().collect::<Vec<_>>())
}

/// The place in its row of one of the spheres that are compared side by side. `places` are those of all, `None` if the
/// whole row is compared; `sphere` says which one it is.
pub(super) fn place_of<'g>(name: &str, places: Option<Signal<'g>>, sphere: Signal<'g>) -> Signal<'g> {
    let Some(places) = places else { return sphere };
    if places.width() == ROW_BITS {
        return places;
    }
    let all: Vec<_> = (0..places.width() / ROW_BITS).map(|index| places.slice(index * ROW_BITS, ROW_BITS)).collect();
    chosen(name, sphere.one_hot(), &all)
}

/// One of equally wide `values`, by a one-hot choice; zero if no bit is set. It and its parts have names.
pub(super) fn chosen<'g>(name: &str, choice: Signal<'g>, values: &[Signal<'g>]) -> Signal<'g> {
    let mut parts: Vec<_> = values.iter().zip(0..).map(|(value, place)| value.gate(choice.bit(place))).collect();
    while parts.len() > 1 {
        let is_one = parts.len() <= OF_A_GROUP as usize;
        let groups = parts.chunks(OF_A_GROUP as usize).enumerate().map(|(group, parts)| match parts {
            [only] => *only,
            [first, rest @ ..] => {
                let name = if is_one { name.to_owned() } else { format!("{name}_group_{group}") };
                rest.iter().fold(*first, |all, part| all | *part).named(&name)
            }
            [] => choice,
        });
        parts = groups.collect();
    }
    parts.first().copied().unwrap_or(choice)
}
