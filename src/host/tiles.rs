//! Sets that are larger than the AFU's table: one transaction, whose jobs are tiles of them.

use super::error::HostError;
use super::session::Session;
use super::transport::Transport;
use crate::spheres::{Hit, Spheres, join_tiles, tiles};

/// What was found in all tiles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TiledResults {
    /// The spheres that touch and their contacts, in the order of one search of the whole sets.
    pub hits: Vec<Hit>,
    /// The number of pairs of spheres whose boxes meet, in all tiles.
    pub candidates: u64,
    /// The number of jobs.
    pub jobs: u64,
}

impl<T: Transport> Session<T> {
    /// The spheres that touch, of sets of any size, from one transaction with an AFU that takes spheres. Every two
    /// tiles of at most `size` spheres (a multiple of 16, at most the AFU's table) are a job. Tiles of the first set
    /// are sent once: they stay in the table while those of the second pass by.
    ///
    /// The workspace needs room for two tiles, and for the contacts of any job.
    ///
    /// # Errors
    /// Returns an error if the size is none that a tile can have, and the errors of the steps of
    /// [`Transaction`](super::Transaction).
    pub fn find_in_tiles(&mut self, sets: &Spheres, size: u32) -> Result<TiledResults, HostError> {
        let mut rest = tiles(sets, size, self.table()?)?;
        let mut joined = TiledResults::default();
        let Some(mut tile) = rest.next() else { return Ok(joined) };
        let mut loaded = self.transaction().send_spheres(&tile.sets)?;
        loop {
            let found = loaded.start()?.confirm()?.wait()?.retrieve()?;
            let results = found.results();
            let hits = results.hits.iter().zip(&results.contacts);
            joined.hits.extend(tile.translate(hits.map(|(&spheres, &contact)| Hit { spheres, contact })));
            joined.candidates += u64::from(results.candidates);
            joined.jobs += 1;
            let Some(next) = rest.next() else {
                found.end()?;
                break;
            };
            loaded = match &next.sets.second {
                Some(others) if next.from[0] == tile.from[0] => found.send_against(others)?,
                _ => found.send_next_spheres(&next.sets)?,
            };
            tile = next;
        }
        join_tiles(&mut joined.hits);
        Ok(joined)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Config, Input, Results, Search as SearchConfig, Shell};
    use crate::host::{Expected, Software, Workspace};
    use crate::link::LinkModel;
    use crate::spheres::{Search, SphereSet};

    /// One set and two that are larger than the table, through the host and the AFU in software.
    #[test]
    fn sets_larger_than_the_table_are_found_in_tiles() {
        let config = Config {
            input: Input::Spheres,
            results: Results::Hits,
            contact: "hit,depth".parse().expect("fields"),
            shell: Shell::Axi,
            search: SearchConfig { table: 512, ..SearchConfig::default() },
            ..Config::default()
        };
        let search = Search::new(config.profile.arithmetic(), config.search.box_bits).expect("a search");
        for (sets, jobs) in [(SphereSet::Gas(1300, 300).spheres(1), 6), (SphereSet::Probes(700, 1100).spheres(1), 6)] {
            let whole =
                search.find(&mut config.reference(), &sets.first, sets.second.as_deref()).expect("the reference");
            let expected = Expected::new(&config).expect("an AFU");
            let workspace = Workspace::for_spheres(expected.layout, [512, 512], 10_000).expect("a workspace");
            let device = Software::new(&config, LinkModel::ideal()).expect("a device");
            let mut session = Session::new(device, workspace, expected);
            let found = session.find_in_tiles(&sets, 512).expect("found");
            let as_stored = |hit: &Hit| (hit.spheres, hit.contact.depth());
            assert_eq!(
                found.hits.iter().map(as_stored).collect::<Vec<_>>(),
                whole.hits.iter().map(as_stored).collect::<Vec<_>>()
            );
            assert_eq!((found.candidates, found.jobs), (whole.counts.candidates, jobs));
            let error = session.find_in_tiles(&sets, 1024).expect_err("no such tile").to_string();
            assert!(error.contains("from 16 to 512"), "{error}");
        }
    }
}
