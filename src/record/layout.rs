//! Where records lie in lines: computed once, read by hardware, host and files alike.

use crate::config::{Config, RecordFormat, Results};
use crate::query::{ContactRecord, Fields, Input, PairRecord, Query};

use super::COUNT_BITS;

/// The record layout of a configuration. A record is its words in use, padded to a power of two; a line holds as many
/// as fit. With no field asked for, a contact is one bit. Where only contacts come back, each begins with its pair's
/// number of 32 bits, and with no field asked for it is that number alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    line_bits: u32,
    query: Query,
    /// The words of a pair: those of the query.
    inputs: &'static [Input],
    record: RecordFormat,
    word_bits: u32,
    fields: Fields,
    results: Results,
    /// The word that every radius is, where records have none.
    radius: Option<u32>,
}

/// A pair of spheres that an AFU of one radius cannot be given.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "pair {pair}: expected {field} = {radius}, the radius of all spheres (--radius), found {found}; leave --radius out, or send spheres of that radius"
)]
pub struct OtherRadius {
    /// The pair's number.
    pub pair: usize,
    /// r1 or r2.
    pub field: &'static str,
    /// What it is.
    pub found: f32,
    /// What it is taken for.
    pub radius: f32,
}

impl Layout {
    /// The layout of full pairs of spheres and of a contact with `fields` for each, in lines of `line_bits` (a power of
    /// two) bits.
    pub fn new(line_bits: u32, fields: Fields) -> Self {
        Self::of(line_bits, &Config { contact: fields, ..Config::default() })
    }

    /// The layout of a configuration, in lines of `line_bits` (a power of two) bits.
    pub fn of(line_bits: u32, config: &Config) -> Self {
        let Config { query, record, results, contact: fields, .. } = *config;
        let (inputs, radius) = (query.shape().inputs, config.radius.map(f32::to_bits));
        Self { line_bits, query, inputs, record, word_bits: record.format().width(), fields, results, radius }
    }

    /// What is asked of a pair.
    pub fn query(&self) -> Query {
        self.query
    }

    /// The fields of a contact.
    pub fn fields(&self) -> Fields {
        self.fields
    }

    /// The numbers of the records.
    pub fn record(&self) -> RecordFormat {
        self.record
    }

    /// Bits of a record's word.
    pub fn word_bits(&self) -> u32 {
        self.word_bits
    }

    /// The same records in words of `word_bits` bits. Only proofs have other than the record's.
    pub(crate) fn with_words_of(self, word_bits: u32) -> Self {
        Self { word_bits, ..self }
    }

    /// Bits of a line.
    pub fn line_bits(&self) -> u32 {
        self.line_bits
    }

    /// The words of a pair that are in the record, in order, each with its place in a [`PairRecord`]: all but radii
    /// that are the hardware's.
    pub fn inputs(&self) -> impl Iterator<Item = (usize, &'static Input)> + Clone {
        let fixed = self.radius.is_some();
        self.inputs.iter().enumerate().filter(move |(_, input)| !(fixed && input.is_radius))
    }

    /// The pair whose words of the record are these; a radius that is the hardware's is put in its place.
    pub fn pair(&self, words: impl IntoIterator<Item = u32>) -> PairRecord {
        let mut pair = PairRecord::default();
        if let Some(radius) = self.radius {
            // Of all words, since those of the record follow.
            pair.0.fill(radius);
        }
        self.inputs().zip(words).for_each(|((place, _), value)| pair.0[place] = value);
        pair
    }

    /// Whether records say everything of these pairs.
    ///
    /// # Errors
    /// The first pair with another radius than the hardware's.
    pub fn check(&self, pairs: &[PairRecord]) -> Result<(), OtherRadius> {
        let Some(radius) = self.radius else { return Ok(()) };
        let radii = || self.inputs.iter().enumerate().filter(|(_, input)| input.is_radius);
        for (pair, record) in pairs.iter().enumerate() {
            if let Some((place, input)) = radii().find(|(place, _)| record.0[*place] != radius) {
                let [found, radius] = [record.0[place], radius].map(f32::from_bits);
                return Err(OtherRadius { pair, field: input.name, found, radius });
            }
        }
        Ok(())
    }

    /// Bits a pair takes in a line.
    pub fn pair_bits(&self) -> u32 {
        (self.inputs().count() as u32 * self.word_bits).next_power_of_two()
    }

    /// Pairs a source line.
    pub fn pairs_per_line(&self) -> u32 {
        self.line_bits / self.pair_bits()
    }

    /// Which words of a [`ContactRecord`] are in the record, in order; empty where only the hit is asked for.
    pub fn contact_words(&self) -> Vec<usize> {
        ContactRecord::words(self.fields).collect()
    }

    /// Bits of a record before those of the contact: the pair's number, where only contacts come back.
    pub(crate) fn number_bits(&self) -> u32 {
        if self.results == Results::Hits { COUNT_BITS } else { 0 }
    }

    /// Bits of a record in use: without what pads it to a power of two.
    pub(crate) fn used_bits(&self) -> u32 {
        (self.number_bits() + self.contact_words().len() as u32 * self.word_bits).max(1)
    }

    /// Bits a contact takes in a line.
    pub(crate) fn contact_bits(&self) -> u32 {
        self.used_bits().next_power_of_two()
    }

    /// Bits of a result as an SCPU gives it: the record in its line, or, where only contacts come back, the words that
    /// follow the number, of which there may be none.
    pub(crate) fn result_bits(&self) -> u32 {
        match self.results {
            Results::All => self.contact_bits(),
            Results::Hits => self.contact_words().len() as u32 * self.word_bits,
        }
    }

    /// Contacts a destination line.
    pub(crate) fn contacts_per_line(&self) -> u32 {
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
    use crate::query::Rule;

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

    /// Queries to come have up to sixteen words: then a pair fills a line, or half of one.
    #[test]
    fn a_pair_of_sixteen_words_fills_a_line() {
        static INPUTS: [Input; 16] = [Input::new("word", "any", Rule::Finite); 16];
        for (record, bits, per_line) in [(RecordFormat::F32, 512, 1), (RecordFormat::F16, 256, 2)] {
            let layout = Layout::of(512, &Config { record, ..Config::default() });
            for words in [9, 13, 16] {
                let layout = Layout { inputs: &INPUTS[..words], ..layout };
                assert_eq!((layout.pair_bits(), layout.pairs_per_line()), (bits, per_line));
                assert_eq!(layout.source_lines(7), 7_u64.div_ceil(per_line.into()));
            }
        }
    }

    #[test]
    fn words_of_16_bits_are_half_as_long_but_for_a_hit_s_number() {
        let of = |contact: &str, results, radius| {
            let contact = contact.parse().expect("fields");
            let config = Config { contact, results, radius, record: RecordFormat::F16, ..Config::default() };
            let layout = Layout::of(512, &config);
            assert_eq!((layout.pair_bits(), layout.pairs_per_line()), (128, 4), "six words are padded to eight");
            assert_eq!(layout.inputs().count(), if radius.is_some() { 6 } else { 8 });
            assert_eq!(layout.contacts_per_line() * layout.contact_bits(), 512);
            layout.contact_bits()
        };
        for radius in [None, Some(0.5)] {
            for (contact, all, hits) in
                [("hit,depth,normal,position", 128, 256), ("depth", 32, 64), ("normal", 64, 128), ("hit", 1, 32)]
            {
                assert_eq!(of(contact, Results::All, radius), all, "{contact}");
                assert_eq!(of(contact, Results::Hits, radius), hits, "{contact}");
            }
        }
    }
}
