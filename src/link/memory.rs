//! Sparse memory of 64-byte lines, which checks the accesses of a job and records violations.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
use std::ops::Range;

/// Bytes of a line.
pub const LINE_BYTES: u64 = 64;

/// A line. Word i is bits 32·i to 32·i + 31 of the line port's data.
pub type Line = [u32; 16];

/// Lines of a page, a power of two. Each has one bit in a u64.
const PAGE_LINES: u64 = 64;

/// The content of lines that were never written. No field of a record looks like it.
const UNWRITTEN: Line = [0xDEAD_BEEF; 16];

/// The number of violations that are kept. The others are only counted.
const KEPT: usize = 16;

/// An access that a job must not make. Addresses are in lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Violation {
    /// A read outside the source lines.
    #[error("read of line {0:#x}, outside the source")]
    ReadOutside(u64),
    /// A write outside the destination lines.
    #[error("write to line {0:#x}, outside the destination")]
    WriteOutside(u64),
    /// A second write to a destination line.
    #[error("second write to line {0:#x}")]
    WrittenTwice(u64),
}

#[derive(Clone, Debug)]
struct Page {
    lines: [Line; PAGE_LINES as usize],
    written: u64,
}

/// Memory that takes space only where it was written.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    pages: HashMap<u64, Box<Page>, BuildHasherDefault<PageHasher>>,
    guard: Option<Guard>,
    /// The number of guards so far, which tells a late write of an earlier job from one of this job.
    job: u64,
}

#[derive(Clone, Debug)]
struct Guard {
    source: Range<u64>,
    destination: Range<u64>,
    /// One bit per destination line: set once a write to it was accepted.
    claimed: Vec<u64>,
    /// One bit per destination line: set once the write has arrived.
    written: Vec<u64>,
    violations: Vec<Violation>,
    violation_count: u64,
}

impl Memory {
    /// Empty memory.
    pub fn new() -> Self {
        Self::default()
    }

    /// The line at `address`, if it was ever written.
    pub fn get(&self, address: u64) -> Option<&Line> {
        let (page, index) = (self.pages.get(&(address / PAGE_LINES))?, address % PAGE_LINES);
        (page.written >> index & 1 == 1).then(|| &page.lines[index as usize])
    }

    /// Puts a line at `address` for the host. No guard checks this.
    pub fn set(&mut self, address: u64, line: &Line) {
        let fresh = || Box::new(Page { lines: [[0; 16]; PAGE_LINES as usize], written: 0 });
        let page = self.pages.entry(address / PAGE_LINES).or_insert_with(fresh);
        let index = address % PAGE_LINES;
        page.lines[index as usize] = *line;
        page.written |= 1 << index;
    }

    /// Forgets the lines of `range`.
    pub fn forget(&mut self, range: Range<u64>) {
        for address in range {
            if let Some(page) = self.pages.get_mut(&(address / PAGE_LINES)) {
                page.written &= !(1 << (address % PAGE_LINES));
            }
        }
    }

    /// From now on the AFU may read `source` and write each line of `destination` once.
    pub fn guard(&mut self, source: Range<u64>, destination: Range<u64>) {
        let lines = destination.end.saturating_sub(destination.start);
        let claimed = vec![0; usize::try_from(lines.div_ceil(64)).unwrap_or(0)];
        let (written, violations) = (claimed.clone(), Vec::new());
        self.guard = Some(Guard { source, destination, claimed, written, violations, violation_count: 0 });
        self.job += 1;
    }

    /// A read by the AFU is accepted.
    pub(super) fn accept_read(&mut self, address: u64) {
        if let Some(guard) = &mut self.guard
            && !guard.source.contains(&address)
        {
            guard.note(Violation::ReadOutside(address));
        }
    }

    /// A read by the AFU is answered.
    pub(super) fn read(&self, address: u64) -> Line {
        self.get(address).copied().unwrap_or(UNWRITTEN)
    }

    /// A write by the AFU is accepted. Returns its job, or `None` if it must not write there. (The address may belong
    /// to the source or to another job's result, so the write is not done.)
    pub(super) fn accept_write(&mut self, address: u64) -> Option<u64> {
        let Some(guard) = &mut self.guard else { return Some(self.job) };
        let Some(index) = guard.index(address) else {
            guard.note(Violation::WriteOutside(address));
            return None;
        };
        if mark(&mut guard.claimed, index) {
            guard.note(Violation::WrittenTwice(address));
        }
        Some(self.job)
    }

    /// A write by the AFU arrives, for the job that [`Memory::accept_write`] returned.
    pub(super) fn write(&mut self, address: u64, line: &Line, job: u64) {
        self.set(address, line);
        if let Some(guard) = self.guard.as_mut().filter(|_| job == self.job)
            && let Some(index) = guard.index(address)
        {
            mark(&mut guard.written, index);
        }
    }

    /// The first violations since [`Memory::guard`].
    pub fn violations(&self) -> &[Violation] {
        self.guard.as_ref().map_or(&[], |guard| &guard.violations)
    }

    /// Number of violations since [`Memory::guard`].
    pub fn violation_count(&self) -> u64 {
        self.guard.as_ref().map_or(0, |guard| guard.violation_count)
    }

    /// The first line of the guarded destination that has not arrived.
    pub fn first_unwritten(&self) -> Option<u64> {
        let guard = self.guard.as_ref()?;
        let word = guard.written.iter().position(|&word| word != u64::MAX)?;
        let address = guard.destination.start + 64 * word as u64 + u64::from(guard.written[word].trailing_ones());
        guard.destination.contains(&address).then_some(address)
    }
}

/// Sets a bit. Returns true if it was set before.
fn mark(bits: &mut [u64], index: u64) -> bool {
    let (word, bit) = (&mut bits[(index / 64) as usize], 1u64 << (index % 64));
    let before = *word & bit != 0;
    *word |= bit;
    before
}

impl Guard {
    fn index(&self, address: u64) -> Option<u64> {
        self.destination.contains(&address).then(|| address - self.destination.start)
    }

    fn note(&mut self, violation: Violation) {
        self.violation_count += 1;
        if self.violations.len() < KEPT {
            self.violations.push(violation);
        }
    }
}

/// Page numbers are the AFU's own addresses and are hashed twice per cycle. One multiplication spreads them enough.
#[derive(Clone, Copy, Debug, Default)]
struct PageHasher(u64);

impl Hasher for PageHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u64(byte.into()));
    }

    fn write_u64(&mut self, value: u64) {
        self.0 = (self.0 ^ value).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(26);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holds_lines_far_apart_and_nothing_between() {
        let mut memory = Memory::new();
        let top = (1 << 58) - 1;
        memory.set(0, &[1; 16]);
        memory.set(top, &[2; 16]);
        assert_eq!((memory.get(0), memory.get(top), memory.get(1)), (Some(&[1; 16]), Some(&[2; 16]), None));
        assert_eq!(memory.read(5), UNWRITTEN);
        memory.forget(0..1);
        assert_eq!(memory.get(0), None);
    }

    fn write(memory: &mut Memory, address: u64, line: &Line) {
        if let Some(job) = memory.accept_write(address) {
            memory.write(address, line, job);
        }
    }

    #[test]
    fn notes_what_a_job_must_not_do() {
        let mut memory = Memory::new();
        memory.set(9, &[9; 16]);
        memory.guard(9..10, 100..170);
        memory.accept_read(9);
        write(&mut memory, 101, &[1; 16]);
        assert!(memory.violations().is_empty());
        assert_eq!(memory.first_unwritten(), Some(100));
        (100..170).for_each(|address| write(&mut memory, address, &[2; 16]));
        assert_eq!((memory.violations(), memory.first_unwritten()), (&[Violation::WrittenTwice(101)][..], None));
        memory.accept_read(10);
        write(&mut memory, 9, &[3; 16]);
        write(&mut memory, 170, &[3; 16]);
        assert_eq!(memory.violation_count(), 4);
        let others = [Violation::ReadOutside(10), Violation::WriteOutside(9), Violation::WriteOutside(170)];
        assert_eq!(memory.violations()[1..], others);
        assert_eq!((memory.get(9), memory.get(170)), (Some(&[9; 16]), None), "stray writes are not done");
    }

    #[test]
    fn a_late_write_of_an_earlier_job_is_none_of_this_one() {
        let mut memory = Memory::new();
        memory.guard(0..1, 100..101);
        let earlier = memory.accept_write(100).unwrap();
        memory.guard(0..1, 100..101);
        memory.write(100, &[1; 16], earlier);
        assert_eq!((memory.first_unwritten(), memory.get(100)), (Some(100), Some(&[1; 16])));
        write(&mut memory, 100, &[2; 16]);
        assert_eq!((memory.first_unwritten(), memory.violation_count()), (None, 0));
    }
}
