//! Wide values, a part at a time: a register that steered all bits of a line would drive wires across the whole device.
//! Each part has a copy of that register, which can be placed beside it.

use crate::hdl::Signal;

/// The most bits that one copy steers.
const BITS_PER_COPY: u32 = 128;

/// The copies that steer a value of this many bits.
pub(super) fn copies_for(width: u32) -> u32 {
    width.div_ceil(BITS_PER_COPY)
}

/// Copies of a one-bit register that takes `value`, not reset, to steer `width` bits: a single one has no suffix.
pub(super) fn steering<'g>(value: Signal<'g>, name: &str, width: u32) -> Vec<Signal<'g>> {
    match copies_for(width) {
        1 => vec![value.delay(1).named(name)],
        count => value.data_copies(name, count),
    }
}

/// The parts of `value` that each copy steers, the lowest first.
pub(super) fn parts(value: Signal<'_>, copies: usize) -> Vec<Signal<'_>> {
    let (width, count) = (value.width(), copies as u32);
    let bound = |index: u32| index * width / count;
    (0..count).map(|index| value.slice(bound(index), bound(index + 1) - bound(index))).collect()
}

/// `of` applied to each copy and the part of `value` that it steers; the joined results.
pub(super) fn in_parts<'g>(
    copies: &[Signal<'g>],
    value: Signal<'g>,
    of: impl Fn(usize, Signal<'g>, Signal<'g>) -> Signal<'g>,
) -> Signal<'g> {
    let parts = parts(value, copies.len()).into_iter().enumerate();
    let results: Vec<_> = parts.map(|(index, part)| of(index, copies[index], part)).rev().collect();
    Signal::join(&results)
}

/// `one` if the copies are set, otherwise `other`.
pub(super) fn select<'g>(copies: &[Signal<'g>], one: Signal<'g>, other: Signal<'g>) -> Signal<'g> {
    let others = parts(other, copies.len());
    in_parts(copies, one, |index, chosen, part| chosen.select(part, others[index]))
}

/// A register of this name, in parts, that takes `value` where the copies are set.
pub(super) fn register_if<'g>(copies: &[Signal<'g>], name: &str, value: Signal<'g>) -> Signal<'g> {
    let graph = value.graph();
    in_parts(copies, value, |index, enable, part| {
        let name = if copies.len() == 1 { name.to_owned() } else { format!("{name}_{index}") };
        let register = graph.data_register(&name, part.width());
        register.next_if(enable, part);
        register.value()
    })
}
