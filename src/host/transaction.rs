//! A transaction as types: the paper's seven steps (section IV.A, Figure 3), each possible only after the one before.

use super::error::HostError;
use super::open::Open;
use super::received::{Begin, Status};
use super::results::JobResults;
use super::session::Session;
use super::transport::Transport;
use crate::link::Traffic;
use crate::outcome::Outcome;
use crate::query::PairRecord;

/// After step 1: the pointers are known.
#[derive(Debug)]
pub struct Pointed(());
/// After step 2: the pairs are in the source, or the spheres of a [`SpheresJob`](super::SpheresJob), and SPL is
/// started.
#[derive(Debug)]
pub struct Loaded<J = PairsJob> {
    pub(super) job: J,
}
/// After step 3: the start word is in the control memory.
#[derive(Debug)]
pub struct Started<J = PairsJob> {
    begin: Begin,
    job: J,
}
/// After step 4: the AFU has identified itself.
#[derive(Debug)]
pub struct Running<J = PairsJob> {
    begin: Begin,
    job: J,
}
/// After step 5: the status has arrived.
#[derive(Debug)]
pub struct Done<J = PairsJob> {
    begin: Begin,
    status: Status,
    pub(super) job: J,
}
/// After step 6: the host has the results.
#[derive(Debug)]
pub struct Retrieved<R = JobResults> {
    pub(super) results: R,
}

/// A job of pairs, as a transaction knows it after step 2.
#[derive(Clone, Debug)]
pub struct PairsJob {
    /// The host needs them again if the AFU leaves some unsettled.
    pub(super) pairs: Vec<PairRecord>,
}

/// A transaction at the step that `S` names. Each step takes the transaction and returns the next, so no step can be
/// left out, done twice or done early. If a step fails or a transaction is dropped, it still ends properly: the stop
/// sequence is sent and the workspace is freed.
///
/// ```
/// use contact_afu::{config::Config, host::*, query::PairRecord, link::LinkModel};
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
/// Results cannot be read before the status has arrived:
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
    pub(super) open: Open<'s, T>,
    pub(super) state: S,
}

impl<'s, T: Transport, S> Transaction<'s, T, S> {
    /// The device, with the memory.
    pub fn transport(&self) -> &T {
        &self.open.session.transport
    }

    /// The device, to plant faults.
    pub fn transport_mut(&mut self) -> &mut T {
        &mut self.open.session.transport
    }

    pub(super) fn to<N>(self, state: impl FnOnce(S) -> N) -> Transaction<'s, T, N> {
        Transaction { open: self.open, state: state(self.state) }
    }
}

impl<'s, T: Transport> Transaction<'s, T, Pointed> {
    pub(super) fn new(session: &'s mut Session<T>) -> Self {
        Self { open: Open::new(session), state: Pointed(()) }
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
    /// Returns an error if the AFU takes spheres, if there are more pairs than the buffers hold, if no AFU_ID arrives
    /// or another one than expected, or if the device breaks its protocol.
    pub fn send(mut self, pairs: &[PairRecord]) -> Result<Transaction<'s, T, Loaded>, HostError> {
        let job = self.open.load_pairs(pairs)?;
        self.open.set_up()?;
        Ok(self.to(|_| Loaded { job }))
    }
}

impl<'s, T: Transport, J> Transaction<'s, T, Loaded<J>> {
    /// Step 3: writes nCol and the start word into the control memory.
    ///
    /// # Errors
    /// Returns [`HostError::Outside`], which cannot happen with a workspace.
    pub fn start(mut self) -> Result<Transaction<'s, T, Started<J>>, HostError> {
        let begin = self.open.start()?;
        Ok(self.to(|Loaded { job }| Started { begin, job }))
    }
}

impl<'s, T: Transport, J> Transaction<'s, T, Started<J>> {
    /// Step 4: checks by the AFU_ID in the DSM that the AFU is there and is the expected one. (It is written while SPL
    /// starts, and step 2 waited for it.)
    ///
    /// # Errors
    /// Returns an error if it is a different AFU by now.
    pub fn confirm(self) -> Result<Transaction<'s, T, Running<J>>, HostError> {
        self.open.session.check_identity()?;
        Ok(self.to(|Started { begin, job }| Running { begin, job }))
    }
}

impl<'s, T: Transport, J> Transaction<'s, T, Running<J>> {
    /// Asks the AFU to abort the job; its status then says so.
    ///
    /// # Errors
    /// Returns [`HostError::Outside`], which cannot happen with a workspace.
    pub fn abort(&mut self) -> Result<(), HostError> {
        self.open.abort()
    }

    /// Lets time pass without reading the status.
    ///
    /// # Errors
    /// Returns the device's protocol errors since then.
    pub fn idle(&mut self, cycles: u64) -> Result<(), HostError> {
        Ok(self.transport_mut().advance(cycles)?)
    }

    /// True if the status has arrived.
    pub fn is_done(&self) -> bool {
        self.open.session.has_ended(&self.state.begin)
    }

    /// Step 5: waits for the status.
    ///
    /// # Errors
    /// Returns [`HostError::NoStatus`] if the AFU takes, or is silent for, longer than a correct one could
    /// ([`patience`](crate::patience)), or takes longer than [`Session::max_cycles`]. Returns the device's protocol
    /// errors.
    pub fn wait(self) -> Result<Transaction<'s, T, Done<J>>, HostError> {
        self.wait_with(|_| {})
    }

    /// As [`wait`](Self::wait), but calls `progress` now and then with the traffic over the link so far.
    ///
    /// # Errors
    /// Returns the errors of `wait`.
    pub(crate) fn wait_with(
        mut self,
        mut progress: impl FnMut(Traffic),
    ) -> Result<Transaction<'s, T, Done<J>>, HostError> {
        let Open { session, task, .. } = &mut self.open;
        let status = session.wait_for_status(&self.state.begin, task, &mut progress)?;
        Ok(self.to(|Running { begin, job }| Done { begin, status, job }))
    }
}

impl<T: Transport, J> Transaction<'_, T, Done<J>> {
    /// The outcome as it is in memory, even if the job ended with an error: the AFU's counts, each destination line,
    /// and the cycle in which it was written.
    pub fn outcome(&self) -> Outcome {
        self.open.outcome(&self.state.begin, &self.state.status)
    }
}

impl<'s, T: Transport> Transaction<'s, T, Done> {
    /// Step 6: takes the results from the destination.
    ///
    /// # Errors
    /// Returns [`HostError::Job`] if the AFU ended the job with an error. Returns [`HostError::Unwritten`] or
    /// [`HostError::Hit`] if memory does not hold what the status promises.
    pub fn retrieve(mut self) -> Result<Transaction<'s, T, Retrieved>, HostError> {
        let outcome = self.outcome();
        let results = self.open.results(&self.state.job, &outcome)?;
        Ok(self.to(|_| Retrieved { results }))
    }

    /// Step 2 again, for another job: replaces the pairs of the last one, while SPL and the AFU stay enabled.
    ///
    /// # Errors
    /// Returns an error if there are more pairs than the buffers hold.
    pub fn send_next(mut self, pairs: &[PairRecord]) -> Result<Transaction<'s, T, Loaded>, HostError> {
        let job = self.open.load_pairs(pairs)?;
        Ok(self.to(|_| Loaded { job }))
    }
}

impl<T: Transport, R> Transaction<'_, T, Retrieved<R>> {
    /// The results.
    pub fn results(&self) -> &R {
        &self.state.results
    }
}

impl<'s, T: Transport> Transaction<'s, T, Retrieved> {
    /// Step 2 again, for another job: replaces the pairs of the last one, while SPL and the AFU stay enabled.
    ///
    /// # Errors
    /// Returns an error if there are more pairs than the buffers hold.
    pub fn send_next(mut self, pairs: &[PairRecord]) -> Result<Transaction<'s, T, Loaded>, HostError> {
        let job = self.open.load_pairs(pairs)?;
        Ok(self.to(|_| Loaded { job }))
    }

    /// Step 7: stops SPL and frees the workspace.
    ///
    /// # Errors
    /// Returns the device's protocol errors since then.
    pub fn end(mut self) -> Result<JobResults, HostError> {
        let report = self.open.end()?;
        Ok(JobResults { report, ..self.state.results })
    }
}
