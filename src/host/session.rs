//! A device with its workspace, and the operations that transactions use.

use super::error::HostError;
use super::received::{Begin, Status};
use super::report::Report;
use super::transaction::{Pointed, Transaction};
use super::transport::{Transport, TransportError};
use super::workspace::{AFU_DSM, SPL_CONTEXT, SPL_DSM, Workspace};
use crate::afu::shell::spl2::map::{self, Csr, control, identity, status};
use crate::afu::{Afu, BuildError, Spec};
use crate::config::Config;
use crate::link::spl2::CsrOffset;
use crate::link::{LINE_BYTES, Line, Traffic};
use crate::patience::{self, Patience, Work};
use crate::query::PairRecord;
use crate::record::{Capability, LINE_BITS, Layout, Part, pack};

/// Cycles between two calls of `progress`.
pub(super) const PROGRESS_CYCLES: u64 = 4096;

/// The AFU that a session expects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Expected {
    /// The capability word.
    pub capability: u64,
    /// The bits of that word that the AFU must match.
    pub compared: u64,
    /// The layout of records in its lines.
    pub layout: Layout,
}

impl Expected {
    /// The AFU of a configuration.
    ///
    /// # Errors
    /// Returns an error if the AFU cannot be generated.
    pub fn new(config: &Config) -> Result<Self, BuildError> {
        let afu = Afu::generate(Spec::from(config.clone()))?;
        Ok(Self { capability: afu.capability(), compared: u64::MAX, layout: afu.layout() })
    }

    /// The AFU of a configuration whose Verilog may have been edited. Of its capability word, only the number of SCPUs
    /// is compared.
    pub fn edited(config: &Config) -> Self {
        Self { capability: config.scpus.into(), compared: Part::SCPUS.mask(), layout: Layout::of(LINE_BITS, config) }
    }

    /// Compares the parts of a capability word.
    fn check(&self, found: u64) -> Result<(), HostError> {
        for part in Part::ALL {
            let (expected, found) = (part.of(self.capability), part.of(found & self.compared));
            if expected != found {
                return Err(HostError::Capability { what: part.meaning, expected, found });
            }
        }
        Ok(())
    }
}

/// A device and a workspace, which run one transaction after another. The workspace's pages are pinned once for all of
/// them.
#[derive(Debug)]
pub struct Session<T: Transport> {
    pub(super) transport: T,
    pub(super) workspace: Workspace,
    expected: Expected,
    /// The capability that the AFU reported; `None` before it did.
    afu: Capability,
    /// The number of the last transaction.
    pub(super) sequence: u32,
    /// Cycles without a response, while one is outstanding, after which the AFU aborts a job. With 0 it never does.
    pub watchdog: u32,
    /// The most cycles to wait for a status. `None` leaves it to [`patience`](crate::patience).
    pub max_cycles: Option<u64>,
    pub(super) reports: Vec<Report>,
}

impl<T: Transport> Session<T> {
    /// A session with the device behind `transport`, over `workspace`, which must have the expected AFU's layout.
    pub fn new(transport: T, workspace: Workspace, expected: Expected) -> Self {
        let afu = Capability::from_bits(expected.capability);
        Self { transport, workspace, expected, afu, sequence: 0, watchdog: 0, max_cycles: None, reports: Vec::new() }
    }

    /// Begins a transaction. This is the paper's step 1, in which the host gets its pointers.
    pub fn transaction(&mut self) -> Transaction<'_, T, Pointed> {
        Transaction::new(self)
    }

    /// The workspace.
    pub fn workspace(&self) -> &Workspace {
        &self.workspace
    }

    /// Replaces the workspace from the next transaction on. Writes that were in flight during a reset may still arrive
    /// in the old one.
    pub fn set_workspace(&mut self, workspace: Workspace) {
        self.workspace = workspace;
    }

    /// The device.
    pub fn transport(&self) -> &T {
        &self.transport
    }

    /// The device, to plant faults.
    pub fn transport_mut(&mut self) -> &mut T {
        &mut self.transport
    }

    /// The reports of all completed transactions, in order.
    pub fn reports(&self) -> &[Report] {
        &self.reports
    }

    /// Writes both halves of a 64-bit CSR.
    fn write_pointer(&mut self, high: u32, low: u32, address: u64) -> Result<(), TransportError> {
        self.transport.write_csr(high, (address >> 32) as u32)?;
        self.transport.write_csr(low, address as u32)
    }

    fn zero(&mut self, address: u64, lines: u64) {
        let first = address / LINE_BYTES;
        (first..first + lines).for_each(|line| self.transport.memory_mut().set(line, &[0; 16]));
    }

    /// The most cycles that this number of pairs may take.
    fn patience(&self, pairs: u64) -> Patience {
        let layout = self.workspace.layout();
        let (reads, writes) = (layout.source_lines(pairs), layout.destination_lines(pairs));
        let work = Work { pairs, reads, writes, watchdog: self.watchdog };
        patience::spl2(&self.afu, self.transport.link(), &self.transport.spl2(), &work)
    }

    /// Puts pairs into the source as the next job. Its start word is not written yet.
    pub(super) fn load(&mut self, pairs: &[PairRecord]) -> Result<(), HostError> {
        let (layout, count) = (*self.workspace.layout(), pairs.len() as u64);
        self.put(self.workspace.source(), map::CONTROL_LINE.into(), &[0; 16])?;
        for (number, line) in (u64::from(map::DATA_LINE)..).zip(pack(&layout, pairs)) {
            self.put(self.workspace.source(), number, &line)?;
        }
        for number in 0..layout.destination_lines(count) {
            let at = self.workspace.line(self.workspace.destination(), number)?;
            self.transport.memory_mut().forget(at..at + 1);
        }
        self.sequence = self.sequence.wrapping_add(1);
        Ok(())
    }

    fn put(&mut self, base: u64, number: u64, line: &Line) -> Result<(), HostError> {
        let at = self.workspace.line(base, number)?;
        self.transport.memory_mut().set(at, line);
        Ok(())
    }

    /// Resets SPL and the AFU, gives them their memory, waits for the AFU to identify itself, and enables it.
    pub(super) fn start_spl(&mut self) -> Result<(), HostError> {
        let pair = |high: Csr, low: Csr| (high.offset, low.offset);
        self.transport.limit(None);
        self.transport.write_csr(CsrOffset::Control as u32, 1)?;
        self.zero(SPL_DSM, 1);
        self.write_pointer(CsrOffset::DsmHigh as u32, CsrOffset::DsmLow as u32, SPL_DSM)?;
        self.wait_for(|session| session.line_at(SPL_DSM)[0] != 0)?;
        self.zero(AFU_DSM, map::DSM_BYTES / LINE_BYTES);
        self.transport.watch(AFU_DSM / LINE_BYTES..(AFU_DSM + map::DSM_BYTES) / LINE_BYTES);
        let (high, low) = pair(map::DSM_BASE_HIGH, map::DSM_BASE_LOW);
        self.write_pointer(high, low, AFU_DSM)?;
        self.wait_for(|session| identity::AFU_ID.get(&session.dsm(map::IDENTITY_LINE)) != 0)?;
        self.check_identity()?;
        self.workspace.describe(self.transport.memory_mut())?;
        let status = self.workspace.line(self.workspace.context(), map::STATUS_LINE.into())?;
        self.transport.watch(status..status + 1);
        self.write_pointer(CsrOffset::ContextHigh as u32, CsrOffset::ContextLow as u32, SPL_CONTEXT)?;
        let (high, low) = pair(map::CONTEXT_BASE_HIGH, map::CONTEXT_BASE_LOW);
        self.write_pointer(high, low, self.workspace.context())?;
        Ok(self.transport.write_csr(CsrOffset::Control as u32, 2)?)
    }

    /// Disables SPL, then resets it.
    pub(super) fn stop_spl(&mut self) -> Result<(), HostError> {
        self.transport.write_csr(CsrOffset::Control as u32, 0)?;
        Ok(self.transport.write_csr(CsrOffset::Control as u32, 1)?)
    }

    /// Waits for an identity in a DSM.
    fn wait_for(&mut self, is_there: impl Fn(&Self) -> bool) -> Result<(), HostError> {
        let (begun, patience) = (self.transport.cycle(), self.patience(0).whole);
        while !is_there(self) {
            let waited = self.transport.cycle() - begun;
            if waited > patience {
                return Err(HostError::NoIdentity(waited));
            }
            self.transport.advance(1)?;
        }
        Ok(())
    }

    /// True if the DSM has the identity of the expected AFU.
    pub(super) fn check_identity(&mut self) -> Result<(), HostError> {
        let line = self.dsm(map::IDENTITY_LINE);
        let (afu_id, version) = (identity::AFU_ID.get(&line), identity::VERSION.get(&line) as u32);
        if (afu_id, version) != (map::AFU_ID, map::VERSION) {
            return Err(HostError::Identity { afu_id, version });
        }
        let found = identity::CAPABILITY.get(&line) as u64;
        self.afu = Capability::from_bits(found);
        self.expected.check(found)
    }

    fn line_at(&self, address: u64) -> Line {
        self.transport.memory().get(address / LINE_BYTES).copied().unwrap_or_default()
    }

    /// A line of the AFU's DSM.
    pub(super) fn dsm(&self, line: u32) -> Line {
        self.line_at(AFU_DSM + u64::from(line) * LINE_BYTES)
    }

    /// Writes the control memory.
    pub(super) fn set_control(&mut self, pairs: u32, abort: bool) -> Result<(), HostError> {
        let mut line = [0; 16];
        control::COUNT.set(&mut line, pairs.into());
        control::SEQUENCE.set(&mut line, self.sequence.into());
        control::ABORT.set(&mut line, abort.into());
        control::WATCHDOG.set(&mut line, self.watchdog.into());
        control::START.set(&mut line, map::START_WORD.into());
        self.put(self.workspace.source(), map::CONTROL_LINE.into(), &line)
    }

    /// Begins the job that is loaded. From now on the device may access only the lines of this job.
    pub(super) fn start(&mut self, pairs: u32) -> Result<Begin, HostError> {
        let Self { transport, workspace, .. } = self;
        transport.limit(Some(workspace.limits(pairs.into())));
        let (cycle, traffic, logged) = (transport.cycle(), transport.traffic(), transport.device_writes().len());
        self.set_control(pairs, false)?;
        Ok(Begin { cycle, traffic, logged })
    }

    /// The status of the job with this beginning; `None` until it has arrived.
    pub(super) fn status(&self, begin: &Begin) -> Option<Status> {
        let status_line = u64::from(map::STATUS_LINE) * LINE_BYTES;
        let at = self.workspace.physical(self.workspace.context() + status_line)?;
        let of_job = |line: &Line| status::SEQUENCE.get(line) == self.sequence.into() && status::DONE.get(line) == 1;
        let new = self.transport.device_writes().get(begin.logged..)?;
        let write = new.iter().find(|write| write.address == at && of_job(&write.data))?;
        Some(Status { line: write.data, cycle: write.cycle })
    }

    /// Waits for the status of a job of `pairs` pairs, and calls `progress` now and then with the traffic over the link
    /// so far.
    pub(super) fn wait_for_status(
        &mut self,
        begin: &Begin,
        pairs: u32,
        progress: &mut dyn FnMut(Traffic),
    ) -> Result<Status, HostError> {
        let patience = self.patience(pairs.into());
        let whole = self.max_cycles.unwrap_or(patience.whole);
        loop {
            if let Some(status) = self.status(begin) {
                return Ok(status);
            }
            let now = self.transport.cycle();
            let (cycles, quiet) = (now - begin.cycle, now - self.transport.last_work().max(begin.cycle));
            if cycles > whole || quiet > patience.quiet {
                let (before, now) = (begin.traffic, self.transport.traffic());
                let owed = |asked: u64, answered: u64| asked.saturating_sub(answered);
                return Err(HostError::NoStatus {
                    cycles,
                    reads: owed(now.reads - before.reads, now.read_responses - before.read_responses),
                    writes: owed(now.writes - before.writes, now.write_responses - before.write_responses),
                });
            }
            self.transport.advance(1)?;
            if self.transport.cycle().is_multiple_of(PROGRESS_CYCLES) {
                progress(self.transport.traffic());
            }
        }
    }
}
