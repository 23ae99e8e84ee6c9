//! Where records lie in lines: computed once, and used by hardware, host and files.

use crate::config::{self, Config, RecordFormat, Results};
use crate::query::{ContactRecord, FLAGS, Fields, Input, PairRecord, Query};

use super::COUNT_BITS;

/// The record layout of a configuration. A record is its words in use, padded to a power of two; a line holds as many
/// records as fit. If no field is asked for, a contact is one bit. With `Results::Hits` each record begins with the
/// 32-bit index of its pair; without fields it is that index only.
///
/// If spheres come in and contacts with their depth go out, the numbers of the two spheres stand in the place of the
/// index, and the depth's sign bit, which is otherwise 0, in the place of the flags: it is set if the centres
/// coincide. So a contact with all fields has eight words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    line_bits: u32,
    query: Query,
    /// The words of a pair, from its query.
    inputs: &'static [Input],
    record: RecordFormat,
    word_bits: u32,
    fields: Fields,
    results: Results,
    /// True if the depth's sign bit says what the flags would.
    sign_is_flow: bool,
    /// The word of all radii if records have no radii.
    radius: Option<u32>,
}

/// A pair of spheres with another radius than the hardware's.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "pair {pair}: expected {field} = {radius}, the radius of all spheres (--radius), found {found}; leave --radius out, or send spheres of that radius"
)]
pub struct OtherRadius {
    /// The index of the pair.
    pub pair: usize,
    /// The field, r1 or r2.
    pub field: &'static str,
    /// The radius of the pair.
    pub found: f32,
    /// The radius of the hardware.
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
        let sign_is_flow = config.input == config::Input::Spheres && fields.depth;
        let word_bits = record.format().width();
        Self { line_bits, query, inputs, record, word_bits, fields, results, sign_is_flow, radius }
    }

    /// The kind of pair.
    pub fn query(&self) -> Query {
        self.query
    }

    /// The fields of a contact.
    pub fn fields(&self) -> Fields {
        self.fields
    }

    /// The number format of the records.
    pub fn record(&self) -> RecordFormat {
        self.record
    }

    /// Bits of a word of a record.
    pub fn word_bits(&self) -> u32 {
        self.word_bits
    }

    /// The same records in words of `word_bits` bits. Only proofs use other widths than the record's.
    pub(crate) fn with_words_of(self, word_bits: u32) -> Self {
        Self { word_bits, ..self }
    }

    /// Bits of a line.
    pub fn line_bits(&self) -> u32 {
        self.line_bits
    }

    /// The words of a pair that are in the record, in order, each with its place in a [`PairRecord`]. Radii that are
    /// constants of the hardware are left out.
    pub fn inputs(&self) -> impl Iterator<Item = (usize, &'static Input)> + Clone {
        let fixed = self.radius.is_some();
        self.inputs.iter().enumerate().filter(move |(_, input)| !(fixed && input.is_radius))
    }

    /// The pair with these words of the record; radii that are constants of the hardware are filled in.
    pub fn pair(&self, words: impl IntoIterator<Item = u32>) -> PairRecord {
        let mut pair = PairRecord::default();
        if let Some(radius) = self.radius {
            // All words: those of the record are overwritten below.
            pair.0.fill(radius);
        }
        self.inputs().zip(words).for_each(|((place, _), value)| pair.0[place] = value);
        pair
    }

    /// Checks that records can represent these pairs.
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

    /// Bits of a pair in a line.
    pub fn pair_bits(&self) -> u32 {
        (self.inputs().count() as u32 * self.word_bits).next_power_of_two()
    }

    /// Pairs per source line.
    pub fn pairs_per_line(&self) -> u32 {
        self.line_bits / self.pair_bits()
    }

    /// The words of a [`ContactRecord`] that are in the record, in order; empty if only the hit is asked for.
    pub fn contact_words(&self) -> Vec<usize> {
        ContactRecord::words(self.fields).filter(|&word| !(self.sign_is_flow && word == FLAGS)).collect()
    }

    /// True if there are no flags, because the depth's sign bit is set if the centres of a contact coincide.
    pub(crate) fn sign_is_flow(&self) -> bool {
        self.sign_is_flow
    }

    /// Bits of a record before the words of its contact: the index of its pair with `Results::Hits`, else 0.
    pub(crate) fn number_bits(&self) -> u32 {
        if self.results == Results::Hits { COUNT_BITS } else { 0 }
    }

    /// Bits of a record in use, without the padding to a power of two.
    pub(crate) fn used_bits(&self) -> u32 {
        (self.number_bits() + self.contact_words().len() as u32 * self.word_bits).max(1)
    }

    /// Bits of a contact in a line, with padding.
    pub(crate) fn contact_bits(&self) -> u32 {
        self.used_bits().next_power_of_two()
    }

    /// Bits of a result at the output of an SCPU: the record in its line or, with `Results::Hits`, the words after the
    /// index, which may be none.
    pub(crate) fn result_bits(&self) -> u32 {
        match self.results {
            Results::All => self.contact_bits(),
            Results::Hits => self.contact_words().len() as u32 * self.word_bits,
        }
    }

    /// Contacts per destination line.
    pub(crate) fn contacts_per_line(&self) -> u32 {
        self.line_bits / self.contact_bits()
    }

    /// Source lines of a job of `pairs` pairs.
    pub fn source_lines(&self, pairs: u64) -> u64 {
        pairs.div_ceil(u64::from(self.pairs_per_line()))
    }

    /// Destination lines of `contacts` records. With `Results::All` there is one record per pair.
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
        // All eight words, depth and flags, normal and flags, only the hit.
        let all = [("hit,depth,normal,position", 256), ("depth", 64), ("normal", 128), ("hit", 1)];
        // With the index, one word more.
        let hits = [("hit,depth,normal,position", 512), ("depth", 128), ("normal", 256), ("hit", 32)];
        for (contact, bits) in all {
            assert_eq!(per_line(contact, Results::All), (bits, 512 / bits), "{contact}");
        }
        for (contact, bits) in hits {
            assert_eq!(per_line(contact, Results::Hits), (bits, 512 / bits), "{contact}");
        }
    }

    /// Later queries may have up to sixteen words: then a pair fills a line, or half of one.
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
