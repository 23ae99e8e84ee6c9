//! Runs a job on a simulated AFU and gets its results: through a host if the shell has registers, otherwise at the line
//! port.

use super::session::PROGRESS_CYCLES;
use super::{Expected, HostError, Session, Transport, Workspace};
use crate::config::{Config, Results, Shell};
use crate::cosim::drive::DriveError;
use crate::cosim::spl2::Machine;
use crate::cosim::{Driver, Instance, Job, Outcome};
use crate::link::spl2::{Spl2, Spl2Model};
use crate::link::{Link, Traffic};
use crate::query::PairRecord;
use crate::record::pack;

/// A job to be run.
pub(crate) struct Run<'a> {
    pub(crate) config: &'a Config,
    pub(crate) expected: Expected,
    pub(crate) pairs: &'a [PairRecord],
    pub(crate) seed: u64,
    pub(crate) progress: &'a mut dyn FnMut(Traffic),
}

impl Run<'_> {
    /// Runs the job on `afu` over `link`.
    ///
    /// # Errors
    /// Returns the error of the host or, if the shell has no registers, of the driver.
    pub(crate) fn on<E>(self, afu: &Instance, link: Link) -> Result<Outcome, E>
    where
        E: From<HostError> + From<DriveError>,
    {
        Ok(match self.config.shell {
            Shell::Spl2 => {
                let spl = Spl2::new(Spl2Model::default(), link, self.seed);
                self.through_a_host(Machine::new(afu, spl).map_err(HostError::from)?)?
            }
            Shell::Line | Shell::Axi => self.at_the_line_port(Driver::new(afu, link)?)?,
        })
    }

    fn through_a_host(self, device: impl Transport) -> Result<Outcome, HostError> {
        let workspace = Workspace::for_pairs(self.expected.layout, self.pairs.len() as u64, self.seed)?;
        let mut session = Session::new(device, workspace, self.expected);
        let running = session.transaction().send(self.pairs)?.start()?.confirm()?;
        Ok(running.wait_with(self.progress)?.outcome())
    }

    fn at_the_line_port(self, mut driver: Driver) -> Result<Outcome, DriveError> {
        let layout = &self.expected.layout;
        let source = pack(layout, self.pairs);
        let mut job = Job::new(&source, self.pairs.len() as u32, layout.destination_lines(self.pairs.len() as u64));
        job.scpus = Some(self.config.scpus);
        let only_hits = self.config.results == Results::Hits;
        job.hits_per_line = only_hits.then(|| layout.contacts_per_line());
        driver.start(&job)?;
        while !driver.step()? {
            if driver.cycle().is_multiple_of(PROGRESS_CYCLES) {
                (self.progress)(driver.link().traffic());
            }
        }
        driver.finish()
    }
}
