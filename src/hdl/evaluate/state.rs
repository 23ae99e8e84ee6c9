//! The state that a clock edge changes: registers, delays and memories. All of them sample before any of them changes.

use std::collections::BTreeMap;

use super::EvaluateError;
use super::flatten::{Flat, FlatId, Link};
use super::lower::{Lowered, Word, word_count};
use crate::hdl::module::{Op, Start};

/// The most words that memories and delays may hold together: 8 GiB.
const MOST_WORDS: u64 = 1 << 30;

/// The word of a register, with the places of its next value and its enable.
#[derive(Debug)]
struct Enabled {
    next: u32,
    enable: u32,
}

/// All delays of the same length: a ring of rows, with one word per delayed word.
#[derive(Debug)]
struct Ring {
    inputs: Vec<u32>,
    /// Row by row, `length` rows.
    rows: Vec<u64>,
    length: usize,
    position: usize,
}

#[derive(Debug)]
struct Memory {
    words: Vec<u64>,
    words_each: usize,
    depth: u64,
    /// The bits of a word's last part.
    last_part: u64,
    /// Enable, address, and the words of the data.
    write: Option<(u32, u32, Vec<u32>)>,
}

#[derive(Debug)]
struct Read {
    memory: usize,
    address: u32,
    enable: Option<u32>,
}

/// State elements of the whole hierarchy. Their present values are together among the words, in this order: registers
/// that always load (and delays of one cycle), registers with an enable, rings, memory reads.
#[derive(Debug)]
pub(super) struct State {
    always: Vec<u32>,
    enabled: Vec<Enabled>,
    rings: Vec<Ring>,
    memories: Vec<Memory>,
    reads: Vec<Read>,
    resets: Vec<(u32, u64)>,
    /// The same for registers that have a value when the device is configured.
    configured: Vec<(u32, u64)>,
    sampled: Vec<u64>,
}

/// State elements, sorted by how they load, before words have places.
#[derive(Debug, Default)]
pub(super) struct Elements {
    always: Vec<FlatId>,
    enabled: Vec<FlatId>,
    rings: BTreeMap<u32, Vec<FlatId>>,
    reads: Vec<FlatId>,
}

impl Elements {
    pub(super) fn new(flat: &Flat, lowered: &Lowered) -> Result<Self, EvaluateError> {
        let mut elements = Self::default();
        let mut held = 0;
        for &id in &lowered.state {
            let node = flat.node(id);
            let words = word_count(node.width) as u64;
            match node.op {
                Op::Delay { cycles: 1 } => elements.always.push(id),
                Op::Delay { cycles } => {
                    held += words * u64::from(cycles);
                    elements.rings.entry(cycles).or_default().push(id);
                }
                Op::MemoryRead { memory } => {
                    held += words * u64::from(flat.scope(id).module.memories[memory].depth);
                    elements.reads.push(id);
                }
                _ if node.operands.len() == 1 => elements.always.push(id),
                _ => elements.enabled.push(id),
            }
            if held > MOST_WORDS {
                return Err(EvaluateError::TooLarge(held));
            }
        }
        Ok(elements)
    }

    fn ids(&self) -> impl Iterator<Item = FlatId> + '_ {
        let rings = self.rings.values().flatten();
        self.always.iter().chain(&self.enabled).chain(rings).chain(&self.reads).copied()
    }

    /// Words of present values, in the order in which they are placed.
    pub(super) fn words(&self, flat: &Flat, lowered: &Lowered) -> Vec<Word> {
        self.ids().flat_map(|id| lowered.of(flat, id).iter().copied()).collect()
    }

    /// Builds the state from the places of words.
    pub(super) fn place(&self, flat: &Flat, lowered: &Lowered, place: &[u32]) -> State {
        let at = |id: FlatId| -> Vec<u32> { lowered.of(flat, id).iter().map(|&w| place[w as usize]).collect() };
        let operand = |id: FlatId, k: usize| at(flat.scope(id).base + flat.node(id).operands[k].index());
        let always = self.always.iter().flat_map(|&id| operand(id, 0)).collect();
        let enabled = self.enabled.iter().flat_map(|&id| {
            let enable = operand(id, 1)[0];
            operand(id, 0).into_iter().map(move |next| Enabled { next, enable })
        });
        let enabled = enabled.collect();
        let rings = self.rings.iter().map(|(&cycles, ids)| {
            let inputs: Vec<u32> = ids.iter().flat_map(|&id| operand(id, 0)).collect();
            // The present value is the last of `cycles` places.
            let length = cycles as usize - 1;
            Ring { rows: vec![0; length * inputs.len()], inputs, length, position: 0 }
        });
        let rings = rings.collect();

        let mut memories = Vec::new();
        let mut index_of = BTreeMap::new();
        let mut reads = Vec::new();
        for &id in &self.reads {
            let Op::MemoryRead { memory } = flat.node(id).op else { continue };
            let scope = flat.scope(id);
            let index = *index_of.entry(scope.memories + memory).or_insert_with(|| {
                let memory = &scope.module.memories[memory];
                let words_each = word_count(memory.width);
                let write = memory.write.map(|[enable, address, data]| {
                    let at = |node: crate::hdl::module::NodeId| at(scope.base + node.index());
                    (at(enable)[0], at(address)[0], at(data))
                });
                let words = vec![0; memory.depth as usize * words_each];
                let last_part = u64::MAX >> (memory.width.wrapping_neg() % u64::BITS);
                memories.push(Memory { words, words_each, depth: u64::from(memory.depth), last_part, write });
                memories.len() - 1
            });
            let enable = (flat.node(id).operands.len() > 1).then(|| operand(id, 1)[0]);
            reads.push(Read { memory: index, address: operand(id, 0)[0], enable });
        }

        let (mut resets, mut configured) = (Vec::new(), Vec::new());
        for &id in self.always.iter().chain(&self.enabled) {
            if let (Op::Register { start, .. }, Link::Own) = (&flat.node(id).op, &flat.links[id]) {
                let (value, of) = match start {
                    Start::Reset(value) => (value, &mut resets),
                    Start::Configured(value) => (value, &mut configured),
                    Start::Any => continue,
                };
                let part = |index: usize| if index < 2 { (value >> (64 * index)) as u64 } else { 0 };
                of.extend(at(id).into_iter().enumerate().map(|(index, place)| (place, part(index))));
            }
        }
        let sampled = vec![0; self.words(flat, lowered).len()];
        State { always, enabled, rings, memories, reads, resets, configured, sampled }
    }
}

impl State {
    /// Sets every register that has a value when the device is configured.
    pub(super) fn configure(&self, words: &mut [u64]) {
        for &(place, value) in &self.configured {
            words[place as usize] = value;
        }
    }

    /// Sets every register to its reset value, if it has one.
    pub(super) fn reset(&self, words: &mut [u64]) {
        for &(place, value) in &self.resets {
            words[place as usize] = value;
        }
    }

    /// A clock edge. `words` are settled, and state begins at `first`.
    pub(super) fn clock(&mut self, words: &mut [u64], first: usize) {
        let at = |place: u32| words[place as usize];
        let end = first + self.sampled.len();
        let (always, rest) = self.sampled.split_at_mut(self.always.len());
        for (sample, &next) in always.iter_mut().zip(&self.always) {
            *sample = at(next);
        }
        let (enabled, mut rest) = rest.split_at_mut(self.enabled.len());
        let present = &words[first + self.always.len()..];
        for ((sample, register), &present) in enabled.iter_mut().zip(&self.enabled).zip(present) {
            *sample = if at(register.enable) != 0 { at(register.next) } else { present };
        }
        for ring in &mut self.rings {
            let width = ring.inputs.len();
            let (samples, behind) = rest.split_at_mut(width);
            rest = behind;
            let row = &mut ring.rows[ring.position * width..][..width];
            for ((sample, held), &input) in samples.iter_mut().zip(row).zip(&ring.inputs) {
                *sample = std::mem::replace(held, at(input));
            }
            ring.position = if ring.position + 1 == ring.length { 0 } else { ring.position + 1 };
        }
        for read in &self.reads {
            let memory = &self.memories[read.memory];
            let present = end - rest.len();
            let (samples, behind) = rest.split_at_mut(memory.words_each);
            rest = behind;
            let address = at(read.address);
            if read.enable.is_some_and(|enable| at(enable) == 0) {
                samples.copy_from_slice(&words[present..][..memory.words_each]);
            } else if address < memory.depth {
                samples.copy_from_slice(&memory.words[address as usize * memory.words_each..][..memory.words_each]);
                // A block memory that writes this word now may return anything. So whatever uses it shall go wrong.
                if memory.write.as_ref().is_some_and(|(enable, place, _)| at(*enable) != 0 && at(*place) == address) {
                    samples.iter_mut().for_each(|part| *part = !*part);
                    samples[memory.words_each - 1] &= memory.last_part;
                }
            } else {
                samples.fill(0);
            }
        }
        for memory in &mut self.memories {
            if let Some((enable, address, data)) = &memory.write
                && at(*enable) != 0
                && at(*address) < memory.depth
            {
                let word = &mut memory.words[at(*address) as usize * memory.words_each..];
                for (held, &data) in word.iter_mut().zip(data) {
                    *held = at(data);
                }
            }
        }
        words[first..first + self.sampled.len()].copy_from_slice(&self.sampled);
    }
}
