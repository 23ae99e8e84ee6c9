//! Packs records into lines and reads pairs from lines, by the layout. Records here have binary32 words; lines hold the
//! layout's number format, to which the words are rounded.

use crate::kernel::{narrow, widen};
use crate::query::{ContactRecord, DEPTH, FLAGS, Flow, PairRecord};

use super::Layout;

/// A line's dwords, the lowest first.
pub(crate) type Line = [u32; 16];

/// The sign bit of a binary32 number.
pub(super) const SIGN: u32 = 1 << 31;

/// Bits of a dword of a line.
pub(super) const DWORD: usize = 32;

/// Puts a word of `bits` bits into zero bits of a line. The word lies within one dword.
fn put(line: &mut Line, at: usize, bits: u32, word: u32) {
    let mask = u32::MAX >> (DWORD as u32 - bits);
    line[at / DWORD] |= (word & mask) << (at % DWORD);
}

/// Reads a word of `bits` bits, which lies within one dword.
pub(super) fn get(line: &Line, at: usize, bits: u32) -> u32 {
    line[at / DWORD] >> (at % DWORD) & u32::MAX >> (DWORD as u32 - bits)
}

/// The source lines of pairs; the padding of the last line is zero.
pub(crate) fn pack(layout: &Layout, pairs: &[PairRecord]) -> Vec<Line> {
    let (room, bits, record) = (layout.pair_bits() as usize, layout.word_bits(), layout.record().format());
    let line = |pairs: &[PairRecord]| {
        let mut line: Line = [0; 16];
        for (place, pair) in pairs.iter().enumerate() {
            for (slot, (word, _)) in layout.inputs().enumerate() {
                put(&mut line, place * room + slot * bits as usize, bits, narrow(pair.0[word], record));
            }
        }
        line
    };
    pairs.chunks(layout.pairs_per_line() as usize).map(line).collect()
}

/// The pairs of source lines.
pub(crate) fn unpack_pairs(layout: &Layout, lines: &[Line], count: usize) -> Vec<PairRecord> {
    let (room, bits, record) = (layout.pair_bits() as usize, layout.word_bits(), layout.record().format());
    let pair = |line: &Line, place: usize| {
        let word = |slot: usize| widen(get(line, place * room + slot * bits as usize, bits), record);
        layout.pair((0..).map(word).take(layout.inputs().count()))
    };
    let places = 0..layout.pairs_per_line() as usize;
    lines
        .iter()
        .flat_map(|line| places.clone().map(move |place| (line, place)))
        .take(count)
        .map(|(line, place)| pair(line, place))
        .collect()
}

/// The destination lines of the contacts; with `Results::Hits` only those of pairs that touch. The padding of the last
/// line is zero.
pub(crate) fn pack_contacts(layout: &Layout, records: &[ContactRecord]) -> Vec<Line> {
    let is_there = |record: &ContactRecord| layout.number_bits() == 0 || record.is_contact();
    let there: Vec<_> = (0..).zip(records.iter().copied()).filter(|(_, record)| is_there(record)).collect();
    pack_records(layout, &there)
}

/// The destination lines of records, each with its number, which is in the record with `Results::Hits`. The padding of
/// the last line is zero.
pub(crate) fn pack_records(layout: &Layout, records: &[(u32, ContactRecord)]) -> Vec<Line> {
    let (words, bits, numbers) = (layout.contact_words(), layout.contact_bits() as usize, layout.record().format());
    let number_bits = layout.number_bits();
    let line = |records: &[(u32, ContactRecord)]| {
        let mut line: Line = [0; 16];
        for (place, (number, record)) in records.iter().enumerate() {
            let at = place * bits;
            if number_bits > 0 {
                put(&mut line, at, number_bits, *number);
            } else if words.is_empty() {
                put(&mut line, at, 1, record.is_contact().into());
            }
            for (slot, &word) in words.iter().enumerate() {
                let mut short = if word == FLAGS { record.0[word] } else { narrow(record.0[word], numbers) };
                if word == DEPTH && layout.sign_is_flow() && record.flags() == Flow::Coincident.flags() {
                    short |= SIGN;
                }
                let at = at + number_bits as usize + slot * layout.word_bits() as usize;
                put(&mut line, at, layout.word_bits(), short);
            }
        }
        line
    };
    records.chunks(layout.contacts_per_line() as usize).map(line).collect()
}
