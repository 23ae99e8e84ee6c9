//! The binary32 kernel over many pairs at once: structure of arrays, as wide as the processor allows.
//!
//! The same [`contact`](super::contact) again, read with `f32` in a loop without branches, which the compiler turns
//! into SIMD code. It is compiled once for each instruction set; which one runs is chosen when the program runs.
//! None of them fuses or reorders operations, so all give the same bits.

use super::reference::native;
use crate::query::{CONTACT_WORDS, ContactRecord, Fields, PAIR_WORDS, PairRecord, Query};

/// Records side by side in a block: whole registers of every level, and a block of pairs with its block of contacts
/// is 4 KiB.
const LANES: usize = 64;

/// Records by column: all first words of a block, then all its second words, and so on.
///
/// A column of a whole batch would be simpler, but sixteen streams through memory evict one another from a cache.
#[derive(Clone, Debug, PartialEq, Eq)]
#[repr(align(64))]
struct Block([[u32; LANES]; WORDS]);

/// Words of a record of either kind.
const WORDS: usize = if PAIR_WORDS > CONTACT_WORDS { PAIR_WORDS } else { CONTACT_WORDS };

/// A batch of records, structure of arrays. What the last block has over is zero words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Batch {
    blocks: Vec<Block>,
    count: usize,
}

impl Batch {
    /// `count` records of zero words: room for contacts.
    pub fn zeros(count: usize) -> Self {
        Self { blocks: vec![Block([[0; LANES]; WORDS]); count.div_ceil(LANES)], count }
    }

    /// The batch of some pairs.
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

    /// The contacts in a batch of contacts, in their order.
    pub fn contacts(&self) -> impl Iterator<Item = ContactRecord> + '_ {
        let record = |block: &Block, lane: usize| ContactRecord(std::array::from_fn(|word| block.0[word][lane]));
        (0..self.count).map(move |i| record(&self.blocks[i / LANES], i % LANES))
    }

    /// How many records there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// An instruction set the kernel is compiled for.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    name: &'static str,
    run: Run,
}

/// Contacts of pairs, block by block. Unsafe where the processor must have an instruction set.
type Run = unsafe fn(&[Block], &mut [Block], Fields);

impl Level {
    /// What every processor of the target has.
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

    /// The name people use.
    pub const fn name(self) -> &'static str {
        self.name
    }

    /// Puts the contacts of `pairs` into `contacts`: the bits of the binary32 [`Reference`](super::Reference).
    ///
    /// # Panics
    /// When the two differ in length.
    pub fn run(self, pairs: &Batch, contacts: &mut Batch, fields: Fields) {
        assert_eq!(pairs.len(), contacts.len(), "as many contacts as pairs");
        // SAFETY: a level exists only where `available` found its instruction set, or needs none.
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

/// The loop that is compiled for each level. A field's bits do not depend on what else is asked for, so two bodies
/// are enough: with and without a root.
#[inline(always)]
fn blocks(pairs: &[Block], contacts: &mut [Block], fields: Fields) {
    // Once, since a block takes no longer than this.
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
        for (column, word) in contacts.0.iter_mut().zip(contact.0) {
            column[lane] = word;
        }
    }
}
