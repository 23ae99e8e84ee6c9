//! A device with its workspace, and the operations that transactions use.

use super::error::HostError;
use super::handshake::{Identity, Protocol, axi, spl2};
use super::received::{Begin, Status};
use super::report::Report;
use super::task::Task;
use super::transaction::{Pointed, Transaction};
use super::transport::Transport;
use super::workspace::Workspace;
use crate::afu::shell::spl2::map::AFU_ID;
use crate::afu::{Afu, BuildError, Spec};
use crate::config::{Config, Input};
use crate::link::{LINE_BYTES, Line, Traffic};
use crate::patience::Patience;
use crate::record::{Capability, LINE_BITS, Layout, Part};

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
        let capability = Capability::new(config, 0).bits();
        Self { capability, compared: Part::SCPUS.mask(), layout: Layout::of(LINE_BITS, config) }
    }

    /// Compares the parts of a capability word.
    fn check(&self, found: u64) -> Result<(), HostError> {
        for part in Part::ALL {
            let [expected, found] = [self.capability, found].map(|word| part.of(word & self.compared));
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

    /// What the expected AFU takes.
    pub(super) fn input(&self) -> Input {
        Capability::from_bits(self.expected.capability).search.map_or(Input::Direct, |_| Input::Spheres)
    }

    /// The spheres that the expected AFU's table holds.
    ///
    /// # Errors
    /// Returns an error if it takes pairs.
    pub(super) fn table(&self) -> Result<u32, HostError> {
        let search = Capability::from_bits(self.expected.capability).search;
        let refused = HostError::Input { taken: "pairs", sent: "spheres", option: Input::Spheres };
        search.map(|search| search.table).ok_or(refused)
    }

    /// The most cycles that a job may take.
    pub(super) fn patience(&self, task: &Task) -> Patience {
        self.transport.patience(&self.afu, &task.work(self.watchdog))
    }

    /// Puts lines into the source as the next job. Its start word is not written yet.
    pub(super) fn load(&mut self, lines: impl IntoIterator<Item = Line>, task: &Task) -> Result<(), HostError> {
        if self.transport.protocol() == Protocol::Spl2 {
            spl2::clear_control(self)?;
        }
        for (number, line) in (0..).zip(lines) {
            self.put(self.workspace.pairs(), number, &line)?;
        }
        for number in 0..task.destination_lines {
            let at = self.workspace.line(self.workspace.destination(), number)?;
            self.transport.forget(at..at + 1);
        }
        self.sequence = self.sequence.wrapping_add(1);
        Ok(())
    }

    pub(super) fn put(&mut self, base: u64, number: u64, line: &Line) -> Result<(), HostError> {
        let at = self.workspace.line(base, number)?;
        self.transport.put(at, line);
        Ok(())
    }

    /// Resets the AFU, gives it its memory if it needs to be told, and waits for it to identify itself.
    pub(super) fn set_up(&mut self) -> Result<(), HostError> {
        self.transport.limit(None);
        match self.transport.protocol() {
            Protocol::Spl2 => spl2::set_up(self),
            Protocol::Axi => axi::set_up(self),
        }
    }

    /// Stops the AFU.
    pub(super) fn tear_down(&mut self) -> Result<(), HostError> {
        match self.transport.protocol() {
            Protocol::Spl2 => spl2::tear_down(self),
            Protocol::Axi => axi::tear_down(self),
        }
    }

    /// Checks that the expected AFU has identified itself.
    pub(super) fn check_identity(&mut self) -> Result<(), HostError> {
        let Identity { afu_id, version, capability } = match self.transport.protocol() {
            Protocol::Spl2 => spl2::identity(self),
            Protocol::Axi => axi::identity(self)?,
        };
        let expected = self.transport.protocol().version();
        if (afu_id, version) != (AFU_ID, expected) {
            return Err(HostError::Identity { afu_id, version, expected });
        }
        self.afu = Capability::from_bits(capability);
        self.expected.check(capability)
    }

    /// Begins the job that is loaded. From now on the device may access only the lines of this job.
    pub(super) fn start(&mut self, task: &Task) -> Result<Begin, HostError> {
        let Self { transport, workspace, .. } = self;
        transport.limit(Some(workspace.limits(task)));
        let (cycle, traffic, logged) = (transport.cycle(), transport.traffic(), transport.device_writes().len());
        match self.transport.protocol() {
            Protocol::Spl2 => spl2::start(self, task)?,
            Protocol::Axi => axi::start(self, task)?,
        }
        Ok(Begin { cycle, traffic, logged })
    }

    /// Asks the AFU to end the job.
    pub(super) fn abort(&mut self, task: &Task) -> Result<(), HostError> {
        match self.transport.protocol() {
            Protocol::Spl2 => spl2::abort(self, task),
            Protocol::Axi => axi::abort(self),
        }
    }

    /// True if the job with this beginning has ended, as far as the host was told.
    pub(super) fn has_ended(&self, begin: &Begin) -> bool {
        match self.transport.protocol() {
            Protocol::Spl2 => spl2::has_ended(self, begin),
            Protocol::Axi => self.transport.interrupt(),
        }
    }

    /// The status of the job with this beginning, if it has ended.
    fn status(&mut self, begin: &Begin) -> Result<Option<Status>, HostError> {
        match self.transport.protocol() {
            Protocol::Spl2 => Ok(spl2::status(self, begin)),
            Protocol::Axi => axi::status(self),
        }
    }

    /// A line of memory; zeros if it was never written.
    pub(super) fn line_at(&self, address: u64) -> Line {
        self.transport.line(address / LINE_BYTES).unwrap_or_default()
    }

    /// Waits for the status of a job, and calls `progress` now and then with the traffic over the link so far.
    pub(super) fn wait_for_status(
        &mut self,
        begin: &Begin,
        task: &Task,
        progress: &mut dyn FnMut(Traffic),
    ) -> Result<Status, HostError> {
        let patience = self.patience(task);
        let whole = self.max_cycles.unwrap_or(patience.whole);
        loop {
            if let Some(status) = self.status(begin)? {
                return Ok(status);
            }
            let now = self.transport.cycle();
            // The cycles of a board are read from a clock, which goes on between two readings.
            let since = |cycle: u64| now.saturating_sub(cycle);
            let (cycles, quiet) = (since(begin.cycle), since(self.transport.last_work().max(begin.cycle)));
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
