//! Where records lie in lines: computed once, read by hardware, host and files alike.

use crate::config::{Config, Results};
use crate::kernel::Fields;

/// The record layout of a configuration. A record is its words in use, padded to a power of two; a line holds as many
/// as fit. With no field asked for, a contact is one bit. Where only contacts come back, each begins with its pair's
/// number, and with no field asked for it is that number alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    line_bits: u32,
    word_bits: u32,
    fields: Fields,
    results: Results,
}

/// Words of a pair: x y z r of each sphere.
const PAIR_WORDS: u32 = 8;

impl Layout {
    /// The layout of full pairs and of a contact with `fields` for each, in lines of `line_bits` (a power of two) bits.
    pub fn new(line_bits: u32, fields: Fields) -> Self {
        Self { line_bits, word_bits: 32, fields, results: Results::All }
    }

    /// The layout of a configuration, in lines of `line_bits` (a power of two) bits.
    pub fn of(line_bits: u32, config: &Config) -> Self {
        Self { results: config.results, ..Self::new(line_bits, config.contact) }
    }

    /// The fields of a contact.
    pub fn fields(&self) -> Fields {
        self.fields
    }

    /// The same records in words of `word_bits` bits. Only proofs have other than 32.
    pub fn with_words_of(self, word_bits: u32) -> Self {
        Self { word_bits, ..self }
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

    /// Which of a full contact's eight words are in the record, in order; empty where only the hit is asked for.
    pub fn contact_words(&self) -> Vec<usize> {
        if self.fields == Fields::HIT {
            return vec![];
        }
        let groups =
            [(self.fields.position, 0..3), (self.fields.normal, 3..6), (self.fields.depth, 6..7), (true, 7..8)];
        groups.into_iter().filter(|(used, _)| *used).flat_map(|(_, words)| words).collect()
    }

    /// Words of a record before those of the contact: the pair's number, where only contacts come back.
    pub fn number_words(&self) -> usize {
        usize::from(self.results == Results::Hits)
    }

    /// Bits a contact takes in a line.
    pub fn contact_bits(&self) -> u32 {
        ((self.number_words() + self.contact_words().len()) as u32 * self.word_bits).max(1).next_power_of_two()
    }

    /// Bits of a result as an SCPU gives it: the record in its line, or, where only contacts come back, the words that
    /// follow the number, of which there may be none.
    pub(super) fn result_bits(&self) -> u32 {
        match self.results {
            Results::All => self.contact_bits(),
            Results::Hits => self.contact_words().len() as u32 * self.word_bits,
        }
    }

    /// Contacts a destination line.
    pub fn contacts_per_line(&self) -> u32 {
        self.line_bits / self.contact_bits()
    }

    /// Source lines of a job of `pairs` pairs.
    pub fn source_lines(&self, pairs: u64) -> u64 {
        pairs.div_ceil(u64::from(self.pairs_per_line()))
    }

    /// Destination lines of `contacts` records: where all come back, as many as there are pairs.
    pub fn destination_lines(&self, contacts: u64) -> u64 {
        contacts.div_ceil(u64::from(self.contacts_per_line()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hit_begins_with_its_number() {
        let per_line = |contact: &str, results| {
            let config = Config { contact: contact.parse().expect("fields"), results, ..Config::default() };
            let layout = Layout::of(512, &config);
            (layout.contact_bits(), layout.contacts_per_line())
        };
        // Words in use: all eight, depth and flags, normal and flags; none.
        let all = [("hit,depth,normal,position", 256), ("depth", 64), ("normal", 128), ("hit", 1)];
        // One more.
        let hits = [("hit,depth,normal,position", 512), ("depth", 128), ("normal", 256), ("hit", 32)];
        for (contact, bits) in all {
            assert_eq!(per_line(contact, Results::All), (bits, 512 / bits), "{contact}");
        }
        for (contact, bits) in hits {
            assert_eq!(per_line(contact, Results::Hits), (bits, 512 / bits), "{contact}");
        }
    }
}
