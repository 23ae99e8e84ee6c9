//! Records to lines and back, by the layout.

use crate::afu::Layout;
use crate::kernel::{ContactRecord, Flow, PairRecord};
use crate::link::Line;

/// Bits of a word.
const WORD: usize = 32;

/// The source lines of pairs; what is unused of the last is zero.
pub(crate) fn pack(layout: &Layout, pairs: &[PairRecord]) -> Vec<Line> {
    let (room, words) = (layout.pair_bits() as usize / WORD, layout.pair_words());
    let line = |pairs: &[PairRecord]| {
        let mut line: Line = [0; 16];
        for (slot, pair) in line.chunks_mut(room).zip(pairs) {
            slot.iter_mut().zip(&words).for_each(|(to, &word)| *to = pair.0[word]);
        }
        line
    };
    pairs.chunks(layout.pairs_per_line() as usize).map(line).collect()
}

/// The pairs of source lines.
pub(crate) fn unpack_pairs(layout: &Layout, lines: &[Line], count: usize) -> Vec<PairRecord> {
    let words = layout.pair_bits() as usize / WORD;
    let slots = lines.iter().flat_map(|line| line.chunks(words));
    slots.take(count).map(|slot| layout.pair(slot)).collect()
}

/// The destination lines of contacts where each pair has one; what is unused of the last is zero.
pub(crate) fn pack_contacts(layout: &Layout, records: &[ContactRecord]) -> Vec<Line> {
    let (words, bits) = (layout.contact_words(), layout.contact_bits() as usize);
    let line = |records: &[ContactRecord]| {
        let mut line: Line = [0; 16];
        for (place, record) in records.iter().enumerate() {
            let at = place * bits;
            if words.is_empty() {
                line[at / WORD] |= u32::from(record.is_contact()) << (at % WORD);
            }
            for (slot, &word) in words.iter().enumerate() {
                line[at / WORD + slot] = record.0[word];
            }
        }
        line
    };
    records.chunks(layout.contacts_per_line() as usize).map(line).collect()
}

/// Destination lines as records.
pub(crate) struct Contacts<'a> {
    layout: &'a Layout,
    words: Vec<usize>,
    lines: &'a [Option<Line>],
}

impl<'a> Contacts<'a> {
    pub(crate) fn new(layout: &'a Layout, lines: &'a [Option<Line>]) -> Self {
        Self { layout, words: layout.contact_words(), lines }
    }

    /// The line and the place in it of the record with this index.
    fn place(&self, index: usize) -> (usize, usize) {
        let per_line = self.layout.contacts_per_line() as usize;
        (index / per_line, index % per_line)
    }

    /// The line of the record with this index: a pair's number, or, where only contacts come back, how many come before.
    #[cfg_attr(not(feature = "cosim"), allow(dead_code))] // for `verify` alone
    pub(crate) fn line(&self, index: usize) -> usize {
        self.place(index).0
    }

    /// The contact with this index; nothing if its line was never written. Words that are not in the record are zero. Of
    /// records without words of the contact only the contact is known: it reads as real or fake.
    pub(crate) fn get(&self, index: usize) -> Option<ContactRecord> {
        self.record(index).map(|(_, contact)| contact)
    }

    /// The contact with this index where only contacts come back, with its pair's number before it.
    #[cfg_attr(not(feature = "cosim"), allow(dead_code))] // for `verify` alone
    pub(crate) fn hit(&self, index: usize) -> Option<(u32, ContactRecord)> {
        let (number, contact) = self.record(index)?;
        Some((number?, contact))
    }

    fn record(&self, index: usize) -> Option<(Option<u32>, ContactRecord)> {
        let (line, place) = self.place(index);
        let line = self.lines.get(line)?.as_ref()?;
        let mut record = ContactRecord::default();
        let first = place * self.layout.contact_bits() as usize / WORD;
        let behind = first + self.layout.number_words();
        let number = (behind > first).then(|| line[first]);
        if self.words.is_empty() {
            let hit = number.is_some() || line[place / WORD] >> (place % WORD) & 1 == 1;
            record.0[7] = if hit { Flow::Real } else { Flow::Fake }.flags();
        }
        for (slot, &word) in self.words.iter().enumerate() {
            record.0[word] = line[behind + slot];
        }
        Some((number, record))
    }

    /// What of the reference's record is in destination memory, in the same form as [`Contacts::get`] gives it.
    #[cfg_attr(not(feature = "cosim"), allow(dead_code))] // for `verify` alone
    pub(crate) fn seen(&self, record: ContactRecord) -> ContactRecord {
        let mut seen = ContactRecord::default();
        if self.words.is_empty() {
            seen.0[7] = if record.is_contact() { Flow::Real } else { Flow::Fake }.flags();
        }
        for &word in &self.words {
            seen.0[word] = record.0[word];
        }
        seen
    }

    /// Whether everything behind the last of `count` contacts is zero, in each slot and at the end of the last line.
    #[cfg_attr(not(feature = "cosim"), allow(dead_code))] // for `verify` alone
    pub(crate) fn rest_is_zero(&self, count: usize) -> bool {
        let bits = self.layout.contact_bits() as usize;
        let used = ((self.layout.number_words() + self.words.len()) * WORD).max(1);
        let per_line = self.layout.contacts_per_line() as usize;
        let clean = |(number, line): (usize, &Option<Line>)| {
            let Some(line) = line else { return true };
            let mut rest = *line;
            for place in 0..per_line.min(count - (number * per_line).min(count)) {
                for bit in place * bits..place * bits + used {
                    rest[bit / WORD] &= !(1 << (bit % WORD));
                }
            }
            rest == [0; 16]
        };
        self.lines.iter().enumerate().all(clean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Config, Results};
    use crate::kernel::Fields;

    fn records(count: u32) -> Vec<ContactRecord> {
        let flow = |i: u32| Flow::ALL[i as usize % 4].flags();
        (0..count).map(|i| ContactRecord([i, i + 1, i + 2, i + 3, i + 4, i + 5, i + 6, flow(i)])).collect()
    }

    /// Lines written word by word and bit by bit, as the design words it.
    fn lines(layout: &Layout, fields: Fields, records: &[ContactRecord]) -> Vec<Option<Line>> {
        let mut lines = vec![[0; 16]; records.len().div_ceil(layout.contacts_per_line() as usize)];
        let bits = layout.contact_bits() as usize;
        let per_line = layout.contacts_per_line() as usize;
        for (i, record) in records.iter().enumerate() {
            let at = i % per_line * bits;
            if fields == Fields::HIT {
                lines[i / per_line][at / 32] |= (record.flags() & 1) << (at % 32);
                continue;
            }
            let asked = [(0..3, fields.position), (3..6, fields.normal), (6..7, fields.depth), (7..8, true)];
            let words = asked.into_iter().filter(|(_, asked)| *asked).flat_map(|(words, _)| words);
            for (slot, word) in words.enumerate() {
                lines[i / per_line][at / 32 + slot] = record.0[word];
            }
        }
        lines.into_iter().map(Some).collect()
    }

    #[test]
    fn every_layout_reads_back_what_it_holds() {
        for mask in 0..8 {
            let fields = Fields { depth: mask & 1 != 0, normal: mask & 2 != 0, position: mask & 4 != 0 };
            let layout = Layout::new(512, fields);
            let records = records(1025);
            let mut lines = lines(&layout, fields, &records);
            assert_eq!(pack_contacts(&layout, &records).into_iter().map(Some).collect::<Vec<_>>(), lines, "{fields}");
            let contacts = Contacts::new(&layout, &lines);
            for (i, record) in records.iter().enumerate() {
                assert_eq!(contacts.get(i), Some(contacts.seen(*record)), "{fields}, {i}");
            }
            assert!(contacts.rest_is_zero(records.len()), "{fields}");
            assert!(!contacts.rest_is_zero(records.len() - 2), "{fields}: a record behind the last is seen");
            let last = lines.len() - 1;
            lines[last].as_mut().expect("written")[15] |= 1 << 31;
            assert!(!Contacts::new(&layout, &lines).rest_is_zero(records.len()), "{fields}");
            lines[0] = None;
            assert_eq!(Contacts::new(&layout, &lines).get(0), None);
        }
    }

    #[test]
    fn hits_read_back_with_their_numbers() {
        for contact in ["hit", "depth", "depth,normal,position"] {
            let config =
                Config { contact: contact.parse().expect("fields"), results: Results::Hits, ..Config::default() };
            let layout = Layout::of(512, &config);
            let words = layout.contact_words();
            let per_line = layout.contacts_per_line() as usize;
            // Numbers with gaps, then the words asked for, then nothing up to the next power of two.
            let mut lines: Vec<Option<Line>> = vec![Some([0; 16]); 33_usize.div_ceil(per_line)];
            let records = records(33);
            for (i, record) in records.iter().enumerate() {
                let line = lines[i / per_line].as_mut().expect("there");
                let first = i % per_line * 16 / per_line;
                line[first] = 7 * i as u32;
                for (slot, &word) in words.iter().enumerate() {
                    line[first + 1 + slot] = record.0[word];
                }
            }
            let contacts = Contacts::new(&layout, &lines);
            for (i, &record) in records.iter().enumerate() {
                let known =
                    if contact == "hit" { ContactRecord([0, 0, 0, 0, 0, 0, 0, 7]) } else { contacts.seen(record) };
                assert_eq!(contacts.hit(i), Some((7 * i as u32, known)), "{contact}, {i}");
            }
            assert!(contacts.rest_is_zero(33) && !contacts.rest_is_zero(31), "{contact}");
        }
    }

    #[test]
    fn pairs_lie_two_a_line() {
        let layout = Layout::new(512, Fields::ALL);
        let pairs: Vec<_> = (0..3).map(|i| PairRecord(std::array::from_fn(|word| 8 * i + word as u32))).collect();
        let lines = pack(&layout, &pairs);
        assert_eq!(lines[0], std::array::from_fn(|word| word as u32));
        assert_eq!(lines[1], std::array::from_fn(|word| if word < 8 { 16 + word as u32 } else { 0 }));
        assert!(pack(&layout, &[]).is_empty());
        assert_eq!(unpack_pairs(&layout, &lines, 3), pairs);
    }
}
