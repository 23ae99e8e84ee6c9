//! Translates virtual to physical addresses: SPL2's table of 2 MB pages.

use super::error::Spl2Error;
use crate::link::{LINE_BYTES, Line, Memory};

/// Bytes of a page.
pub const PAGE_BYTES: u64 = 2 << 20;
/// Pages of a table: 2 GB.
pub const MAX_PAGES: u64 = 1024;
/// Lines in a page.
pub const PAGE_LINES: u64 = PAGE_BYTES / LINE_BYTES;
/// Entries in a line of the table: 64-bit physical byte addresses.
const LINE_ENTRIES: u64 = 8;

/// The table that SPL reads from memory when it is enabled.
#[derive(Clone, Debug)]
pub struct Pages {
    /// The number of the first virtual page.
    first: u64,
    /// The first line of each physical page.
    lines: Vec<u64>,
}

/// A 64-bit word of a line.
fn qword(line: &Line, index: usize) -> u64 {
    u64::from(line[2 * index + 1]) << 32 | u64::from(line[2 * index])
}

fn set_qword(line: &mut Line, index: usize, value: u64) {
    (line[2 * index], line[2 * index + 1]) = (value as u32, (value >> 32) as u32);
}

impl Pages {
    /// Pages at these physical byte addresses, contiguous from a virtual page on.
    pub fn new(first: u64, pages: impl IntoIterator<Item = u64>) -> Self {
        let lines = pages.into_iter().map(|page| page / LINE_BYTES).collect();
        Self { first: first / PAGE_BYTES, lines }
    }

    /// The number of pages.
    pub fn count(&self) -> u64 {
        self.lines.len() as u64
    }

    /// Writes the context and the table, each at a physical byte address, so that [`Pages::read`] finds them.
    pub fn write(&self, memory: &mut Memory, context: u64, table: u64) {
        self.described(context, table).iter().for_each(|(at, line)| memory.set(*at, line));
    }

    /// The lines of context and table, each at a physical byte address.
    pub(crate) fn described(&self, context: u64, table: u64) -> Vec<(u64, Line)> {
        let mut line = [0; 16];
        set_qword(&mut line, 0, table);
        set_qword(&mut line, 1, self.first * PAGE_BYTES);
        (line[4], line[5]) = (1, self.lines.len() as u32);
        let mut lines = vec![(context / LINE_BYTES, line)];
        for (number, pages) in (0..).zip(self.lines.chunks(LINE_ENTRIES as usize)) {
            let mut entries = [0; 16];
            for (index, page) in pages.iter().enumerate() {
                set_qword(&mut entries, index, page * LINE_BYTES);
            }
            lines.push((table / LINE_BYTES + number, entries));
        }
        lines
    }

    /// Reads SPL2's context at a physical byte address, and the table that it points to. In the context, qword 0 is the
    /// table's physical address, qword 1 the virtual address of the first page, dword 4 the page size (1: 2 MB), and
    /// dword 5 the number of entries.
    ///
    /// # Errors
    /// Returns [`Spl2Error::Context`] if one of the two is invalid.
    pub fn read(memory: &Memory, context: u64) -> Result<Self, Spl2Error> {
        let fail = |why| Err(Spl2Error::Context(why));
        let Some(line) = memory.get(context / LINE_BYTES) else { return fail("nothing was written there") };
        let (table, first, size, entries) = (qword(line, 0), qword(line, 1), line[4], u64::from(line[5]));
        if size != 1 {
            return fail("its page size is not 1 (2 MB)");
        }
        if !(1..=MAX_PAGES).contains(&entries) {
            return fail("it has no entries, or more than 1024");
        }
        if !first.is_multiple_of(PAGE_BYTES) {
            return fail("its virtual address is not that of a page");
        }
        let mut lines = Vec::new();
        for index in 0..entries {
            let Some(line) = memory.get(table / LINE_BYTES + index / LINE_ENTRIES) else {
                return fail("its page table was not written");
            };
            let page = qword(line, (index % LINE_ENTRIES) as usize);
            if !page.is_multiple_of(PAGE_BYTES) {
                return fail("an entry of its page table is not the address of a page");
            }
            lines.push(page / LINE_BYTES);
        }
        Ok(Self { first: first / PAGE_BYTES, lines })
    }

    /// The physical line of a virtual one.
    pub(crate) fn translate(&self, line: u64) -> Option<u64> {
        let page = (line / PAGE_LINES).checked_sub(self.first)?;
        let first = self.lines.get(usize::try_from(page).ok()?)?;
        Some(first + line % PAGE_LINES)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_translates_its_pages_and_no_others() {
        let mut memory = Memory::new();
        let mut context = [0; 16];
        (context[0], context[2], context[4], context[5]) = (0x4000, 3 * PAGE_BYTES as u32, 1, 9);
        memory.set(1, &context);
        for line in 0..2 {
            let mut entries = [0; 16];
            for index in 0..8 {
                entries[2 * index] = (100 - (8 * line as u32 + index as u32)) * PAGE_BYTES as u32;
            }
            memory.set(0x4000 / 64 + line, &entries);
        }
        let pages = Pages::read(&memory, 64).unwrap();
        assert_eq!(pages.translate(3 * PAGE_LINES), Some(100 * PAGE_LINES));
        assert_eq!(pages.translate(12 * PAGE_LINES - 1), Some(93 * PAGE_LINES - 1));
        assert_eq!((pages.translate(3 * PAGE_LINES - 1), pages.translate(12 * PAGE_LINES)), (None, None));
        context[4] = 0;
        memory.set(1, &context);
        assert!(Pages::read(&memory, 64).unwrap_err().to_string().contains("page size"));
        assert!(Pages::read(&memory, 0).is_err());
    }

    #[test]
    fn a_table_reads_as_it_was_written() {
        let physical = [9, 4, 300, 7, 8, 5, 6, 1, 77].map(|page| page * PAGE_BYTES);
        let mut memory = Memory::new();
        Pages::new(5 * PAGE_BYTES, physical).write(&mut memory, 0x3000, 0x4000);
        let pages = Pages::read(&memory, 0x3000).unwrap();
        assert_eq!(pages.count(), 9);
        for (number, page) in (5..).zip(physical) {
            assert_eq!(pages.translate(number * PAGE_LINES + 3), Some(page / LINE_BYTES + 3));
        }
    }
}
