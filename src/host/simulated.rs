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
use crate::patience::SearchWork;
use crate::query::PairRecord;
use crate::record::{pack, pack_spheres};
use crate::spheres::Spheres;

/// What a job is given.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Given<'a> {
    /// Pairs.
    Pairs(&'a [PairRecord]),
    /// Spheres, with room for this number of contacts, whose search takes at most this.
    Spheres { sets: &'a Spheres, contacts: u64, search: SearchWork },
}

/// A job to be run.
pub(crate) struct Run<'a> {
    pub(crate) config: &'a Config,
    pub(crate) expected: Expected,
    pub(crate) given: Given<'a>,
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
        let layout = self.expected.layout;
        let numbers = |sets: &Spheres| [sets.first.len(), sets.second.as_ref().map_or(0, Vec::len)].map(|n| n as u64);
        Ok(match self.config.shell {
            Shell::Spl2 => {
                let spl = Spl2::new(Spl2Model::default(), Link::new(link, self.seed)?, self.seed);
                let device = spl2::Machine::new(afu, spl).map_err(HostError::from)?;
                let workspace = match self.given {
                    Given::Pairs(pairs) => Workspace::for_pairs(layout, pairs.len() as u64, self.seed)?,
                    Given::Spheres { sets, contacts, .. } => {
                        Workspace::for_spheres_below_spl2(layout, numbers(sets), contacts, self.seed)?
                    }
                };
                self.through_a_host(device, workspace)?
            }
            Shell::Axi => {
                let device = axi::Machine::new(afu, link, Handshake::Free, self.seed).map_err(HostError::from)?;
                let workspace = match self.given {
                    Given::Pairs(pairs) => Workspace::contiguous(layout, pairs.len() as u64)?,
                    Given::Spheres { sets, contacts, .. } => Workspace::for_spheres(layout, numbers(sets), contacts)?,
                };
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
        let transaction = session.transaction();
        Ok(match self.given {
            Given::Pairs(pairs) => transaction.send(pairs)?.start()?.confirm()?.wait_with(self.progress)?.outcome(),
            Given::Spheres { sets, search, .. } => {
                let loaded = transaction.send_spheres_within(sets, search)?;
                loaded.start()?.confirm()?.wait_with(self.progress)?.outcome()
            }
        })
    }

    fn at_the_line_port(self, mut driver: Driver) -> Result<Outcome, DriveError> {
        let layout = &self.expected.layout;
        let source;
        let mut job;
        match self.given {
            Given::Pairs(pairs) => {
                source = pack(layout, pairs);
                job = Job::new(&source, pairs.len() as u32, layout.destination_lines(pairs.len() as u64));
                job.scpus = Some(self.config.scpus);
                let only_hits = self.config.results == Results::Hits;
                job.hits_per_line = only_hits.then(|| layout.contacts_per_line());
            }
            Given::Spheres { sets, contacts, search } => {
                let others = sets.second.as_deref();
                source = [pack_spheres(&sets.first), pack_spheres(others.unwrap_or_default())].concat();
                job = Job::new(&source, sets.first.len() as u32, layout.destination_lines(contacts));
                job.others = others.map_or(0, |others| others.len() as u32);
                job.mode = others.is_some().into();
                job.hits_per_line = Some(layout.contacts_per_line());
                job.search = search;
            }
        }
        driver.start(&job)?;
        while !driver.step()? {
            if driver.cycle().is_multiple_of(PROGRESS_CYCLES) {
                (self.progress)(driver.link().traffic());
            }
        }
        driver.finish()
    }
}
