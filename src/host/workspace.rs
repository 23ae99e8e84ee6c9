//! The workspace: pinned memory in pages of 2 MB. They are contiguous for the device, and anywhere in physical memory.
//!
//! It begins with the AFU's context (two lines: pointers, status). Two halves follow: the source, whose first line is
//! the control memory, and the destination. DSMs, SPL's context and the page table are in pages of their own.

use std::collections::BTreeSet;
use std::ops::Range;

use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::error::HostError;
use super::task::Task;
use crate::afu::shell::spl2::map::{self, pointers};
use crate::link::spl2::{Limits, MAX_PAGES, PAGE_BYTES, PAGE_LINES, Pages};
use crate::link::{LINE_BYTES, Line};
use crate::record::{Layout, sphere_lines};

/// The virtual byte address of a workspace.
const BASE: u64 = 0x0000_7F12_3460_0000;
/// The byte address of a workspace of physical memory that is contiguous.
const CONTIGUOUS: u64 = 0x8_4000_0000;
/// Lines of the 4 KB that no burst crosses.
const BURST_LINES: u64 = 64;
/// Lines of the AFU's context.
const CONTEXT_LINES: u64 = 2;
/// The range of physical pages from which a workspace's pages are taken: the second terabyte.
const PHYSICAL: Range<u64> = (1 << 40) / PAGE_BYTES..(1 << 41) / PAGE_BYTES;

/// Physical byte addresses of the structures that are not in the workspace.
pub(super) const SPL_DSM: u64 = 0x1000;
pub(super) const SPL_CONTEXT: u64 = 0x3000;
pub(super) const AFU_DSM: u64 = 0x0012_0000_2000;
const PAGE_TABLE: u64 = 0x4000;

/// Memory that host and device share.
#[derive(Clone, Debug)]
pub struct Workspace {
    pages: Pages,
    layout: Layout,
    /// Virtual byte address of the first page.
    base: u64,
    /// Lines in front of source and destination: the context.
    reserved: u64,
    /// Lines of the source in front of the pairs: the control memory.
    control: u64,
    /// Lines from the beginning of the workspace to the source, and to the destination.
    source: u64,
    destination: u64,
    /// Lines of each.
    lines: u64,
    room: u64,
}

impl Workspace {
    /// A workspace of 1 to 1024 pages for records of `layout`; `seed` scatters the pages over physical memory.
    ///
    /// # Errors
    /// Returns [`HostError::Pages`] if the number of pages is out of range.
    pub fn new(layout: Layout, pages: u64, seed: u64) -> Result<Self, HostError> {
        if !(1..=MAX_PAGES).contains(&pages) {
            return Err(HostError::Pages(pages));
        }
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let (mut taken, mut scattered) = (BTreeSet::new(), Vec::new());
        while (scattered.len() as u64) < pages {
            let page = PHYSICAL.start + random.next_u64() % (PHYSICAL.end - PHYSICAL.start);
            if taken.insert(page) {
                scattered.push(page * PAGE_BYTES);
            }
        }
        let lines = half_lines(pages);
        let pages = Pages::new(BASE, scattered);
        Ok(Self {
            pages,
            layout,
            base: BASE,
            reserved: CONTEXT_LINES,
            control: map::DATA_LINE.into(),
            source: CONTEXT_LINES,
            destination: CONTEXT_LINES + lines,
            lines,
            room: lines,
        })
    }

    /// The smallest workspace that holds `pairs` pairs and their contacts, for a device that sees physical memory: its
    /// pages follow each other, and its addresses are physical. It has no context and no control memory.
    ///
    /// # Errors
    /// Returns [`HostError::Pages`] if 2 GB are not enough.
    pub fn contiguous(layout: Layout, pairs: u64) -> Result<Self, HostError> {
        let lines = layout.source_lines(pairs).max(layout.destination_lines(pairs));
        let pages = contiguous_pages(2 * lines)?;
        let lines = pages.count() * PAGE_LINES / 2;
        Ok(Self::physical_from(CONTIGUOUS, pages, layout, lines))
    }

    /// The smallest workspace of that kind for jobs of these numbers of spheres, in the first set and in the second,
    /// with room for `contacts` contacts. Each buffer is exactly as long as that takes, and begins with 4 KB.
    ///
    /// # Errors
    /// Returns [`HostError::Pages`] if 2 GB are not enough.
    pub fn for_spheres(layout: Layout, spheres: [u64; 2], contacts: u64) -> Result<Self, HostError> {
        let lines = spheres.map(sphere_lines).iter().sum::<u64>();
        let (destination, room) = (lines.next_multiple_of(BURST_LINES), layout.destination_lines(contacts));
        let pages = contiguous_pages(destination + room)?;
        Ok(Self { lines, destination, room, ..Self::physical_from(CONTIGUOUS, pages, layout, lines) })
    }

    /// Physical memory with buffers of this length, one behind the other.
    fn physical_from(base: u64, pages: Pages, layout: Layout, lines: u64) -> Self {
        let (destination, room) = (lines, lines);
        Self { pages, layout, base, reserved: 0, control: 0, source: 0, destination, lines, room }
    }

    /// A workspace in this range of physical bytes, of which the device has the same view: a buffer that a driver gave.
    /// The lower half is the source, the upper half the destination.
    ///
    /// # Errors
    /// Returns [`HostError::Buffers`] if the range does not begin with a line, or has less than a line for each.
    pub fn in_buffer(layout: Layout, bytes: Range<u64>) -> Result<Self, HostError> {
        if !bytes.start.is_multiple_of(LINE_BYTES) {
            return Err(HostError::Buffers("the buffer's address is not a multiple of 64: allocate whole pages"));
        }
        let half = bytes.end.saturating_sub(bytes.start) / LINE_BYTES / 2;
        // Both halves begin with 4 KB if the buffer does.
        let lines = if half > BURST_LINES { half / BURST_LINES * BURST_LINES } else { half };
        if lines == 0 {
            return Err(HostError::Buffers("the buffer has no room for a line of pairs and a line of contacts"));
        }
        let pages = bytes.start / PAGE_BYTES..bytes.end.div_ceil(PAGE_BYTES);
        let pages = Pages::new(bytes.start, pages.map(|page| page * PAGE_BYTES));
        Ok(Self::physical_from(bytes.start, pages, layout, lines))
    }

    /// The same pages with another source and destination, as offsets in lines from the beginning, each `lines` long.
    ///
    /// # Errors
    /// Returns [`HostError::Buffers`] if they overlap, or do not fit behind the context.
    pub fn with_buffers(self, source: u64, destination: u64, lines: u32) -> Result<Self, HostError> {
        let (lines, all) = (u64::from(lines), self.pages() * PAGE_LINES);
        let ends_inside = source.max(destination).checked_add(lines).is_some_and(|end| end <= all);
        if !ends_inside || source.min(destination) < self.reserved {
            return Err(HostError::Buffers("they do not fit behind the context: give the workspace more pages"));
        }
        if source.abs_diff(destination) < lines {
            return Err(HostError::Buffers("they overlap"));
        }
        Ok(Self { source, destination, lines, room: lines, ..self })
    }

    /// The smallest workspace that holds `pairs` pairs and their contacts.
    ///
    /// # Errors
    /// Returns [`HostError::Pages`] if 2 GB are not enough.
    pub fn for_pairs(layout: Layout, pairs: u64, seed: u64) -> Result<Self, HostError> {
        Self::new(layout, pages_for(&layout, pairs), seed)
    }

    /// The smallest workspace below SPL2 for jobs of these numbers of spheres, in the first set and in the second, with
    /// room for `contacts` contacts. Both buffers are as long as the longer one must be; `seed` scatters the pages.
    ///
    /// # Errors
    /// Returns [`HostError::Pages`] if 2 GB are not enough.
    pub fn for_spheres_below_spl2(
        layout: Layout,
        spheres: [u64; 2],
        contacts: u64,
        seed: u64,
    ) -> Result<Self, HostError> {
        let source = spheres.map(sphere_lines).iter().sum::<u64>() + u64::from(map::DATA_LINE);
        let lines = source.max(layout.destination_lines(contacts));
        let workspace = Self::new(layout, (2 * lines + CONTEXT_LINES).div_ceil(PAGE_LINES), seed)?;
        // No more lines than 2 GB have.
        workspace.with_buffers(CONTEXT_LINES, CONTEXT_LINES + lines, lines as u32)
    }

    /// The number of pages.
    pub fn pages(&self) -> u64 {
        self.pages.count()
    }

    /// The size in bytes.
    pub fn bytes(&self) -> u64 {
        self.pages() * PAGE_BYTES
    }

    /// The layout of the records.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The most pairs that a transaction may have: what source and destination hold, and what a count can represent.
    pub fn capacity(&self) -> u64 {
        let pairs = self.lines.saturating_sub(self.control) * u64::from(self.layout.pairs_per_line());
        pairs.min(self.room * u64::from(self.layout.contacts_per_line())).min(u32::MAX.into())
    }

    /// Virtual byte address of the AFU's context.
    pub fn context(&self) -> u64 {
        self.base
    }

    /// pSource: virtual byte address of the control memory, behind which the pairs lie.
    pub fn source(&self) -> u64 {
        self.base + self.source * LINE_BYTES
    }

    /// Virtual byte address of the first pair.
    pub fn pairs(&self) -> u64 {
        self.source() + self.control * LINE_BYTES
    }

    /// Lines of the source in front of the pairs.
    pub(super) fn control_lines(&self) -> u64 {
        self.control
    }

    /// pDest: virtual byte address of the first contact.
    pub fn destination(&self) -> u64 {
        self.base + self.destination * LINE_BYTES
    }

    /// Lines of source, and of destination: of the shorter one.
    pub fn buffer_lines(&self) -> u64 {
        self.lines.min(self.room)
    }

    /// Lines of the source behind the control memory.
    pub(super) fn source_room(&self) -> u64 {
        self.lines.saturating_sub(self.control)
    }

    /// Lines of the destination.
    pub(super) fn destination_room(&self) -> u64 {
        self.room
    }

    /// The physical line of a virtual byte address; `None` if the address is outside the workspace.
    pub fn physical(&self, address: u64) -> Option<u64> {
        self.pages.translate(address / LINE_BYTES)
    }

    /// The physical line of a line of the context, of the source, of the destination.
    pub(super) fn line(&self, base: u64, line: u64) -> Result<u64, HostError> {
        let address = base + line * LINE_BYTES;
        self.physical(address).ok_or(HostError::Outside(address))
    }

    /// The lines that a job may access.
    pub(super) fn limits(&self, task: &Task) -> Limits {
        let line = |address: u64| address / LINE_BYTES;
        let (context, source, destination) = (line(self.context()), line(self.source()), line(self.destination()));
        let [pointers, status] = [map::POINTERS_LINE, map::STATUS_LINE].map(|number| context + u64::from(number));
        let sources = source..source + self.control + task.source_lines;
        let has_context = self.reserved > 0;
        Limits {
            reads: if has_context { vec![pointers..pointers + 1, sources] } else { vec![sources] },
            status: if has_context { status..status + 1 } else { 0..0 },
            results: destination..destination + task.destination_lines,
        }
    }

    /// The lines of SPL's context, of the page table, and of the AFU's context.
    pub(super) fn described(&self) -> Result<Vec<(u64, Line)>, HostError> {
        let mut lines = self.pages.described(SPL_CONTEXT, PAGE_TABLE);
        let mut context = [0; 16];
        pointers::SOURCE.set(&mut context, self.source().into());
        pointers::DESTINATION.set(&mut context, self.destination().into());
        pointers::LINES.set(&mut context, self.buffer_lines().into());
        lines.push((self.line(self.context(), map::POINTERS_LINE.into())?, context));
        lines.push((self.line(self.context(), map::STATUS_LINE.into())?, [0; 16]));
        lines.push((self.line(self.source(), map::CONTROL_LINE.into())?, [0; 16]));
        Ok(lines)
    }
}

/// Pages that follow each other, for this number of lines.
fn contiguous_pages(lines: u64) -> Result<Pages, HostError> {
    let pages = lines.div_ceil(PAGE_LINES).max(1);
    if pages > MAX_PAGES {
        return Err(HostError::Pages(pages));
    }
    Ok(Pages::new(CONTIGUOUS, (0..pages).map(|page| CONTIGUOUS + page * PAGE_BYTES)))
}

/// Lines of each half behind the context: (length − 128) / 2, a whole number of lines for any number of pages.
fn half_lines(pages: u64) -> u64 {
    (pages * PAGE_LINES - CONTEXT_LINES) / 2
}

/// The number of pages that this number of pairs needs, which may be more than the maximum.
pub(super) fn pages_for(layout: &Layout, pairs: u64) -> u64 {
    let half = (layout.source_lines(pairs) + u64::from(map::DATA_LINE)).max(layout.destination_lines(pairs));
    (2 * half + CONTEXT_LINES).div_ceil(PAGE_LINES)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Config, Input, Results};
    use crate::query::Fields;

    fn layout() -> Layout {
        Layout::new(512, Fields::ALL)
    }

    #[test]
    fn the_buffers_are_where_the_facts_say() {
        for pages in [1, 2, 7, 1024] {
            let workspace = Workspace::new(layout(), pages, 1).unwrap();
            let bytes = pages * (2 << 20);
            assert_eq!((workspace.bytes(), workspace.source()), (bytes, workspace.context() + 128));
            assert_eq!(workspace.destination(), workspace.source() + (bytes - 128) / 2);
            let end = workspace.destination() + 64 * workspace.buffer_lines();
            assert_eq!(end, workspace.context() + bytes, "nothing is left over");
            assert!(workspace.physical(end - 1).is_some() && workspace.physical(end).is_none());
            assert!(workspace.physical(workspace.context() - 1).is_none());
            assert_eq!(pages_for(&layout(), workspace.capacity()), pages);
            assert_eq!(pages_for(&layout(), workspace.capacity() + 1), pages + 1);
        }
        for fields in [Fields::HIT, Fields::ALL] {
            let layout = Layout::new(512, fields);
            for pairs in [0, 1, 32_764, 32_765, 90_000, 10_000_000] {
                let workspace = Workspace::for_pairs(layout, pairs, 1).unwrap();
                assert!(workspace.capacity() >= pairs, "{fields}, {pairs}");
            }
        }
    }

    #[test]
    fn a_buffer_of_a_driver_is_used_as_it_lies() {
        for (start, bytes, lines) in [(0x3F90_1000, 1 << 20, 8192), (0x3F9F_F000, 3 << 20, 24576), (64, 4 * 64, 2)] {
            let workspace = Workspace::in_buffer(layout(), start..start + bytes).unwrap();
            assert_eq!((workspace.source(), workspace.pairs(), workspace.buffer_lines()), (start, start, lines));
            assert_eq!(workspace.destination(), start + 64 * lines);
            for address in [start, start + bytes - 64] {
                assert_eq!(
                    workspace.physical(address),
                    Some(address / 64),
                    "what the device sees is what the host sees"
                );
            }
        }
        for (range, why) in [(32..4096, "not a multiple of 64"), (64..128, "no room"), (4096..4096, "no room")] {
            let error = Workspace::in_buffer(layout(), range).unwrap_err().to_string();
            assert!(error.contains(why), "{error}");
        }
    }

    #[test]
    fn buffers_of_spheres_are_as_long_as_they_must_be() {
        let numbers =
            Config { input: Input::Spheres, results: Results::Hits, contact: Fields::HIT, ..Config::default() };
        let all = Config { contact: Fields::ALL, ..numbers.clone() };
        for (config, spheres, contacts, source, room) in [
            (&numbers, [20, 0], 160, 8, 10),
            (&numbers, [17, 1], 17, 12, 2),
            (&numbers, [0, 0], 0, 0, 0),
            (&all, [17, 1], 17, 12, 9),
        ] {
            let workspace = Workspace::for_spheres(Layout::of(512, config), spheres, contacts).unwrap();
            assert_eq!((workspace.source_room(), workspace.destination_room()), (source, room));
            assert!((workspace.destination() - workspace.source()) / 64 >= source);
            assert!([workspace.source(), workspace.destination()].iter().all(|at| at.is_multiple_of(4096)));
            assert!(workspace.physical(workspace.destination() + 64 * room).is_some());
        }
        let error = Workspace::for_spheres(layout(), [16, 0], 1 << 40).unwrap_err().to_string();
        assert!(error.contains("expected 1 to 1024 pages"), "{error}");
    }

    #[test]
    fn pages_are_scattered_and_apart() {
        let workspace = Workspace::new(layout(), 1024, 9).unwrap();
        let page = |number: u64| workspace.physical(workspace.context() + number * PAGE_BYTES).unwrap() / PAGE_LINES;
        let pages: Vec<_> = (0..1024).map(page).collect();
        assert_eq!(pages.iter().collect::<BTreeSet<_>>().len(), 1024);
        assert!(pages.windows(2).filter(|two| two[1] == two[0] + 1).count() < 5);
        let last = workspace.context() + 3 * PAGE_BYTES - 64;
        assert_eq!(workspace.physical(last), Some(pages[2] * PAGE_LINES + PAGE_LINES - 1));
        assert_eq!(workspace.physical(last + 64), Some(pages[3] * PAGE_LINES));
    }

    #[test]
    fn impossible_sizes_say_what_to_do() {
        let text = |result: Result<Workspace, HostError>| result.unwrap_err().to_string();
        assert_eq!(text(Workspace::new(layout(), 0, 1)), "a workspace of 0 pages of 2 MB: expected 1 to 1024 pages");
        assert!(text(Workspace::for_pairs(layout(), 1 << 33, 1)).contains("expected 1 to 1024 pages"));
        let with = |source, destination, lines| {
            Workspace::new(layout(), 1, 1).unwrap().with_buffers(source, destination, lines).map(|it| it.capacity())
        };
        assert_eq!((with(2, PAGE_LINES - 4, 4), with(PAGE_LINES - 4, 2, 4)), (Ok(6), Ok(6)));
        let outside = "the buffers: they do not fit behind the context: give the workspace more pages";
        for (source, destination) in [(2, PAGE_LINES - 3), (1, 9), (u64::MAX, 9)] {
            assert_eq!(with(source, destination, 4).unwrap_err().to_string(), outside);
        }
        assert_eq!(with(5, 8, 4).unwrap_err().to_string(), "the buffers: they overlap");
    }
}
