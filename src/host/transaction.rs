//! A transaction as types: the paper's seven steps (section IV.A, Figure 3), each possible only after the one before.

use super::error::HostError;
use super::lines::{Contacts, pack};
use super::report::Report;
use super::results::JobResults;
use super::session::Session;
use super::transport::Transport;
use super::workspace::pages_for;
use crate::afu::shell::spl2::map::{self, performance, status};
use crate::kernel::{ContactRecord, PairRecord, settle};
use crate::link::{LINE_BYTES, Line, Traffic};

/// After step 1: the pointers are known.
#[derive(Debug)]
pub struct Pointed(());
/// After step 2: the pairs lie in the source, SPL is started.
#[derive(Debug)]
pub struct Loaded(());
/// After step 3: the start word is in the control memory.
#[derive(Debug)]
pub struct Started {
    clock: Begin,
}
/// After step 4: the AFU said who it is.
#[derive(Debug)]
pub struct Running {
    clock: Begin,
}
/// After step 5: the status is there.
#[derive(Debug)]
pub struct Done {
    clock: Begin,
    status: Line,
    cycle: u64,
}
/// After step 6: the results are the host's.
#[derive(Debug)]
pub struct Retrieved {
    results: JobResults,
}

/// When a job began: the cycle, the traffic before it, the device's writes before it.
#[derive(Clone, Copy, Debug)]
struct Begin {
    cycle: u64,
    traffic: Traffic,
    logged: usize,
}

/// A transaction at the step that `S` names. Each step takes the transaction and gives the next, so none can be left
/// out, done twice or done early. One that fails, or is dropped, ends properly all the same: the stop sequence is sent
/// and the workspace freed.
///
/// ```
/// use contact_afu::{config::Config, host::*, kernel::PairRecord, link::LinkModel};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let config = Config::default();
/// let expected = Expected::new(&config)?;
/// let workspace = Workspace::for_pairs(expected.layout, 100, 1)?;
/// let mut session = Session::new(Software::new(&config, LinkModel::ideal())?, workspace, expected);
///
/// let pairs = [PairRecord::from_spheres([0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0])];
/// let transaction = session.transaction(); // 1: pointers
/// let transaction = transaction.send(&pairs)?; // 2: data, SPL
/// let transaction = transaction.start()?; // 3: start word and nCol
/// let transaction = transaction.confirm()?; // 4: AFU_ID
/// let transaction = transaction.wait()?; // 5: done
/// let transaction = transaction.retrieve()?; // 6: results
/// let results = transaction.end()?; // 7: the workspace is freed
/// assert_eq!(results.contacts[0].depth(), 1.0);
/// # Ok(())
/// # }
/// ```
///
/// Nothing can be started that was not sent:
/// ```compile_fail,E0599
/// # use contact_afu::host::*;
/// fn early<T: Transport>(session: &mut Session<T>) -> Result<(), HostError> {
///     session.transaction().start()?;
///     Ok(())
/// }
/// ```
/// Results cannot be read before the status is there:
/// ```compile_fail,E0599
/// # use contact_afu::host::*;
/// fn early<T: Transport>(running: Transaction<'_, T, Running>) -> Result<(), HostError> {
///     running.retrieve()?;
///     Ok(())
/// }
/// ```
/// A step cannot be done twice:
/// ```compile_fail,E0382
/// # use contact_afu::host::*;
/// fn twice<T: Transport>(loaded: Transaction<'_, T, Loaded>) -> Result<(), HostError> {
///     loaded.start()?;
///     loaded.start()?;
///     Ok(())
/// }
/// ```
/// Nor can two transactions of a session be open at once:
/// ```compile_fail,E0499
/// # use contact_afu::host::*;
/// fn two<T: Transport>(session: &mut Session<T>) {
///     let first = session.transaction();
///     let second = session.transaction();
///     drop((first, second));
/// }
/// ```
#[derive(Debug)]
pub struct Transaction<'s, T: Transport, S> {
    open: Open<'s, T>,
    state: S,
}

/// What has to be undone, by the last step or by dropping.
#[derive(Debug)]
struct Open<'s, T: Transport> {
    session: &'s mut Session<T>,
    is_spl_started: bool,
    /// Pairs, once they are in the source.
    pairs: u32,
    /// They themselves, for those that the AFU leaves unsettled.
    sent: Vec<PairRecord>,
    report: Report,
}

impl<T: Transport> Open<'_, T> {
    /// Stops SPL and frees what the transaction used of the workspace.
    fn finish(&mut self) -> Result<(), HostError> {
        if !std::mem::take(&mut self.is_spl_started) {
            return Ok(());
        }
        let begun = self.session.transport.cycle();
        let stopped = self.session.stop_spl();
        self.report.tear_down = self.session.transport.cycle() - begun;
        let Session { transport, workspace, .. } = &mut *self.session;
        let (layout, pairs) = (*workspace.layout(), u64::from(self.pairs));
        let used = [
            (workspace.source(), layout.source_lines(pairs) + u64::from(map::DATA_LINE)),
            (workspace.destination(), layout.destination_lines(pairs)),
        ];
        for (base, lines) in used {
            for line in (0..lines).filter_map(|line| workspace.line(base, line).ok()) {
                transport.memory_mut().forget(line..line + 1);
            }
        }
        stopped
    }
}

impl<T: Transport> Drop for Open<'_, T> {
    fn drop(&mut self) {
        // Whatever goes wrong now, there is nobody to tell; the next transaction begins with a reset.
        let _ = self.finish();
    }
}

impl<'s, T: Transport, S> Transaction<'s, T, S> {
    /// The device, with the memory.
    pub fn transport(&self) -> &T {
        &self.open.session.transport
    }

    fn to<N>(self, state: impl FnOnce(S) -> N) -> Transaction<'s, T, N> {
        Transaction { open: self.open, state: state(self.state) }
    }
}

impl<'s, T: Transport> Transaction<'s, T, Pointed> {
    pub(super) fn new(session: &'s mut Session<T>) -> Self {
        let Session { transport, .. } = &*session;
        let stated = transport.link().session;
        let report = Report { stated_set_up: stated.set_up, stated_tear_down: stated.tear_down, ..Report::default() };
        Self { open: Open { session, is_spl_started: false, pairs: 0, sent: Vec::new(), report }, state: Pointed(()) }
    }

    /// pVAFU2_CNTXT: virtual byte address of the AFU's context.
    pub fn context(&self) -> u64 {
        self.open.session.workspace.context()
    }

    /// pSource: virtual byte address of the control memory, behind which the pairs go.
    pub fn source(&self) -> u64 {
        self.open.session.workspace.source()
    }

    /// pDest: virtual byte address of the results.
    pub fn destination(&self) -> u64 {
        self.open.session.workspace.destination()
    }

    /// Step 2: puts the pairs into the source and starts SPL.
    ///
    /// # Errors
    /// More pairs than the buffers hold; no AFU_ID, or not that of the AFU expected; what the device did wrong.
    pub fn send(mut self, pairs: &[PairRecord]) -> Result<Transaction<'s, T, Loaded>, HostError> {
        self.open.session.workspace.layout().check(pairs)?;
        self.open.sent = pairs.to_vec();
        let Open { session, is_spl_started, report, pairs: sent, .. } = &mut self.open;
        let capacity = session.workspace.capacity();
        let (layout, count) = (*session.workspace.layout(), pairs.len() as u64);
        let too_many = || HostError::TooManyPairs { pairs: count, capacity, pages: pages_for(&layout, count) };
        *sent = u32::try_from(count).ok().filter(|_| count <= capacity).ok_or_else(too_many)?;
        report.pairs = count;
        for (number, line) in (u64::from(map::DATA_LINE)..).zip(pack(&layout, pairs)) {
            let at = session.workspace.line(session.workspace.source(), number)?;
            session.transport.memory_mut().set(at, &line);
        }
        for number in 0..layout.destination_lines(count) {
            let at = session.workspace.line(session.workspace.destination(), number)?;
            session.transport.memory_mut().forget(at..at + 1);
        }
        session.sequence = session.sequence.wrapping_add(1);
        let begun = session.transport.cycle();
        *is_spl_started = true;
        session.start_spl()?;
        report.set_up = session.transport.cycle() - begun;
        Ok(self.to(|_| Loaded(())))
    }
}

impl<'s, T: Transport> Transaction<'s, T, Loaded> {
    /// Step 3: writes nCol and the start word into the control memory.
    ///
    /// # Errors
    /// [`HostError::Outside`], which a workspace cannot give.
    pub fn start(self) -> Result<Transaction<'s, T, Started>, HostError> {
        let transport = &self.open.session.transport;
        let (cycle, traffic, logged) = (transport.cycle(), transport.traffic(), transport.device_writes().len());
        self.open.session.set_control(self.open.pairs, false)?;
        Ok(self.to(|_| Started { clock: Begin { cycle, traffic, logged } }))
    }
}

impl<'s, T: Transport> Transaction<'s, T, Started> {
    /// Step 4: the AFU_ID in the DSM says that the AFU is there, and that it is the one expected. (It is written while
    /// SPL starts, and was waited for then.)
    ///
    /// # Errors
    /// When it is another by now.
    pub fn confirm(self) -> Result<Transaction<'s, T, Running>, HostError> {
        self.open.session.check_identity()?;
        Ok(self.to(|started| Running { clock: started.clock }))
    }
}

impl<'s, T: Transport> Transaction<'s, T, Running> {
    /// Asks the AFU to abort the job; its status then says so.
    ///
    /// # Errors
    /// [`HostError::Outside`], which a workspace cannot give.
    pub fn abort(&mut self) -> Result<(), HostError> {
        self.open.session.set_control(self.open.pairs, true)
    }

    /// Lets time pass without looking.
    ///
    /// # Errors
    /// What the device did wrong meanwhile.
    pub fn idle(&mut self, cycles: u64) -> Result<(), HostError> {
        Ok(self.open.session.transport.advance(cycles)?)
    }

    /// Step 5: waits for the status.
    ///
    /// # Errors
    /// [`HostError::NoStatus`] when it does not come in as many cycles as a right AFU needs at most
    /// ([`patience`](crate::patience)), or as [`Session::max_cycles`] says; what the device did wrong.
    pub fn wait(self) -> Result<Transaction<'s, T, Done>, HostError> {
        let session = &mut *self.open.session;
        let patience = session.max_cycles.unwrap_or_else(|| session.patience(self.open.pairs.into()));
        let (status, cycle) = session.wait_for_status(self.state.clock.logged, patience)?;
        Ok(self.to(|running| Done { clock: running.clock, status, cycle }))
    }
}

impl<'s, T: Transport> Transaction<'s, T, Done> {
    /// Step 6: takes the results from the destination.
    ///
    /// # Errors
    /// [`HostError::Job`] when the AFU ended the job with an error; [`HostError::Stale`], [`HostError::Unwritten`] when
    /// memory does not hold what the status promises.
    pub fn retrieve(mut self) -> Result<Transaction<'s, T, Retrieved>, HostError> {
        let Done { clock, status, cycle } = self.state;
        let session = &*self.open.session;
        let found = status::SEQUENCE.get(&status) as u32;
        if found != session.sequence {
            return Err(HostError::Stale { expected: session.sequence, found });
        }
        HostError::of_status(status::ERROR.get(&status) as u8).map_or(Ok(()), Err)?;

        let (workspace, memory) = (&session.workspace, session.transport.memory());
        let layout = workspace.layout();
        let mut lines = Vec::new();
        for number in 0..layout.destination_lines(self.open.pairs.into()) {
            let line = memory.get(workspace.line(workspace.destination(), number)?);
            lines.push(Some(*line.ok_or(HostError::Unwritten(number))?));
        }
        let memory = Contacts::new(layout, &lines);
        let read = (0..self.open.pairs as usize).filter_map(|pair| memory.get(pair));
        let mut contacts: Vec<ContactRecord> = read.collect();
        // Before anyone reads them: what the profile exact could not settle.
        let unsettled = settle(&self.open.sent, &mut contacts, layout.fields());

        let figures = session.dsm(map::PERFORMANCE_LINE);
        let traffic = session.transport.traffic();
        let reads = traffic.read_responses - clock.traffic.read_responses;
        let writes = traffic.write_responses - clock.traffic.write_responses;
        let report = &mut self.open.report;
        report.run = performance::BUSY.get(&figures) as u64;
        report.handshake = (cycle - clock.cycle).saturating_sub(report.run);
        (report.bytes_read, report.bytes_written) = (reads * LINE_BYTES, writes * LINE_BYTES);
        report.link_limit = session.transport.link().limit_cycles(reads, writes);
        let word = |field: map::Field| field.get(&status) as u32;
        let results = JobResults {
            contacts,
            hits: word(status::CONTACTS),
            invalid: word(status::INVALID),
            first_invalid: Some(word(status::FIRST_INVALID)).filter(|&pair| pair != u32::MAX),
            unsettled,
            record: layout.record(),
            report: *report,
        };
        Ok(self.to(|_| Retrieved { results }))
    }
}

impl<T: Transport> Transaction<'_, T, Retrieved> {
    /// Step 7: stops SPL and frees the workspace.
    ///
    /// # Errors
    /// What the device did wrong meanwhile.
    pub fn end(mut self) -> Result<JobResults, HostError> {
        self.open.finish()?;
        let mut results = self.state.results;
        results.report = self.open.report;
        self.open.session.reports.push(self.open.report);
        Ok(results)
    }
}
