//! Straight-line code over 64-bit words. Steps of one kind run together, in a tight loop instead of one jump per step.

use std::ops::Range;

/// The operation of a step on the words `a`, `b`, `c` and the immediate. Words are zero-extended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Kind {
    /// `!a`, immediate = bits.
    Not,
    And,
    Or,
    Xor,
    /// `a + b`, immediate = bits.
    Add,
    /// `a + b + c`, immediate = bits; `c` is 0 or 1.
    AddCarry,
    /// The carry out of 64 bits of `a + b + c`.
    CarryOut,
    /// `a - b`, immediate = bits.
    Sub,
    /// `a - b - c`, immediate = bits; `c` is 0 or 1.
    SubBorrow,
    /// The borrow out of 64 bits of `a - b - c`.
    BorrowOut,
    /// The low word of `a * b`.
    MulLow,
    /// The high word of `a * b`.
    MulHigh,
    Equal,
    Less,
    /// `a < b`, or `a == b` and `c`: a comparison continued from the words below.
    LessOr,
    /// `a ? b : c`.
    Mux,
    /// Bits of `a`; immediate = [`field`].
    Slice,
    /// Bits of `b` above `a`; immediate = [`field`], its shift 1 to 63.
    Funnel,
    /// `a << immediate | b`, immediate 1 to 63.
    Join,
    /// The bit `a` repeated, immediate = bits.
    Spread,
    Any,
    /// All of `a`'s bits are set, immediate = bits.
    All,
    /// Word `immediate` of the value whose bit `a` alone is set.
    OneHot,
}

/// The number of kinds.
pub(super) const KINDS: usize = Kind::OneHot as usize + 1;

/// The immediate of a bit field: shift right by `low` (0 to 63), keep `bits` (1 to 64).
pub(super) fn field(low: u32, bits: u32) -> u32 {
    low | bits << 8
}

/// The lowest `bits` bits, 1 to 64.
#[inline(always)]
pub(super) fn mask(bits: u32) -> u64 {
    u64::MAX >> ((64 - bits) & 63)
}

/// One step; it writes the word after that of the step before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub a: u32,
    pub b: u32,
    pub c: u32,
    pub immediate: u32,
}

/// Steps in order. Step `i` writes word `first + i`, and reads only earlier words.
#[derive(Clone, Debug, Default)]
pub(super) struct Tape {
    pub first: usize,
    pub steps: Vec<Step>,
    pub runs: Vec<(Kind, Range<usize>)>,
}

impl Tape {
    /// Computes every step's word from the words before it.
    pub(super) fn run(&self, words: &mut [u64]) {
        for (kind, range) in &self.runs {
            let steps = &self.steps[range.clone()];
            let first = self.first + range.start;
            // One monomorphic loop per kind, into which the closures are inlined.
            match kind {
                Kind::Not => each(words, first, steps, |w, s| !at(w, s.a) & mask(s.immediate)),
                Kind::And => each(words, first, steps, |w, s| at(w, s.a) & at(w, s.b)),
                Kind::Or => each(words, first, steps, |w, s| at(w, s.a) | at(w, s.b)),
                Kind::Xor => each(words, first, steps, |w, s| at(w, s.a) ^ at(w, s.b)),
                Kind::Add => each(words, first, steps, |w, s| at(w, s.a).wrapping_add(at(w, s.b)) & mask(s.immediate)),
                Kind::AddCarry => each(words, first, steps, |w, s| {
                    at(w, s.a).wrapping_add(at(w, s.b)).wrapping_add(at(w, s.c)) & mask(s.immediate)
                }),
                Kind::CarryOut => each(words, first, steps, |w, s| {
                    ((u128::from(at(w, s.a)) + u128::from(at(w, s.b)) + u128::from(at(w, s.c))) >> 64) as u64
                }),
                Kind::Sub => each(words, first, steps, |w, s| at(w, s.a).wrapping_sub(at(w, s.b)) & mask(s.immediate)),
                Kind::SubBorrow => each(words, first, steps, |w, s| {
                    at(w, s.a).wrapping_sub(at(w, s.b)).wrapping_sub(at(w, s.c)) & mask(s.immediate)
                }),
                Kind::BorrowOut => each(words, first, steps, |w, s| {
                    u64::from(u128::from(at(w, s.a)) < u128::from(at(w, s.b)) + u128::from(at(w, s.c)))
                }),
                Kind::MulLow => each(words, first, steps, |w, s| at(w, s.a).wrapping_mul(at(w, s.b))),
                Kind::MulHigh => {
                    each(words, first, steps, |w, s| ((u128::from(at(w, s.a)) * u128::from(at(w, s.b))) >> 64) as u64)
                }
                Kind::Equal => each(words, first, steps, |w, s| u64::from(at(w, s.a) == at(w, s.b))),
                Kind::Less => each(words, first, steps, |w, s| u64::from(at(w, s.a) < at(w, s.b))),
                Kind::LessOr => each(words, first, steps, |w, s| {
                    let (a, b) = (at(w, s.a), at(w, s.b));
                    u64::from(a < b) | (u64::from(a == b) & at(w, s.c))
                }),
                Kind::Mux => each(words, first, steps, |w, s| {
                    // By mask: conditions are data, and a mispredicted branch costs more than the whole step.
                    let chosen = at(w, s.a).wrapping_neg();
                    (at(w, s.b) & chosen) | (at(w, s.c) & !chosen)
                }),
                Kind::Slice => {
                    each(words, first, steps, |w, s| (at(w, s.a) >> (s.immediate & 63)) & mask(s.immediate >> 8))
                }
                Kind::Funnel => each(words, first, steps, |w, s| {
                    let low = s.immediate & 63;
                    ((at(w, s.a) >> low) | (at(w, s.b) << (64 - low))) & mask(s.immediate >> 8)
                }),
                Kind::Join => each(words, first, steps, |w, s| (at(w, s.a) << (s.immediate & 63)) | at(w, s.b)),
                Kind::Spread => each(words, first, steps, |w, s| at(w, s.a).wrapping_neg() & mask(s.immediate)),
                Kind::Any => each(words, first, steps, |w, s| u64::from(at(w, s.a) != 0)),
                Kind::All => each(words, first, steps, |w, s| u64::from(at(w, s.a) == mask(s.immediate))),
                Kind::OneHot => each(words, first, steps, |w, s| {
                    let index = at(w, s.a);
                    u64::from(index >> 6 == u64::from(s.immediate)) << (index & 63)
                }),
            }
        }
    }
}

#[inline(always)]
fn at(words: &[u64], index: u32) -> u64 {
    words[index as usize]
}

#[inline(always)]
fn each(words: &mut [u64], first: usize, steps: &[Step], compute: impl Fn(&[u64], &Step) -> u64) {
    for (offset, step) in steps.iter().enumerate() {
        words[first + offset] = compute(words, step);
    }
}
