//! Reads contacts from lines by the layout: the reverse of [`pack`](super::pack). Records here have binary32 words;
//! lines hold the layout's number format, from which the words are widened.

use super::Layout;
use super::pack::{DWORD, Line, SIGN, get};
use crate::kernel::widen;
use crate::query::{ContactRecord, DEPTH, FLAGS, Flow};

/// Destination lines, read as records.
pub(crate) struct Contacts<'a> {
    layout: &'a Layout,
    words: Vec<usize>,
    lines: &'a [Option<Line>],
}

impl<'a> Contacts<'a> {
    pub(crate) fn new(layout: &'a Layout, lines: &'a [Option<Line>]) -> Self {
        Self { layout, words: layout.contact_words(), lines }
    }

    /// The line of the record with this index, and its slot in the line.
    fn place(&self, index: usize) -> (usize, usize) {
        let per_line = self.layout.contacts_per_line() as usize;
        (index / per_line, index % per_line)
    }

    /// The line of the record with this index: the index of its pair or, with `Results::Hits`, of its hit.
    #[cfg_attr(not(feature = "cosim"), allow(dead_code))] // for `verify` alone
    pub(crate) fn line(&self, index: usize) -> usize {
        self.place(index).0
    }

    /// The contact with this index; `None` if its line was never written. Words that are not in the record are zero. A
    /// record without words of a contact only tells whether the pair touches: it reads as real or fake.
    pub(crate) fn get(&self, index: usize) -> Option<ContactRecord> {
        self.record(index).map(|(_, contact)| contact)
    }

    /// With `Results::Hits`, the contact with this index and the index of its pair.
    #[cfg_attr(not(feature = "cosim"), allow(dead_code))] // for `verify` alone
    pub(crate) fn hit(&self, index: usize) -> Option<(u32, ContactRecord)> {
        let (number, contact) = self.record(index)?;
        Some((number?, contact))
    }

    fn record(&self, index: usize) -> Option<(Option<u32>, ContactRecord)> {
        let (line, place) = self.place(index);
        let line = self.lines.get(line)?.as_ref()?;
        let mut record = ContactRecord::default();
        let first = place * self.layout.contact_bits() as usize;
        let (number_bits, bits) = (self.layout.number_bits(), self.layout.word_bits());
        let number = (number_bits > 0).then(|| get(line, first, number_bits));
        if self.words.is_empty() {
            let hit = number.is_some() || get(line, first, 1) == 1;
            record.0[FLAGS] = if hit { Flow::Real } else { Flow::Fake }.flags();
        }
        for (slot, &word) in self.words.iter().enumerate() {
            let short = get(line, first + number_bits as usize + slot * bits as usize, bits);
            record.0[word] = if word == FLAGS { short } else { widen(short, self.layout.record().format()) };
        }
        if self.layout.sign_is_flow() {
            let flow = if record.0[DEPTH] & SIGN == 0 { Flow::Real } else { Flow::Coincident };
            record.0[DEPTH] &= !SIGN;
            record.0[FLAGS] = flow.flags();
        }
        Some((number, record))
    }

    /// The part of the reference's record that destination memory holds, in the form of [`Contacts::get`].
    #[cfg_attr(not(feature = "cosim"), allow(dead_code))] // for `verify` alone
    pub(crate) fn as_stored(&self, record: ContactRecord) -> ContactRecord {
        let mut stored = ContactRecord::default();
        if self.layout.sign_is_flow() {
            stored.0[FLAGS] = record.flags();
        } else if self.words.is_empty() {
            stored.0[FLAGS] = if record.is_contact() { Flow::Real } else { Flow::Fake }.flags();
        }
        for &word in &self.words {
            stored.0[word] = record.0[word];
        }
        stored
    }

    /// True if the padding is zero: after `count` contacts, in each slot and at the end of the last line.
    #[cfg_attr(not(feature = "cosim"), allow(dead_code))] // for `verify` alone
    pub(crate) fn rest_is_zero(&self, count: usize) -> bool {
        let bits = self.layout.contact_bits() as usize;
        let used = self.layout.used_bits() as usize;
        let per_line = self.layout.contacts_per_line() as usize;
        let clean = |(number, line): (usize, &Option<Line>)| {
            let Some(line) = line else { return true };
            let mut rest = *line;
            for place in 0..per_line.min(count - (number * per_line).min(count)) {
                for bit in place * bits..place * bits + used {
                    rest[bit / DWORD] &= !(1 << (bit % DWORD));
                }
            }
            rest == [0; 16]
        };
        self.lines.iter().enumerate().all(clean)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{pack, pack_contacts, unpack_pairs};
    use super::*;
    use crate::config::{Config, RecordFormat, Results};
    use crate::kernel::narrow;
    use crate::query::{Fields, PairRecord};

    fn records(count: u32) -> Vec<ContactRecord> {
        let flow = |i: u32| Flow::ALL[i as usize % 4].flags();
        (0..count).map(|i| ContactRecord([i, i + 1, i + 2, i + 3, i + 4, i + 5, i + 6, flow(i)])).collect()
    }

    /// Lines written word by word and bit by bit, as the design defines them.
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
                assert_eq!(contacts.get(i), Some(contacts.as_stored(*record)), "{fields}, {i}");
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
            // Indices with gaps, then the requested words, then padding to the next power of two.
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
                    if contact == "hit" { ContactRecord([0, 0, 0, 0, 0, 0, 0, 7]) } else { contacts.as_stored(record) };
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

    /// Four pairs and four contacts per line, in words of 16 bits; the index of a hit takes two of them.
    #[test]
    fn words_of_16_bits_read_back_what_was_rounded_to_them() {
        let halves =
            |line: &Line| -> Vec<u32> { line.iter().flat_map(|dword| [dword & 0xFFFF, dword >> 16]).collect() };
        let any = |i: u32| PairRecord(std::array::from_fn(|word| (8 * i + word as u32 + 1).wrapping_mul(0x9E37_79B9)));
        let sphere = |x: f32| [x, 0.3, -x, 0.7];
        let near = |i: u32| PairRecord::from_spheres(sphere(0.1), sphere(i as f32 / 32.0));
        let pairs: Vec<_> = (0..41).map(|i| if i % 2 == 0 { any(i) } else { near(i) }).collect();
        for (record, results) in [(RecordFormat::F16, Results::All), (RecordFormat::Bf16, Results::Hits)] {
            let layout = Layout::of(512, &Config { record, results, ..Config::default() });
            let lines = pack(&layout, &pairs);
            assert_eq!(lines.len(), 11);
            let words: Vec<u32> = lines.iter().flat_map(halves).collect();
            let expected: Vec<u32> =
                pairs.iter().flat_map(|pair| pair.0.map(|word| narrow(word, record.format()))).collect();
            assert_eq!(words[..expected.len()], expected);
            assert!(words[expected.len()..].iter().all(|&word| word == 0));
            let read = unpack_pairs(&layout, &lines, pairs.len());
            assert!(read.iter().zip(&pairs).all(|(read, pair)| *read == pair.rounded(record.format())));
            assert_eq!(pack(&layout, &read)[..10], lines[..10], "finite or infinite, none becomes another");

            let records: Vec<_> = Config { record, ..Config::default() }.reference().run_all(&pairs);
            let short = |contact: &ContactRecord| -> [u32; 8] {
                std::array::from_fn(|i| if i == 7 { contact.0[i] } else { narrow(contact.0[i], record.format()) })
            };
            let mut lines = vec![[0_u32; 16]; records.len().div_ceil(layout.contacts_per_line() as usize)];
            for (i, contact) in records.iter().enumerate() {
                let place = i % layout.contacts_per_line() as usize * layout.contact_bits() as usize / 16;
                let number = if results == Results::Hits {
                    vec![(i as u32 * 70_001) & 0xFFFF, (i as u32 * 70_001) >> 16]
                } else {
                    vec![]
                };
                for (slot, word) in number.into_iter().chain(short(contact)).enumerate() {
                    let at = place + slot;
                    lines[i / layout.contacts_per_line() as usize][at / 2] |= word << (16 * (at % 2));
                }
            }
            if results == Results::All {
                assert_eq!(pack_contacts(&layout, &records), lines);
            }
            let lines: Vec<_> = lines.into_iter().map(Some).collect();
            let contacts = Contacts::new(&layout, &lines);
            for (i, contact) in records.iter().enumerate() {
                assert_eq!(contacts.get(i), Some(*contact), "{record}, {i}");
                let number = contacts.hit(i).map(|(number, _)| number);
                assert_eq!(number, (results == Results::Hits).then_some(i as u32 * 70_001));
            }
            assert!(contacts.rest_is_zero(records.len()) && !contacts.rest_is_zero(records.len() - 1), "{record}");
        }
    }
}
