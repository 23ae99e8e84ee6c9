//! Where records lie in lines: computed once, read by hardware, host and files alike.

use crate::kernel::Fields;

/// The record layout of a configuration. A record is its words in use, padded to a power of two; a line holds as many
/// as fit. With no field asked for, a contact is one bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    line_bits: u32,
    word_bits: u32,
    fields: Fields,
}

/// Words of a pair: x y z r of each sphere.
const PAIR_WORDS: u32 = 8;

impl Layout {
    /// The layout of full pairs and of contacts with `fields`, in lines of `line_bits` (a power of two) bits.
    pub fn new(line_bits: u32, fields: Fields) -> Self {
        Self { line_bits, word_bits: 32, fields }
    }

    /// Bits of a line.
    pub fn line_bits(&self) -> u32 {
        self.line_bits
    }

    /// Bits a pair takes in a line.
    pub fn pair_bits(&self) -> u32 {
        (PAIR_WORDS * self.word_bits).next_power_of_two()
    }

    /// Pairs a source line.
    pub fn pairs_per_line(&self) -> u32 {
        self.line_bits / self.pair_bits()
    }

    /// Which of a full contact's eight words are in the record, in order; empty for the one-bit record.
    pub fn contact_words(&self) -> Vec<usize> {
        if self.fields == Fields::HIT {
            return vec![];
        }
        let groups =
            [(self.fields.position, 0..3), (self.fields.normal, 3..6), (self.fields.depth, 6..7), (true, 7..8)];
        groups.into_iter().filter(|(used, _)| *used).flat_map(|(_, words)| words).collect()
    }

    /// Bits a contact takes in a line.
    pub fn contact_bits(&self) -> u32 {
        (self.contact_words().len() as u32 * self.word_bits).max(1).next_power_of_two()
    }

    /// Contacts a destination line.
    pub fn contacts_per_line(&self) -> u32 {
        self.line_bits / self.contact_bits()
    }

    /// Source lines of a job of `pairs` pairs.
    pub fn source_lines(&self, pairs: u64) -> u64 {
        pairs.div_ceil(u64::from(self.pairs_per_line()))
    }

    /// Destination lines of a job of `pairs` pairs.
    pub fn destination_lines(&self, pairs: u64) -> u64 {
        pairs.div_ceil(u64::from(self.contacts_per_line()))
    }
}
