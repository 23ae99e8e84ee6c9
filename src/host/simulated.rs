//! Runs a job on a simulated AFU and gets its results: through a host if the shell has registers, otherwise at the line
//! port.

use super::session::PROGRESS_CYCLES;
use super::{Expected, HostError, Session, Transport, Workspace};
use crate::config::{Config, Results, Shell};
use crate::cosim::drive::DriveError;
use crate::cosim::{Driver, Instance, Job, Outcome, axi, spl2};
use crate::link::axi::Handshake;
use crate::link::spl2::{Spl2, Spl2Model};
use crate::link::{Link, LinkError, LinkModel, Traffic};
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
    /// Returns an error if the link's model has an invalid value. Returns the error of the host or, if the shell has no
    /// registers, of the driver.
    pub(crate) fn on<E>(self, afu: &Instance, link: LinkModel) -> Result<Outcome, E>
    where
        E: From<HostError> + From<DriveError> + From<LinkError>,
    {
        Ok(match self.config.shell {
            Shell::Spl2 => {
                let spl = Spl2::new(Spl2Model::default(), Link::new(link, self.seed)?, self.seed);
                let device = spl2::Machine::new(afu, spl).map_err(HostError::from)?;
                let workspace = Workspace::for_pairs(self.expected.layout, self.pairs.len() as u64, self.seed)?;
                self.through_a_host(device, workspace)?
            }
            Shell::Axi => {
                let device = axi::Machine::new(afu, link, Handshake::Free, self.seed).map_err(HostError::from)?;
                let workspace = Workspace::contiguous(self.expected.layout, self.pairs.len() as u64)?;
                self.through_a_host(device, workspace)?
            }
            Shell::Line => {
                let link = Link::new(link, self.seed)?;
                self.at_the_line_port(Driver::new(afu, link)?)?
            }
        })
    }

    fn through_a_host(self, device: impl Transport, workspace: Workspace) -> Result<Outcome, HostError> {
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
