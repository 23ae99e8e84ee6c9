//! Turns nodes of any width into steps on 64-bit words. Slices and concatenations at word borders, zero extensions,
//! wires and ports cost nothing, because they are the same words under another name.

use std::collections::HashMap;

use super::flatten::{Flat, FlatId, Link, is_state};
use super::tape::{Kind, Step, field};
use crate::hdl::module::{Node, Op};

/// A word without a place. [`Lowered::sources`] has its computation.
pub(super) type Word = u32;

/// The kind of a word.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    Constant(u64),
    /// Set from outside.
    Pin,
    /// A word of a register, delay or memory read.
    State,
    Step(Kind, Step),
}

/// Words of nodes: node `id` has those from `first[id]` on.
#[derive(Debug)]
pub(super) struct Lowered {
    pub sources: Vec<Source>,
    pub words: Vec<Word>,
    /// By flat node: index into `words`, or [`DEAD`].
    pub first: Vec<u32>,
    /// By port of the top: index into `words`, for inputs.
    pub pins: Vec<u32>,
    /// State nodes, operands first.
    pub state: Vec<FlatId>,
    constants: HashMap<u64, Word>,
}

/// The place of a dead node.
pub(super) const DEAD: u32 = u32::MAX;

/// The number of words in a value of `width` bits.
pub(super) fn word_count(width: u32) -> usize {
    width.div_ceil(64) as usize
}

/// The number of bits in word `index` of a value of `width` bits.
pub(super) fn word_bits(width: u32, index: usize) -> u32 {
    (width - 64 * index as u32).min(64)
}

impl Lowered {
    /// Lowers the nodes in `order`.
    pub(super) fn new(flat: &Flat, order: &[FlatId]) -> Self {
        let mut lowered = Self {
            sources: Vec::new(),
            words: Vec::new(),
            first: vec![DEAD; flat.links.len()],
            pins: Vec::new(),
            state: Vec::new(),
            constants: HashMap::new(),
        };
        for port in &flat.scopes[0].module.ports {
            lowered.pins.push(lowered.words.len() as u32);
            if !port.output {
                let words: Vec<Word> = (0..word_count(port.width)).map(|_| lowered.push(Source::Pin)).collect();
                lowered.words.extend(words);
            }
        }
        for &id in order {
            lowered.lower(flat, id);
        }
        lowered
    }

    /// The words of a lowered node, least significant first.
    pub(super) fn of(&self, flat: &Flat, id: FlatId) -> &[Word] {
        let first = self.first[id] as usize;
        &self.words[first..first + word_count(flat.node(id).width)]
    }

    fn push(&mut self, source: Source) -> Word {
        self.sources.push(source);
        (self.sources.len() - 1) as Word
    }

    fn constant(&mut self, value: u64) -> Word {
        if let Some(&word) = self.constants.get(&value) {
            return word;
        }
        let word = self.push(Source::Constant(value));
        self.constants.insert(value, word);
        word
    }

    fn step(&mut self, kind: Kind, operands: [Word; 3], immediate: u32) -> Word {
        let [a, b, c] = operands;
        self.push(Source::Step(kind, Step { a, b, c, immediate }))
    }

    fn is_zero(&self, word: Word) -> bool {
        matches!(self.sources[word as usize], Source::Constant(0))
    }

    fn lower(&mut self, flat: &Flat, id: FlatId) {
        let node = flat.node(id);
        let count = word_count(node.width);
        let words: Vec<Word> = match &flat.links[id] {
            Link::Alias(source) => {
                self.first[id] = self.first[*source];
                return;
            }
            Link::Pin(port) => {
                self.first[id] = self.pins[*port];
                return;
            }
            Link::Number(number) => self.number(u128::from(*number), count),
            Link::Own if is_state(&node.op) => {
                self.state.push(id);
                (0..count).map(|_| self.push(Source::State)).collect()
            }
            Link::Own => {
                let operands: Vec<Vec<Word>> =
                    flat.beside(id, &node.operands).map(|operand| self.of(flat, operand).to_vec()).collect();
                let widths: Vec<u32> = flat.beside(id, &node.operands).map(|o| flat.node(o).width).collect();
                match node.op {
                    Op::Parameter(index) => self.number(u128::from(flat.scope(id).parameters[index]), count),
                    _ => self.compute(node, &operands, &widths),
                }
            }
        };
        self.first[id] = self.words.len() as u32;
        self.words.extend(words);
    }

    fn number(&mut self, value: u128, count: usize) -> Vec<Word> {
        let part = |index: usize| if index < 2 { (value >> (64 * index)) as u64 } else { 0 };
        (0..count).map(|index| self.constant(part(index))).collect()
    }

    fn compute(&mut self, node: &Node, operands: &[Vec<Word>], widths: &[u32]) -> Vec<Word> {
        let count = word_count(node.width);
        let bits = |index| word_bits(node.width, index);
        match node.op {
            Op::Constant(value) => self.number(value, count),
            Op::Not => (0..count)
                .map(|i| {
                    let a = operands[0][i];
                    self.step(Kind::Not, [a; 3], bits(i))
                })
                .collect(),
            Op::And => self.bitwise(Kind::And, operands),
            Op::Or => self.bitwise(Kind::Or, operands),
            Op::Xor => self.bitwise(Kind::Xor, operands),
            Op::Add => self.sum(operands, node.width, [Kind::Add, Kind::AddCarry, Kind::CarryOut]),
            Op::Sub => self.sum(operands, node.width, [Kind::Sub, Kind::SubBorrow, Kind::BorrowOut]),
            Op::SubAdd => {
                let terms = &operands[..2];
                let sum = self.sum(terms, node.width, [Kind::Add, Kind::AddCarry, Kind::CarryOut]);
                let difference = self.sum(terms, node.width, [Kind::Sub, Kind::SubBorrow, Kind::BorrowOut]);
                let pairs = sum.into_iter().zip(difference);
                pairs.map(|(sum, difference)| self.step(Kind::Mux, [operands[2][0], sum, difference], 0)).collect()
            }
            Op::Mul => self.product(&operands[0], &operands[1], count),
            Op::Equal => {
                let equal = self.bitwise(Kind::Equal, operands);
                vec![self.reduce(Kind::And, &equal)]
            }
            Op::Less => {
                let pairs = operands[0].iter().zip(&operands[1]);
                let mut less = None;
                for (&a, &b) in pairs {
                    less = Some(match less {
                        None => self.step(Kind::Less, [a, b, a], 0),
                        Some(below) => self.step(Kind::LessOr, [a, b, below], 0),
                    });
                }
                less.into_iter().collect()
            }
            Op::Mux => {
                (0..count).map(|i| self.step(Kind::Mux, [operands[0][0], operands[1][i], operands[2][i]], 0)).collect()
            }
            Op::Case { .. } => {
                let word = |value: &Vec<Word>, i: usize| value[i];
                (0..count)
                    .map(|i| {
                        let values = operands[1..].iter().map(|value| word(value, i)).collect();
                        self.choose(values, operands[0][0], widths[0])
                    })
                    .collect()
            }
            Op::Concat => self.concat(node, operands, widths),
            Op::Slice { low } => (0..count).map(|i| self.slice(&operands[0], widths[0], low, bits(i), i)).collect(),
            Op::OneHot => (0..count).map(|i| self.step(Kind::OneHot, [operands[0][0]; 3], i as u32)).collect(),
            Op::Lookup(ref table) => (0..count).map(|i| self.lookup(table, &operands[0], i)).collect(),
            Op::Any => {
                let any = self.reduce(Kind::Or, &operands[0]);
                vec![self.step(Kind::Any, [any; 3], 0)]
            }
            Op::All => {
                let all: Vec<Word> = operands[0]
                    .iter()
                    .enumerate()
                    .map(|(i, &a)| self.step(Kind::All, [a; 3], word_bits(widths[0], i)))
                    .collect();
                vec![self.reduce(Kind::And, &all)]
            }
            // Linked or handled by the caller.
            Op::Input
            | Op::Parameter(_)
            | Op::Delay { .. }
            | Op::Register { .. }
            | Op::MemoryRead { .. }
            | Op::InstanceOutput { .. }
            | Op::Wire => self.number(0, count),
        }
    }

    /// Word `index` of a table's word.
    fn lookup(&mut self, table: &[u128], address: &[Word], index: usize) -> Word {
        let part = |word: &u128| if index < 2 { (*word >> (64 * index)) as u64 } else { 0 };
        let words: Vec<Word> = table.iter().map(|word| self.constant(part(word))).collect();
        self.choose(words, address[0], table.len().ilog2())
    }

    /// The word whose place is a number of this many bits, or the last word: a tree of selections, by the number from
    /// its lowest bit on.
    fn choose(&mut self, mut words: Vec<Word>, number: Word, bits: u32) -> Word {
        let last = words[words.len() - 1];
        words.resize(1 << bits, last);
        for bit in 0..bits {
            let chosen = self.step(Kind::Slice, [number; 3], field(bit, 1));
            words = words
                .chunks(2)
                .map(|pair| match *pair {
                    [no, yes] if no != yes => self.step(Kind::Mux, [chosen, yes, no], 0),
                    _ => pair[0],
                })
                .collect();
        }
        words[0]
    }

    fn bitwise(&mut self, kind: Kind, operands: &[Vec<Word>]) -> Vec<Word> {
        operands[0].iter().zip(&operands[1]).map(|(&a, &b)| self.step(kind, [a, b, a], 0)).collect()
    }

    fn reduce(&mut self, kind: Kind, words: &[Word]) -> Word {
        let (first, rest) = words.split_first().unwrap_or((&0, &[]));
        rest.iter().fold(*first, |all, &word| self.step(kind, [all, word, all], 0))
    }

    /// A sum or difference: one step for one word, and a chain of carries for more.
    fn sum(&mut self, operands: &[Vec<Word>], width: u32, [alone, chained, carry_out]: [Kind; 3]) -> Vec<Word> {
        let (left, right) = (&operands[0], &operands[1]);
        if width <= 64 {
            return vec![self.step(alone, [left[0], right[0], left[0]], width)];
        }
        let mut carry = self.constant(0);
        let mut words = Vec::with_capacity(left.len());
        for (index, (&a, &b)) in left.iter().zip(right).enumerate() {
            words.push(self.step(chained, [a, b, carry], word_bits(width, index)));
            if index + 1 < left.len() {
                carry = self.step(carry_out, [a, b, carry], 0);
            }
        }
        words
    }

    /// The schoolbook product, truncated to `count` words.
    fn product(&mut self, left: &[Word], right: &[Word], count: usize) -> Vec<Word> {
        let zero = self.constant(0);
        let mut total = vec![zero; count];
        for (i, &a) in left.iter().enumerate() {
            let mut carry = zero;
            for (j, &b) in right.iter().enumerate() {
                let low = self.step(Kind::MulLow, [a, b, a], 0);
                let has_high = i + j + 1 < count;
                let high = if has_high { self.step(Kind::MulHigh, [a, b, a], 0) } else { zero };
                let (with_low, first) = self.add_word(total[i + j], low);
                let (sum, second) = self.add_word(with_low, carry);
                total[i + j] = sum;
                // The high word is at most 2^64 - 2, and only one of the carries can be set when it is.
                carry = [first, second].into_iter().fold(high, |all, c| self.add_word(all, c).0);
            }
            if let Some(above) = total.get_mut(i + right.len()) {
                *above = carry;
            }
        }
        total
    }

    /// Sum and carry of two words.
    fn add_word(&mut self, a: Word, b: Word) -> (Word, Word) {
        let zero = self.constant(0);
        match (self.is_zero(a), self.is_zero(b)) {
            (true, _) => (b, zero),
            (_, true) => (a, zero),
            _ => (self.step(Kind::Add, [a, b, a], 64), self.step(Kind::CarryOut, [a, b, zero], 0)),
        }
    }

    /// Word `index`, of `bits` bits, of the part of `operand` from `low` on.
    fn slice(&mut self, operand: &[Word], width: u32, low: u32, bits: u32, index: usize) -> Word {
        let start = low as usize + 64 * index;
        let (word, shift) = (start / 64, (start % 64) as u32);
        let a = operand[word];
        if shift == 0 && bits == word_bits(width, word) {
            a
        } else if shift + bits <= 64 {
            self.step(Kind::Slice, [a; 3], field(shift, bits))
        } else {
            self.step(Kind::Funnel, [a, operand[word + 1], a], field(shift, bits))
        }
    }

    fn concat(&mut self, node: &Node, operands: &[Vec<Word>], widths: &[u32]) -> Vec<Word> {
        if widths[0] == 1 && node.operands.iter().all(|operand| *operand == node.operands[0]) {
            let bit = operands[0][0];
            let bits = |index| word_bits(node.width, index);
            return (0..word_count(node.width)).map(|i| self.step(Kind::Spread, [bit; 3], bits(i))).collect();
        }
        let mut words = Vec::with_capacity(word_count(node.width));
        // The word that is being filled from its low end, and the number of its bits that are filled.
        let (mut current, mut filled) = (self.constant(0), 0);
        for (part, &width) in operands.iter().zip(widths).rev() {
            for (index, &word) in part.iter().enumerate() {
                let bits = word_bits(width, index);
                current = match filled {
                    0 => word,
                    _ if self.is_zero(word) => current,
                    _ => self.step(Kind::Join, [word, current, word], filled),
                };
                filled += bits;
                if filled >= 64 {
                    words.push(current);
                    filled -= 64;
                    current = match filled {
                        0 => self.constant(0),
                        _ if self.is_zero(word) => word,
                        _ => self.step(Kind::Slice, [word; 3], field(bits - filled, filled)),
                    };
                }
            }
        }
        if filled > 0 {
            words.push(current);
        }
        words
    }
}
