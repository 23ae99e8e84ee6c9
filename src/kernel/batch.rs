//! The binary32 kernel over many pairs at once: a structure of arrays, as wide as the processor's SIMD registers.
//!
//! It runs the same [`contact`](super::contact) with `f32` in a loop without branches, which the compiler turns into
//! SIMD code. The loop is compiled for several instruction sets, and the program selects one when it runs. None of them
//! fuses or reorders operations, so all give the same bits.
//!
//! What runs once per pair uses neither `zip` nor `map` on arrays. Both call functions that the standard library does
//! not mark for inlining. Where parts of a crate are optimised separately, as in the profile of tests, such a call
//! prevents SIMD code.

use super::reference::native;
use crate::query::{CONTACT_WORDS, ContactRecord, Fields, PAIR_WORDS, PairRecord, Query};

/// Records per block. A column fills whole registers at every level, and a block of pairs with its block of contacts
/// takes 4 KiB.
const LANES: usize = 64;

/// A block of records by column: all first words, then all second words, and so on.
///
/// A column over the whole batch would be simpler, but its sixteen streams through memory evict one another from the
/// cache.
#[derive(Clone, Debug, PartialEq, Eq)]
#[repr(align(64))]
struct Block([[u32; LANES]; WORDS]);

/// Words of a record of either kind.
const WORDS: usize = if PAIR_WORDS > CONTACT_WORDS { PAIR_WORDS } else { CONTACT_WORDS };

/// A batch of records as a structure of arrays. The padding of the last block is zero.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Batch {
    blocks: Vec<Block>,
    count: usize,
}

impl Batch {
    /// `count` records of zeros: room for contacts.
    pub fn zeros(count: usize) -> Self {
        Self { blocks: vec![Block([[0; LANES]; WORDS]); count.div_ceil(LANES)], count }
    }

    /// The batch that holds these pairs.
    pub fn from_pairs(pairs: &[PairRecord]) -> Self {
        let mut batch = Self::zeros(pairs.len());
        for (block, pairs) in batch.blocks.iter_mut().zip(pairs.chunks(LANES)) {
            for (lane, pair) in pairs.iter().enumerate() {
                for (column, &word) in block.0.iter_mut().zip(&pair.0) {
                    column[lane] = word;
                }
            }
        }
        batch
    }

    /// The contacts in a batch of contacts, in order.
    pub fn contacts(&self) -> impl Iterator<Item = ContactRecord> + '_ {
        let record = |block: &Block, lane: usize| ContactRecord(std::array::from_fn(|word| block.0[word][lane]));
        (0..self.count).map(move |i| record(&self.blocks[i / LANES], i % LANES))
    }

    /// The number of records.
    pub fn len(&self) -> usize {
        self.count
    }

    /// True if there are no records.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// An instruction set that the kernel is compiled for.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    name: &'static str,
    run: Run,
}

/// Computes the contacts of pairs, block by block. Unsafe if the processor lacks the instruction set.
type Run = unsafe fn(&[Block], &mut [Block], Fields);

impl Level {
    /// The level that every processor of the target can run.
    pub(crate) const PORTABLE: Self = Self { name: "portable", run: portable };

    /// The levels of this processor, slowest first.
    pub fn available() -> Vec<Self> {
        #[allow(unused_mut)]
        let mut levels = vec![Self::PORTABLE];
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx2") {
                levels.push(Self { name: "AVX2", run: avx2 });
            }
            if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq") {
                levels.push(Self { name: "AVX-512", run: avx512 });
            }
        }
        levels
    }

    /// The fastest level of this processor.
    pub fn best() -> Self {
        Self::available().pop().unwrap_or(Self::PORTABLE)
    }

    /// The usual name of the instruction set.
    pub const fn name(self) -> &'static str {
        self.name
    }

    /// Writes the contacts of `pairs` to `contacts`, with the bits of the binary32 [`Reference`](super::Reference).
    ///
    /// # Panics
    /// If the two batches differ in length.
    pub fn run(self, pairs: &Batch, contacts: &mut Batch, fields: Fields) {
        assert_eq!(pairs.len(), contacts.len(), "as many contacts as pairs");
        // SAFETY: `available` returns a level only if the processor has its instruction set.
        unsafe { (self.run)(&pairs.blocks, &mut contacts.blocks, fields) }
    }
}

fn portable(pairs: &[Block], contacts: &mut [Block], fields: Fields) {
    blocks(pairs, contacts, fields);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2(pairs: &[Block], contacts: &mut [Block], fields: Fields) {
    blocks(pairs, contacts, fields);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq")]
fn avx512(pairs: &[Block], contacts: &mut [Block], fields: Fields) {
    blocks(pairs, contacts, fields);
}

/// The loop that is compiled for each level. The bits of a field do not depend on the other fields, so two versions are
/// enough: with and without a root.
#[inline(always)]
fn blocks(pairs: &[Block], contacts: &mut [Block], fields: Fields) {
    // Computed once, because it takes as long as a block.
    let mut is_asked = [false; WORDS];
    ContactRecord::words(fields).for_each(|word| is_asked[word] = true);
    for (pairs, contacts) in pairs.iter().zip(contacts) {
        if fields == Fields::HIT {
            block(pairs, contacts, Fields::HIT);
            continue;
        }
        block(pairs, contacts, Fields::ALL);
        for (column, _) in contacts.0.iter_mut().zip(is_asked).filter(|(_, is_asked)| !is_asked) {
            column.fill(0);
        }
    }
}

#[inline(always)]
fn block(pairs: &Block, contacts: &mut Block, fields: Fields) {
    for lane in 0..LANES {
        let contact = native(Query::SphereSphere, &PairRecord(std::array::from_fn(|word| pairs.0[word][lane])), fields);
        for (word, column) in contacts.0.iter_mut().enumerate() {
            column[lane] = contact.0[word];
        }
    }
}
