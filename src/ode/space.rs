//! A space that finds the contacts of a world by itself: broad phase and collider in one.

use super::by_engine::checked;
use super::{Error, Sphere, Touch, World};
use crate::kernel::Engine;
use crate::query::ContactRecord;
use crate::spheres::{self, Counts, Finder, Search, Spheres, hilbert_order, reorder};

/// What finds spheres, in the place of ODE's space and of its collider.
///
/// It takes the centres and radii of a world's spheres, each number rounded to binary32 once, and returns every two
/// that touch.
pub struct SearchSpace<'a> {
    way: Way<'a>,
    /// Steps after which the spheres are put in order again.
    sort_every: u32,
    /// Steps since they were.
    since: u32,
    order: Vec<u32>,
    counts: Counts,
}

enum Way<'a> {
    Search(Search, Box<dyn Engine + 'a>),
    Finder(Box<dyn Finder + 'a>),
}

impl<'a> SearchSpace<'a> {
    /// A space whose `engine` decides in the arithmetic of `search`. After each `sort_every` calls, at least one, it
    /// puts the spheres in the order of a Hilbert curve again. That changes the time and not the contacts.
    pub fn new(search: Search, engine: impl Engine + 'a, sort_every: u32) -> Self {
        Self::by(Way::Search(search, Box::new(engine)), sort_every)
    }

    /// A space of any finder, such as an AFU behind its host. It gets the spheres in the order of a Hilbert curve. Of
    /// two that touch, the first is the one that comes first in this order.
    pub fn of(finder: impl Finder + 'a, sort_every: u32) -> Self {
        Self::by(Way::Finder(Box::new(finder)), sort_every)
    }

    fn by(way: Way<'a>, sort_every: u32) -> Self {
        Self { way, sort_every: sort_every.max(1), since: 0, order: Vec::new(), counts: Counts::default() }
    }

    /// The comparisons of a search's last call of [`World::contacts_in`]; none of another finder's.
    pub const fn counts(&self) -> Counts {
        self.counts
    }

    /// The contacts of the world's spheres.
    fn contacts(&mut self, world: &World) -> Result<Vec<([Sphere; 2], ContactRecord)>, Error> {
        let records: Vec<_> = world.spheres().map(|sphere| spheres::Sphere::new(world.rounded(sphere))).collect();
        if self.order.len() != records.len() || self.since >= self.sort_every {
            (self.order, self.since) = (hilbert_order(&records), 0);
        }
        self.since += 1;
        let mut hits = match &mut self.way {
            Way::Search(search, engine) => {
                let found = search.find_in_order(&mut **engine, &records, &self.order).map_err(Error::Engine)?;
                self.counts = found.counts;
                found.hits
            }
            Way::Finder(finder) => {
                let sets = Spheres { first: reorder(&records, &self.order), second: None };
                let mut hits = finder.find(&sets).map_err(Error::Engine)?;
                for hit in &mut hits {
                    for place in &mut hit.spheres {
                        *place = *self.order.get(*place as usize).ok_or(Error::Engine("no such sphere".into()))?;
                    }
                }
                hits
            }
        };
        hits.sort_unstable_by_key(|hit| (hit.spheres.iter().min().copied(), hit.spheres.iter().max().copied()));
        Ok(hits.into_iter().map(|hit| (hit.spheres.map(|n| Sphere(n as usize)), hit.contact)).collect())
    }
}

impl std::fmt::Debug for SearchSpace<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let search = match &self.way {
            Way::Search(search, _) => Some(search),
            Way::Finder(_) => None,
        };
        f.debug_struct("SearchSpace").field("search", &search).field("sort_every", &self.sort_every).finish()
    }
}

impl World {
    /// Every present contact, found and computed by `space`, sorted by the sphere that was added earlier and then by
    /// the other one. With a search, the earlier one is the first. Unlike [`World::candidates`], it does not skip two
    /// spheres that sleep.
    ///
    /// # Errors
    /// Returns an error if a sphere is lost (see [`World::step`]), or if the engine fails or gives an invalid answer.
    pub fn contacts_in(&self, space: &mut SearchSpace<'_>) -> Result<Vec<Touch>, Error> {
        self.all_in_reach()?;
        let mut touches = Vec::new();
        for ([first, second], answer) in space.contacts(self)? {
            let contact = checked(first, second, answer)?;
            touches.extend(contact.map(|contact| Touch { first, second, contact }));
        }
        Ok(touches)
    }
}
