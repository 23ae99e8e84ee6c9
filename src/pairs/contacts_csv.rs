//! Contacts as CSV: the number and flow of a pair, position, normal, depth, and 1 for an invalid pair.

use super::{FileError, table};
use crate::query::{ContactRecord, Flow, NUMBERS};
use std::io::{self, Write};
use std::path::Path;

const PAIR: usize = 0;
const FLOW: usize = 1;
const FIRST: usize = 2;
const INVALID: usize = FIRST + NUMBERS;

/// The columns: the pair's number and flow, the contact's numbers, and 1 for an invalid pair.
const COLUMNS: [&str; INVALID + 1] = {
    let mut columns = ["pair"; INVALID + 1];
    (columns[FLOW], columns[INVALID]) = ("flow", "invalid");
    let mut word = 0;
    while word < NUMBERS {
        columns[FIRST + word] = ContactRecord::NAMES[word];
        word += 1;
    }
    columns
};

/// The contacts of a file with one row per pair, in the order of the pairs.
pub fn read(file: &Path, text: &[u8]) -> Result<Vec<ContactRecord>, FileError> {
    let mut contacts = Vec::new();
    table::read(file, text, &COLUMNS, |row| {
        if row.text(PAIR).parse() != Ok(contacts.len()) {
            return Err(row.error(PAIR, format!("expected {}, found `{}`", contacts.len(), row.text(PAIR))));
        }
        contacts.push(contact(&row)?);
        Ok(())
    })?;
    Ok(contacts)
}

/// The contacts of a file with rows for some pairs, in their order, each with its pair's number.
pub fn read_hits(file: &Path, text: &[u8]) -> Result<Vec<(u32, ContactRecord)>, FileError> {
    let mut hits: Vec<(u32, ContactRecord)> = Vec::new();
    table::read(file, text, &COLUMNS, |row| {
        let least = hits.last().map_or(0, |(last, _)| u64::from(*last) + 1);
        let number = row.text(PAIR).parse::<u32>().ok().filter(|&number| u64::from(number) >= least);
        let number = number.ok_or_else(|| {
            row.error(PAIR, format!("expected a number from {least} to {}, found `{}`", u32::MAX, row.text(PAIR)))
        })?;
        hits.push((number, contact(&row)?));
        Ok(())
    })?;
    Ok(hits)
}

fn contact(row: &table::Row<'_>) -> Result<ContactRecord, FileError> {
    let flow = Flow::ALL.into_iter().find(|flow| flow.name() == row.text(FLOW));
    let flow = flow.ok_or_else(|| {
        row.error(FLOW, format!("expected fake, grazing, real or invalid, found `{}`", row.text(FLOW)))
    })?;
    let expected = if flow == Flow::Invalid { "1" } else { "0" };
    if row.text(INVALID) != expected {
        return Err(row.error(INVALID, format!("expected {expected} for flow {flow}, found `{}`", row.text(INVALID))));
    }
    let mut contact = ContactRecord::of_flags(flow.flags());
    for (i, word) in contact.0[..NUMBERS].iter_mut().enumerate() {
        *word = row.number(FIRST + i)?.to_bits();
    }
    Ok(contact)
}

/// Flags that no kernel writes are written as far as the columns allow: bits 2:1 as the flow, bit 3 as invalid.
pub fn write(out: impl Write, contacts: impl Iterator<Item = (u32, ContactRecord)>) -> io::Result<()> {
    let mut out = csv::Writer::from_writer(out);
    out.write_record(COLUMNS)?;
    for (pair, contact) in contacts {
        out.write_field(pair.to_string())?;
        write_contact(&mut out, contact)?;
        out.write_field((contact.flags() >> 3 & 1).to_string())?;
        out.write_record(None::<&[u8]>)?;
    }
    out.flush()
}

/// Writes spheres that touch, by their two numbers, with their contacts.
pub fn write_touching(out: impl Write, touching: impl Iterator<Item = ([u32; 2], ContactRecord)>) -> io::Result<()> {
    let mut out = csv::Writer::from_writer(out);
    out.write_record(["first", "second"].iter().chain(&COLUMNS[FLOW..INVALID]))?;
    for (numbers, contact) in touching {
        for number in numbers {
            out.write_field(number.to_string())?;
        }
        write_contact(&mut out, contact)?;
        out.write_record(None::<&[u8]>)?;
    }
    out.flush()
}

/// The fields from the flow to the depth.
fn write_contact(out: &mut csv::Writer<impl Write>, contact: ContactRecord) -> io::Result<()> {
    out.write_field(Flow::ALL[(contact.flags() >> 1 & 3) as usize].name())?;
    for number in contact.numbers() {
        out.write_field(table::decimal(number))?;
    }
    Ok(())
}
