//! What takes the hits of the model.

use std::collections::VecDeque;

use super::port::Port;
use crate::afu::generate::kernel;
use crate::afu::scpu::scpu;
use crate::afu::spheres::Sizes;
use crate::afu::spheres::contacts::LINES;
use crate::afu::spheres::hits::{HIT_LANES, cycles_to_numbers};
use crate::afu::spheres::waiting::{PLACES, hits_on_the_way};
use crate::afu::{Spec, packer, resolver};
use crate::hdl::BuildErrors;
use crate::query::Fields;

/// What takes the hits: lines for numbers alone, or SCPUs.
#[derive(Debug)]
pub(super) struct Takers {
    /// Hits that leave the stage before in a cycle, at most.
    pub(super) lanes: u64,
    /// SCPUs side by side; none for numbers alone.
    side_by_side: u64,
    /// They take hits in the first so many cycles of each interval.
    units: u64,
    interval: u64,
    /// Cycles from a step of hits to where they wait, and from the hits that leave to the line of their record.
    to_place: u64,
    to_line: u64,
    /// More cycles if that line is not full.
    to_flush: u64,
    /// Hits that may wait before the stage before is stopped.
    most: u64,
    /// Hits that wait: the cycle from which they do, how many, and whether their row ends.
    waiting: VecDeque<(u64, u64, bool)>,
    /// Cycles in which SCPUs take hits.
    busy: u64,
}

impl Takers {
    /// What takes them, and the lines that may wait to be written.
    pub(super) fn of(spec: &Spec, sizes: &Sizes) -> Result<(Self, u32), BuildErrors> {
        let is_resolved = spec.config.contact != Fields::HIT;
        let (side_by_side, units) = if is_resolved { (resolver::lanes(spec), resolver::units(spec)) } else { (0, 1) };
        let to_place = cycles_to_numbers(sizes.compared);
        let to_number = if side_by_side > 1 { resolver::BACKLOG_TO_NUMBER } else { to_place };
        let (to_contact, room) = if is_resolved {
            let scpu = scpu(spec, "scpu", &kernel(spec)?)?;
            (resolver::latency(spec, &scpu), resolver::lines(spec, &scpu, to_number))
        } else {
            (0, LINES)
        };
        let takers = Self {
            lanes: if side_by_side == 1 { 1 } else { HIT_LANES.into() },
            side_by_side: side_by_side.into(),
            units: units.into(),
            interval: if is_resolved { spec.config.interval.max(1).into() } else { 1 },
            to_place: to_place.into(),
            to_line: (to_number + to_contact + packer::cycles_to_line(spec)).into(),
            to_flush: packer::cycles_to_flush(spec).into(),
            most: (PLACES - hits_on_the_way(sizes.compared)).into(),
            waiting: VecDeque::new(),
            busy: 0,
        };
        Ok((takers, room))
    }

    /// Whether hits may leave the stage before.
    pub(super) fn may_come(&self, now: u64, port: &Port) -> bool {
        if self.side_by_side <= 1 {
            return now % self.interval < self.units && port.accepts(now);
        }
        let there = self.waiting.iter().filter(|(cycle, ..)| *cycle <= now);
        there.map(|(_, hits, _)| hits).sum::<u64>() < self.most
    }

    /// Some hits come. Returns the number of rows that end at once.
    pub(super) fn put(&mut self, now: u64, hits: u64, ends_row: bool, port: &mut Port) -> usize {
        if self.side_by_side > 1 {
            self.waiting.push_back((now + self.to_place, hits, ends_row));
            return 0;
        }
        self.busy += u64::from(hits > 0);
        port.put(now + self.to_line, hits);
        usize::from(ends_row)
    }

    /// A cycle of SCPUs side by side. Returns the number of rows that end.
    pub(super) fn cycle(&mut self, now: u64, port: &mut Port) -> usize {
        let takes = now % self.interval < self.units && port.accepts(now);
        let mut free = if takes { self.side_by_side } else { 0 };
        let mut rows = 0;
        let before = free;
        while let Some((cycle, hits, ends_row)) = self.waiting.front_mut() {
            let taken = free.min(*hits);
            if *cycle > now {
                break;
            }
            *hits -= taken;
            free -= taken;
            if *hits > 0 {
                break;
            }
            rows += usize::from(*ends_row);
            self.waiting.pop_front();
        }
        self.busy += u64::from(free < before);
        port.put(now + self.to_line, before - free);
        rows
    }

    /// The last row has ended.
    pub(super) fn end(&self, now: u64, port: &mut Port) {
        port.flush(now + self.to_line + self.to_flush);
    }

    /// Whether SCPUs take the hits, and the cycles in which they do.
    pub(super) fn scpus(&self) -> Option<u64> {
        (self.side_by_side > 0).then_some(self.busy)
    }
}
