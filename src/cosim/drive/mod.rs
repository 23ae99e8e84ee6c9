//! Runs jobs on an AFU over a simulated link, and checks the protocol between them in every cycle.
//!
//! All outputs of the AFU are registered, so none depends on an input of the same cycle. One evaluation per edge is
//! enough: read the outputs, let the link decide, set the inputs, clock.

mod error;
mod job;
mod monitor;
mod ports;

pub use error::{DriveError, Waiting};
pub use job::Job;
pub use monitor::ProtocolError;

use super::instance::{Clock, Instance};
use crate::config::Results;
use crate::link::{Link, Traffic};
use crate::outcome::Outcome;
use crate::patience;
use crate::record::Capability;
use job::Running;
use monitor::Monitor;
use ports::Ports;

/// Cycles for which reset is held.
const RESET_CYCLES: u64 = 4;

/// A host with one AFU at the other end of a link.
#[derive(Debug)]
pub struct Driver<'a> {
    clock: Clock<'a>,
    ports: Ports<'a>,
    link: Link,
    monitor: Monitor,
    /// Cycles since the driver was made.
    cycle: u64,
    /// The epoch of the last job. The next job has another one.
    epoch: u8,
    running: Option<Running>,
}

impl<'a> Driver<'a> {
    /// Takes the ports of `afu`, a module with the `line` shell's ports, resets it, and waits until a job that is
    /// started begins at once.
    ///
    /// # Errors
    /// Returns an error if a port is missing, or if the module stops the simulation.
    pub fn new(afu: &'a Instance, link: Link) -> Result<Self, DriveError> {
        let (clock, ports) = (afu.clock("clk")?, Ports::new(afu)?);
        let monitor = Monitor::new(ports.tag_bits);
        let mut driver = Self { clock, ports, link, monitor, cycle: 0, epoch: 0, running: None };
        driver.reset()?;
        let cycles = driver.capability().cycles_after_reset();
        driver.idle(cycles)?;
        Ok(driver)
    }

    /// Resets the AFU at any time. The link goes on, and still answers earlier requests.
    ///
    /// # Errors
    /// Returns an error if the module stops the simulation.
    pub fn reset(&mut self) -> Result<(), DriveError> {
        self.running = None;
        self.monitor.forget();
        self.ports.quiet();
        self.ports.reset(true);
        self.idle(RESET_CYCLES)?;
        self.ports.reset(false);
        Ok(())
    }

    /// Cycles in which the AFU has no job, and the link answers earlier ones.
    fn idle(&mut self, cycles: u64) -> Result<(), DriveError> {
        for _ in 0..cycles {
            let replies = self.link.cycle(&Default::default());
            self.monitor.answered(&replies);
            self.ports.reply(&replies);
            self.clock.tick(1)?;
            self.cycle += 1;
        }
        Ok(())
    }

    /// The capability word of the AFU.
    pub fn capability(&self) -> Capability {
        Capability::from_bits(self.ports.capability())
    }

    /// The link, with its memory.
    pub fn link(&self) -> &Link {
        &self.link
    }

    /// The link, with its memory, to plant faults.
    pub fn link_mut(&mut self) -> &mut Link {
        &mut self.link
    }

    /// Cycles since the driver was made.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// Runs a job to its end.
    ///
    /// # Errors
    /// Returns an error if the AFU breaks the protocol, does not respond, or stops the simulation. A job that ends with
    /// an error code is an [`Outcome`].
    pub fn run(&mut self, job: &Job) -> Result<Outcome, DriveError> {
        self.start(job)?;
        while !self.step()? {}
        self.finish()
    }

    /// Puts a job's source into memory and starts the AFU on it.
    ///
    /// # Errors
    /// Returns an error if the AFU is busy or is not the expected one. Also returns the errors of [`Driver::step`].
    pub fn start(&mut self, job: &Job) -> Result<(), DriveError> {
        let afu = self.capability();
        let Capability { scpus: found, results, .. } = afu;
        if let Some(expected) = job.scpus.filter(|&expected| expected != found) {
            return Err(DriveError::Scpus { expected, found });
        }
        let expected = if job.hits_per_line.is_some() { Results::Hits } else { Results::All };
        if expected != results {
            return Err(DriveError::OtherResults { expected, found: results });
        }
        if self.ports.is_busy() {
            return Err(DriveError::Busy);
        }
        job.check()?;
        job.place(&mut self.link.memory);
        self.epoch = (self.epoch + 1) % 16;
        self.ports.start(job, self.epoch);
        self.monitor.begin(self.epoch);
        let patience = patience::line(&afu, self.link.model(), &job.work());
        self.running = Some(Running::new(job, patience, self.cycle, self.link.traffic()));
        self.cycle_once()?;
        self.ports.started();
        Ok(())
    }

    /// Advances one cycle. Returns true if the job is done.
    ///
    /// # Errors
    /// Returns an error if the AFU breaks the protocol, takes longer than a correct one would ([`patience`]), or stops
    /// the simulation.
    pub fn step(&mut self) -> Result<bool, DriveError> {
        if self.ports.is_done() {
            let (error, contacts) = (self.ports.error(), self.ports.counters().contacts);
            let end = self.running.as_ref().map_or(0, |running| running.end(contacts));
            self.monitor.at_done(self.cycle, error, self.ports.is_busy(), &self.link.memory, end)?;
            return Ok(true);
        }
        self.cycle_once()?;
        let Some(running) = &self.running else { return Ok(true) };
        if running.is_overdue(self.cycle) {
            return Err(self.timed_out(self.cycle - running.started));
        }
        Ok(false)
    }

    /// The outcome of a job that is done.
    ///
    /// # Errors
    /// Returns an error if no job was started, or if it is not done.
    pub fn finish(&mut self) -> Result<Outcome, DriveError> {
        if !self.ports.is_done() {
            return Err(DriveError::NotDone);
        }
        let running = self.running.take().ok_or(DriveError::NotDone)?;
        self.ports.abort(false);
        Ok(running.outcome(self.cycle, &self.ports, &self.link))
    }

    /// Asks the AFU to abort, from the next cycle until its job is done.
    pub fn abort(&mut self) {
        self.ports.abort(true);
    }

    fn cycle_once(&mut self) -> Result<(), DriveError> {
        let requests = self.ports.requests();
        let replies = self.link.cycle(&requests);
        self.monitor.check(self.cycle, &requests, &replies, self.ports.is_busy(), &self.link.memory)?;
        self.ports.reply(&replies);
        if let Some(running) = &mut self.running {
            running.note(self.cycle, &requests, &replies);
        }
        self.clock.tick(1)?;
        self.cycle += 1;
        Ok(())
    }

    fn timed_out(&self, cycles: u64) -> DriveError {
        let begun = self.running.as_ref().map_or(Traffic::default(), |running| running.traffic);
        let traffic = self.link.traffic();
        let requests = self.ports.requests();
        let reads = (traffic.reads - begun.reads, traffic.read_responses - begun.read_responses);
        let writes = (traffic.writes - begun.writes, traffic.write_responses - begun.write_responses);
        let waiting = match self.monitor.oldest() {
            Some((is_read, tag, since)) => Waiting::Response { is_read, tag, cycles: self.cycle - since },
            None if requests.read.is_some() || requests.write.is_some() => Waiting::Ready,
            None => Waiting::Afu,
        };
        DriveError::TimedOut { cycles, waiting, reads, writes }
    }
}
