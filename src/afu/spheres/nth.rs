//! The set bits of a mask by their rank: the number of the bit that so many lower ones are set below. It only feeds
//! forward, so a stage that takes several set bits per cycle needs no loop through them.

use std::sync::Arc;

use super::bits::{chosen, count, number};
use super::{ROW, ROW_BITS};
use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// Bits of a part of a slice.
const PART: u32 = 4;

/// Cycles from a rank in a slice to the number of its bit.
const CYCLES_IN_SLICE: u32 = 3;

/// Cycles from a mask and ranks in it to the numbers of the bits, for a mask of so many slices of [`ROW`] bits.
pub(super) const fn cycles_to_nth(slices: u32) -> u32 {
    if slices == 1 { CYCLES_IN_SLICE } else { 2 + CYCLES_IN_SLICE }
}

/// Cycles from a mask to how many bits are set [below its slices](below_slices).
pub(super) const fn cycles_to_count(slices: u32) -> u32 {
    1 + slices.ilog2()
}

/// For each slice of [`ROW`] bits of `mask`, how many bits are set in it and in those below, all of them
/// [so many cycles](cycles_to_count) later. The last one is the number of all set bits.
pub(super) fn count_up_to_slices<'g>(name: &str, mask: Signal<'g>) -> Vec<Signal<'g>> {
    let slices = mask.width() / ROW;
    let bits = mask.width().ilog2() + 1;
    let mut sums: Vec<_> = (0..slices)
        .map(|slice| {
            let of_slice = count(&format!("{name}_count_{slice}"), mask.slice(slice * ROW, ROW));
            of_slice.extend(bits).delay(1).named(&format!("{name}_in_{slice}"))
        })
        .collect();
    // In each step a sum takes in twice as many slices.
    let mut step = 1;
    while step < slices as usize {
        let next = (0..sums.len()).map(|slice| {
            let sum = if slice < step { sums[slice] } else { sums[slice] + sums[slice - step] };
            sum.delay(1).named(&format!("{name}_up_to_{slice}_over_{}", 2 * step))
        });
        sums = next.collect();
        step *= 2;
    }
    sums
}

/// The numbers of the bits of `ranks` among the set bits of `mask`, [so many cycles](cycles_to_nth) later. `up_to` are
/// the sums of [`count_up_to_slices`], given with the mask. A rank that is too high gives any number.
pub(super) fn nth<'g>(
    graph: &'g Graph,
    name: &str,
    mask: Signal<'g>,
    up_to: &[Signal<'g>],
    ranks: &[Signal<'g>],
) -> Result<Vec<Signal<'g>>, BuildErrors> {
    let unit = bit_of_rank()?;
    let in_slice = |name: &str, slice: Signal<'g>, rank: Signal<'g>| {
        let inputs = [("mask", slice), ("rank", rank.extend(ROW_BITS))];
        graph.instance(&format!("{name}_unit"), &unit, &inputs).output("number")
    };
    let slices = mask.width() / ROW;
    let lanes = ranks.iter().zip(0..).map(|(rank, lane)| (*rank, format!("{name}_{lane}")));
    if slices == 1 {
        return Ok(lanes.map(|(rank, name)| in_slice(&name, mask, rank)).collect());
    }
    let all: Vec<_> = (0..slices)
        .map(|slice| mask.slice(slice * ROW, ROW).delay(1).named(&format!("{name}s_of_slice_{slice}")))
        .collect();
    // A slice has 16 bits, so four bits of a rank in it are enough.
    let below: Vec<_> = (0..slices)
        .map(|slice| {
            let below = if slice == 0 { up_to[0].same(0) } else { up_to[slice as usize - 1] };
            below.low(ROW_BITS).delay(1).named(&format!("{name}s_below_slice_{slice}"))
        })
        .collect();
    let of_lane = |(rank, name): (Signal<'g>, String)| {
        // The slice is the last one with no more bits below it than the rank.
        let reached = up_to[..slices as usize - 1].iter().map(|sum| rank.extend(sum.width()).at_least(*sum));
        let reached: Vec<_> = [graph.constant(1, 1)].into_iter().chain(reached).collect();
        let reached = Signal::join(&reached.into_iter().rev().collect::<Vec<_>>()).named(&format!("{name}_reaches"));
        let higher = reached.extend(slices + 1).drop_low(1);
        let hot = (reached & !higher).delay(1).named(&format!("{name}_slice"));
        let slice = chosen(&format!("{name}_bits"), hot, &all).delay(1).named(&format!("{name}_slice_bits"));
        let below = chosen(&format!("{name}_ranks_skipped"), hot, &below);
        let rank = rank.low(ROW_BITS).delay(1).named(&format!("{name}_rank"));
        let rank = (rank - below).delay(1).named(&format!("{name}_rank_in_slice"));
        let place = in_slice(&name, slice, rank);
        number(hot).delay(1 + CYCLES_IN_SLICE).named(&format!("{name}_slice_then")).concat(place)
    };
    Ok(lanes.map(of_lane).collect())
}

/// Builds the module `bit_of_rank`: the number of the set bit of `mask` below which `rank` others are set.
fn bit_of_rank() -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("bit_of_rank");
    graph
        .about(format!("the number of the set bit below which so many others are set, after {CYCLES_IN_SLICE} cycles"));
    let mask = graph.input("mask", ROW);
    let rank = graph.input("rank", ROW_BITS);
    // In which part it is.
    let mut sum = mask.same(0).low(ROW_BITS);
    let (mut parts, mut below) = (Vec::new(), Vec::new());
    for index in 0..ROW / PART {
        let part = mask.slice(index * PART, PART);
        below.push(sum.delay(1).named(&format!("below_part_{index}")));
        parts.push(part.delay(1).named(&format!("part_{index}")));
        if (index + 1) * PART < ROW {
            let of_part = count(&format!("count_of_part_{index}"), part);
            sum = (sum + of_part.extend(ROW_BITS)).named(&format!("up_to_part_{index}"));
        }
    }
    let rank = rank.delay(1).named("rank_then");
    let reached: Vec<_> = below.iter().rev().map(|below| rank.at_least(*below)).collect();
    let reached = Signal::join(&reached).named("reaches");
    let hot = (reached & !reached.extend(ROW / PART + 1).drop_low(1)).named("is_part");
    // Which bit of the part it is.
    let part = chosen("part_of_rank", hot, &parts).delay(1).named("part");
    let rank = (rank - chosen("ranks_skipped", hot, &below)).low(PART.ilog2()).delay(1).named("rank_in_part");
    let bit = |index: u32| (0..PART).filter(|place| index >> 2 >> place & 1 == 1).nth((index & 3) as usize);
    let table: Vec<u128> = (0..1 << (PART + 2)).map(|index| bit(index).map_or(0, u128::from)).collect();
    let place = part.concat(rank).named("part_and_rank").lookup(&table, PART.ilog2()).delay(1).named("place_in_part");
    graph.output("number", number(hot).delay(2).named("part_number").concat(place));
    graph.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hdl::Evaluator;

    /// Every rank of many masks gives the bit that a loop finds.
    #[test]
    fn each_rank_gives_its_bit() {
        use rand::{Rng, SeedableRng};
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(1);
        for slices in [1, 2, 4, 16] {
            let width = slices * ROW;
            let graph = Graph::new("nth");
            let words: Vec<_> = (0..slices).map(|slice| graph.input(&format!("mask_{slice}"), ROW)).rev().collect();
            let mask = Signal::join(&words);
            let rank = graph.input("rank", width.ilog2());
            let up_to = count_up_to_slices("set", mask);
            let counted = cycles_to_count(slices);
            let numbers = nth(&graph, "nth", mask.delay(counted), &up_to, &[rank.delay(counted)]).expect("numbers");
            graph.output("number", numbers[0]);
            graph.output("count", up_to[slices as usize - 1]);
            let module = graph.finish().expect("a module");
            let mut unit = Evaluator::new(&module, &[]).expect("an evaluator");
            for trial in 0..400 {
                let sparse = trial % 4;
                let mask: Vec<bool> = (0..width).map(|_| random.next_u32() % (1 << (2 * sparse)) == 0).collect();
                for slice in 0..slices {
                    let bits = &mask[(slice * ROW) as usize..][..ROW as usize];
                    let word = bits.iter().rev().fold(0, |word, bit| word << 1 | u128::from(*bit));
                    unit.set(&format!("mask_{slice}"), word);
                }
                let set: Vec<_> = (0..width).filter(|bit| mask[*bit as usize]).collect();
                if set.is_empty() {
                    continue;
                }
                let rank = random.next_u32() as usize % set.len();
                unit.set("rank", rank as u128);
                (0..counted).for_each(|_| unit.step());
                assert_eq!(unit.get("count"), set.len() as u128);
                (0..cycles_to_nth(slices)).for_each(|_| unit.step());
                assert_eq!(unit.get("number"), u128::from(set[rank]), "{slices} slices, rank {rank} of {set:?}");
            }
        }
    }
}
