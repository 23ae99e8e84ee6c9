//! The rules of AXI4 between the AFU and its memory, checked in every cycle.

use std::collections::VecDeque;

use super::error::AxiError;
use super::signals::{Address, FromMemory, ToMemory};

/// No burst crosses a multiple of this.
const PAGE_BYTES: u64 = 4096;
const LINE_BYTES: u64 = crate::link::LINE_BYTES;
/// INCR.
const INCREMENTING: u8 = 1;
/// Normal, not cacheable, bufferable.
const CACHE: u8 = 3;

/// The state that the rules need.
#[derive(Clone, Debug)]
pub(super) struct Monitor {
    beat_bytes: u64,
    /// Outputs of the AFU in the last cycle that were not taken.
    pending: ToMemory,
    /// Beats of the write bursts whose address was taken, and those whose last beat was taken. One of the two is empty.
    addresses: VecDeque<u64>,
    data: VecDeque<u64>,
    /// Beats taken of the present write burst.
    beat: u64,
    /// Write bursts that were taken as a whole and have no response.
    written: u64,
    /// Beats left of each read burst.
    reads: VecDeque<u64>,
}

impl Monitor {
    /// A monitor of a bus of this many bytes.
    pub(super) fn new(beat_bytes: u64) -> Self {
        Self {
            beat_bytes,
            pending: ToMemory::default(),
            addresses: VecDeque::new(),
            data: VecDeque::new(),
            beat: 0,
            written: 0,
            reads: VecDeque::new(),
        }
    }

    /// The AFU and the memory are in reset. `settled` says that the reset has lasted long enough.
    pub(super) fn reset(&mut self, afu: &ToMemory, settled: bool) -> Result<(), AxiError> {
        *self = Self::new(self.beat_bytes);
        for (channel, valid) in [("AW", afu.aw.is_some()), ("W", afu.w.is_some()), ("AR", afu.ar.is_some())] {
            if valid && settled {
                return Err(AxiError::InReset(channel));
            }
        }
        Ok(())
    }

    /// Checks one cycle.
    pub(super) fn check(&mut self, afu: &ToMemory, memory: &FromMemory) -> Result<(), AxiError> {
        self.stable(afu, memory)?;
        for (ready, name) in [(afu.b_ready, "BREADY"), (afu.r_ready, "RREADY")] {
            if !ready {
                return Err(AxiError::Refused(name));
            }
        }
        // What is answered in this cycle was asked for in an earlier one.
        self.responses(memory)?;
        for (channel, address) in [("AW", &afu.aw), ("AR", &afu.ar)] {
            address.as_ref().map_or(Ok(()), |address| self.burst(channel, address))?;
        }
        if let Some(address) = afu.ar.filter(|_| memory.ar_ready) {
            self.reads.push_back(address.beats());
        }
        if let Some(address) = afu.aw.filter(|_| memory.aw_ready) {
            self.addresses.push_back(address.beats());
        }
        if let Some(beat) = afu.w.filter(|_| memory.w_ready) {
            let number = self.beat;
            let fail = |why| Err(AxiError::Beat { beat: number, why });
            if beat.strobes != u64::MAX >> (64 - self.beat_bytes) {
                return fail("strobes are not all ones");
            }
            self.beat += 1;
            if beat.last {
                self.data.push_back(std::mem::take(&mut self.beat));
            } else if self.beat > 255 {
                return fail("no WLAST in 256 beats");
            }
        }
        while let (Some(&asked), Some(&came)) = (self.addresses.front(), self.data.front()) {
            if asked != came {
                return Err(AxiError::Beat { beat: came - 1, why: "WLAST does not agree with AWLEN" });
            }
            self.addresses.pop_front();
            self.data.pop_front();
            self.written += 1;
        }
        if self.data.is_empty() && self.addresses.front().is_some_and(|&asked| self.beat >= asked) {
            return Err(AxiError::Beat { beat: self.beat - 1, why: "no WLAST at the last beat" });
        }
        Ok(())
    }

    fn stable(&mut self, afu: &ToMemory, memory: &FromMemory) -> Result<(), AxiError> {
        let ToMemory { aw, w, ar, .. } = self.pending;
        for (channel, is_stable) in [
            ("AW", aw.is_none() || aw == afu.aw),
            ("W", w.is_none() || w == afu.w),
            ("AR", ar.is_none() || ar == afu.ar),
        ] {
            if !is_stable {
                return Err(AxiError::Unstable(channel));
            }
        }
        self.pending.aw = afu.aw.filter(|_| !memory.aw_ready);
        self.pending.w = afu.w.filter(|_| !memory.w_ready);
        self.pending.ar = afu.ar.filter(|_| !memory.ar_ready);
        Ok(())
    }

    fn burst(&self, channel: &'static str, burst: &Address) -> Result<(), AxiError> {
        let (bytes, beats) = (burst.beats() * self.beat_bytes, burst.beats());
        let Address { address, burst: kind, size, .. } = *burst;
        let why = if kind != INCREMENTING {
            "it is not INCR"
        } else if 1 << size != self.beat_bytes {
            "its beats are not as wide as the bus"
        } else if address % LINE_BYTES != 0 || bytes % LINE_BYTES != 0 {
            "it is not of whole lines"
        } else if address % PAGE_BYTES + bytes > PAGE_BYTES {
            "it crosses 4 KB"
        } else if (burst.id, burst.lock, burst.cache, burst.prot, burst.qos) != (0, 0, CACHE, 0, 0) {
            "it has other attributes than promised"
        } else {
            return Ok(());
        };
        Err(AxiError::Burst { channel, address, beats, why })
    }

    fn responses(&mut self, memory: &FromMemory) -> Result<(), AxiError> {
        if memory.b.is_some() {
            let why = "a response without a write burst";
            self.written = self.written.checked_sub(1).ok_or(AxiError::Response { channel: "B", why })?;
        }
        if let Some(beat) = &memory.r {
            let fail = |why| Err(AxiError::Response { channel: "R", why });
            let Some(left) = self.reads.front_mut() else { return fail("a beat without a read burst") };
            *left -= 1;
            if beat.last != (*left == 0) {
                return fail("RLAST at another beat than the last");
            }
            if beat.last {
                self.reads.pop_front();
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::signals::{OKAY, ReadBeat, WriteBeat};
    use super::*;

    fn burst(address: u64, length: u8) -> Address {
        Address { id: 0, address, length, size: 5, burst: 1, lock: 0, cache: 3, prot: 0, qos: 0 }
    }

    fn beat(last: bool) -> WriteBeat {
        WriteBeat { data: [7; 16], strobes: u64::from(u32::MAX), last }
    }

    fn idle() -> ToMemory {
        ToMemory { b_ready: true, r_ready: true, ..ToMemory::default() }
    }

    fn ready() -> FromMemory {
        FromMemory { aw_ready: true, w_ready: true, ar_ready: true, ..FromMemory::default() }
    }

    /// The first error of these cycles, on a bus of 256 bits.
    fn error(cycles: &[(ToMemory, FromMemory)]) -> Option<String> {
        let mut monitor = Monitor::new(32);
        cycles.iter().find_map(|(afu, memory)| Some(monitor.check(afu, memory).err()?.to_string()))
    }

    #[test]
    fn a_write_and_a_read_keep_the_rules() {
        let (b, r) = (FromMemory { b: Some(OKAY), ..ready() }, ReadBeat { data: [0; 16], response: OKAY, last: false });
        let cycles = [
            // The data first, and the address while its last beat is refused.
            (ToMemory { w: Some(beat(false)), ..idle() }, ready()),
            (
                ToMemory { w: Some(beat(true)), aw: Some(burst(64, 1)), ..idle() },
                FromMemory { w_ready: false, ..ready() },
            ),
            (ToMemory { w: Some(beat(true)), ar: Some(burst(4096 - 64, 1)), ..idle() }, ready()),
            (idle(), b),
            (idle(), FromMemory { r: Some(r), ..ready() }),
            (idle(), FromMemory { r: Some(ReadBeat { last: true, ..r }), ..ready() }),
        ];
        assert_eq!(error(&cycles), None);
    }

    #[test]
    fn every_rule_can_be_broken() {
        let refused = FromMemory::default();
        let aw = |burst| ToMemory { aw: Some(burst), ..idle() };
        let ar = |burst| ToMemory { ar: Some(burst), ..idle() };
        let w = |beat| ToMemory { w: Some(beat), ..idle() };
        let r = |last| FromMemory { r: Some(ReadBeat { data: [0; 16], response: OKAY, last }), ..ready() };
        let cases: [(&[(ToMemory, FromMemory)], &str); 17] = [
            (&[(aw(burst(0, 1)), refused), (idle(), ready())], "channel AW changed"),
            (&[(ar(burst(0, 1)), refused), (ar(burst(64, 1)), ready())], "channel AR changed"),
            (&[(w(beat(true)), refused), (w(beat(false)), ready())], "channel W changed"),
            (&[(ToMemory { b_ready: false, ..idle() }, ready())], "BREADY is low"),
            (&[(ToMemory { r_ready: false, ..idle() }, ready())], "RREADY is low"),
            (&[(ar(burst(4096 - 64, 3)), ready())], "it crosses 4 KB"),
            (&[(ar(burst(32, 1)), ready())], "it is not of whole lines"),
            (&[(aw(burst(64, 0)), ready())], "it is not of whole lines"),
            (&[(aw(Address { burst: 2, ..burst(0, 1) }), ready())], "it is not INCR"),
            (&[(aw(Address { size: 4, ..burst(0, 1) }), ready())], "as wide as the bus"),
            (&[(ar(Address { cache: 15, ..burst(0, 1) }), ready())], "other attributes"),
            (&[(w(WriteBeat { strobes: 1, ..beat(true) }), ready())], "strobes"),
            (&[(aw(burst(0, 1)), ready()), (w(beat(true)), ready())], "WLAST does not agree"),
            (
                &[(aw(burst(0, 1)), ready()), (w(beat(false)), ready()), (w(beat(false)), ready())],
                "no WLAST at the last",
            ),
            (&[(idle(), FromMemory { b: Some(OKAY), ..ready() })], "a response without a write burst"),
            (&[(idle(), r(true))], "a beat without a read burst"),
            (&[(ar(burst(0, 1)), ready()), (idle(), r(true))], "RLAST at another beat"),
        ];
        for (cycles, expected) in cases {
            let error = error(cycles).unwrap_or_default();
            assert!(error.contains(expected), "{expected}: {error}");
        }
        let in_reset = Monitor::new(32).reset(&w(beat(true)), true).map_err(|error| error.to_string());
        assert_eq!(in_reset, Err("channel W is valid in reset".to_owned()));
    }
}
