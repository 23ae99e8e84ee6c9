//! Checks the port's protocol in every cycle.

use std::collections::HashMap;
use std::ops::Range;

use super::error::Spl2Error;
use super::header::Header;

/// Requests that are accepted after almost-full rose.
const OVERSHOOT: u32 = 4;
/// Cycles after the end of `spl_enable` in which a request is still on its way.
const GRACE_CYCLES: u64 = 4;
/// The number of values of mdata. SPL keeps the uppermost bit for itself.
const MDATA: usize = 1 << 13;

/// The virtual lines that a job may access.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Limits {
    /// Lines that it may read.
    pub reads: Vec<Range<u64>>,
    /// Lines that it may write any number of times: the status.
    pub status: Range<u64>,
    /// Lines that it may write once.
    pub results: Range<u64>,
}

/// One direction.
#[derive(Clone, Debug)]
pub(super) struct Direction {
    what: &'static str,
    overshoot: u32,
    in_flight: Vec<bool>,
}

impl Direction {
    pub(super) fn new(what: &'static str) -> Self {
        Self { what, overshoot: 0, in_flight: vec![false; MDATA] }
    }

    /// Counts the requests since almost-full rose, in a cycle with or without one.
    pub(super) fn count(&mut self, almostfull: bool, requests: bool) -> Result<u32, Spl2Error> {
        self.overshoot = if almostfull { self.overshoot + u32::from(requests) } else { 0 };
        match self.overshoot > OVERSHOOT {
            true => Err(Spl2Error::Overshoot { what: self.what, after: self.overshoot }),
            false => Ok(self.overshoot),
        }
    }

    /// Checks the request's header and returns its fields.
    pub(super) fn header(&self, bits: u128, disabled_for: Option<u64>) -> Result<Header, Spl2Error> {
        let header = Header::from_bits(bits);
        let is_read = self.what == "read";
        let fail = |why| Err(Spl2Error::Header { what: self.what, header: bits, why });
        match header.kind {
            Header::READ if is_read => {}
            Header::WRITE_THROUGH | Header::WRITE_LINE | Header::WRITE_FENCE if !is_read => {}
            _ => return fail("its type is not this port's"),
        }
        if header.lines != 1 {
            return fail("it is not of one line");
        }
        if header.rest {
            return fail("its unused bits are not zero");
        }
        if usize::from(header.mdata) >= MDATA {
            return fail("mdata[13] is SPL's own");
        }
        // An AFU identifies itself by a physical write, before it is enabled.
        match disabled_for.filter(|&cycles| cycles > GRACE_CYCLES && header.is_virtual) {
            Some(cycles) => Err(Spl2Error::Disabled { what: self.what, cycles }),
            None => Ok(header),
        }
    }

    pub(super) fn sent(&mut self, mdata: u16) -> Result<(), Spl2Error> {
        match std::mem::replace(&mut self.in_flight[usize::from(mdata)], true) {
            true => Err(Spl2Error::MdataReused { what: self.what, mdata }),
            false => Ok(()),
        }
    }

    pub(super) fn answered(&mut self, mdata: u16) {
        self.in_flight[usize::from(mdata)] = false;
    }

    pub(super) fn forget(&mut self) {
        self.in_flight.fill(false);
        self.overshoot = 0;
    }
}

/// Restricts the memory that a job may access.
#[derive(Clone, Debug, Default)]
pub(super) struct Guard {
    limits: Option<Limits>,
    /// The result lines that were sent, each with its cycle.
    written: HashMap<u64, u64>,
}

impl Guard {
    pub(super) fn set(&mut self, limits: Option<Limits>) {
        self.limits = limits;
        self.written.clear();
    }

    pub(super) fn read(&self, line: u64) -> Result<(), Spl2Error> {
        let Some(limits) = &self.limits else { return Ok(()) };
        match limits.reads.iter().any(|range| range.contains(&line)) {
            true => Ok(()),
            false => Err(Spl2Error::Outside { what: "read", line }),
        }
    }

    /// The cycle in which a line of the results was sent.
    pub(super) fn written(&self, line: u64) -> Option<u64> {
        self.written.get(&line).copied()
    }

    pub(super) fn write(&mut self, line: u64, cycle: u64) -> Result<(), Spl2Error> {
        let Some(limits) = &self.limits else { return Ok(()) };
        if limits.results.contains(&line) {
            return if self.written.insert(line, cycle).is_none() {
                Ok(())
            } else {
                Err(Spl2Error::WrittenTwice(line))
            };
        }
        match limits.status.contains(&line) {
            true => Ok(()),
            false => Err(Spl2Error::Outside { what: "write", line }),
        }
    }
}
