//! AXI4-Lite: what host and AFU drive, and the rules between them.

use super::error::AxiError;

/// The outputs of the host in one cycle; `None` for a channel whose VALID is low.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct LiteMaster {
    pub(crate) aw: Option<u32>,
    /// Data and strobes.
    pub(crate) w: Option<(u32, u8)>,
    pub(crate) b_ready: bool,
    pub(crate) ar: Option<u32>,
    pub(crate) r_ready: bool,
}

/// The outputs of the AFU in one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct LiteSlave {
    pub(crate) aw_ready: bool,
    pub(crate) w_ready: bool,
    /// The response of a write.
    pub(crate) b: Option<u8>,
    pub(crate) ar_ready: bool,
    /// Data and response of a read.
    pub(crate) r: Option<(u32, u8)>,
}

/// Checks the AFU's side of AXI4-Lite in every cycle.
#[derive(Clone, Debug, Default)]
pub(crate) struct LiteMonitor {
    pending: LiteSlave,
    /// Addresses and data of writes, and addresses of reads, that were taken and not answered.
    addresses: u32,
    data: u32,
    reads: u32,
}

impl LiteMonitor {
    /// The AFU is in reset.
    pub(crate) fn reset(&mut self, afu: &LiteSlave, settled: bool) -> Result<(), AxiError> {
        *self = Self::default();
        for (channel, valid) in [("B", afu.b.is_some()), ("R", afu.r.is_some())] {
            if valid && settled {
                return Err(AxiError::InReset(channel));
            }
        }
        Ok(())
    }

    /// Checks one cycle.
    pub(crate) fn check(&mut self, host: &LiteMaster, afu: &LiteSlave) -> Result<(), AxiError> {
        let LiteSlave { b, r, .. } = self.pending;
        if b.is_some() && b != afu.b {
            return Err(AxiError::Unstable("B"));
        }
        if r.is_some() && r != afu.r {
            return Err(AxiError::Unstable("R"));
        }
        let fail = |channel, why| Err(AxiError::Response { channel, why });
        if let Some(response) = afu.b {
            if self.addresses.min(self.data) == 0 {
                return fail("B", "a response without a write");
            }
            if response != 0 {
                return fail("B", "a response other than OKAY");
            }
            let taken = u32::from(host.b_ready);
            (self.addresses, self.data) = (self.addresses - taken, self.data - taken);
        }
        if let Some((_, response)) = afu.r {
            if self.reads == 0 {
                return fail("R", "data without a read");
            }
            if response != 0 {
                return fail("R", "a response other than OKAY");
            }
            self.reads -= u32::from(host.r_ready);
        }
        self.addresses += u32::from(host.aw.is_some() && afu.aw_ready);
        self.data += u32::from(host.w.is_some() && afu.w_ready);
        self.reads += u32::from(host.ar.is_some() && afu.ar_ready);
        self.pending.b = afu.b.filter(|_| !host.b_ready);
        self.pending.r = afu.r.filter(|_| !host.r_ready);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_can_be_broken() {
        let error = |cycles: &[(LiteMaster, LiteSlave)]| {
            let mut monitor = LiteMonitor::default();
            cycles.iter().find_map(|(host, afu)| Some(monitor.check(host, afu).err()?.to_string()))
        };
        let ready = LiteSlave { aw_ready: true, w_ready: true, ar_ready: true, ..LiteSlave::default() };
        let write = LiteMaster { aw: Some(0), w: Some((1, 15)), ..LiteMaster::default() };
        let read = LiteMaster { ar: Some(0), ..LiteMaster::default() };
        let (b, r) = (LiteSlave { b: Some(0), ..ready }, LiteSlave { r: Some((5, 0)), ..ready });
        let (idle, takes) =
            (LiteMaster::default(), LiteMaster { b_ready: true, r_ready: true, ..LiteMaster::default() });
        assert_eq!(error(&[(write, ready), (idle, b), (takes, b), (read, ready), (idle, r), (takes, r)]), None);
        let cases: [(&[(LiteMaster, LiteSlave)], &str); 8] = [
            (&[(write, ready), (idle, b), (idle, ready)], "channel B changed"),
            (&[(read, ready), (idle, r), (idle, LiteSlave { r: Some((6, 0)), ..ready })], "channel R changed"),
            (&[(idle, b)], "a response without a write"),
            (&[(LiteMaster { w: None, ..write }, ready), (idle, b)], "a response without a write"),
            (&[(write, ready), (takes, b), (takes, b)], "a response without a write"),
            (&[(write, ready), (idle, LiteSlave { b: Some(2), ..ready })], "other than OKAY"),
            (&[(idle, r)], "data without a read"),
            (&[(read, ready), (takes, r), (takes, r)], "data without a read"),
        ];
        for (cycles, expected) in cases {
            let found = error(cycles).unwrap_or_default();
            assert!(found.contains(expected), "{expected}: {found}");
        }
    }
}
