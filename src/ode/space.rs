//! A space that finds the contacts of a world by itself: broad phase and collider in one.

use super::by_engine::checked;
use super::{Error, Sphere, Touch, World};
use crate::kernel::Engine;
use crate::query::ContactRecord;
use crate::spheres::{self, Counts, Search, hilbert_order};

/// A [`Search`] in the place of ODE's space, with an engine in the place of ODE's collider.
///
/// It takes the centres and radii of a world's spheres, each number rounded to binary32 once, and returns every two
/// that touch. ODE's own space is not used, and neither is its collider.
pub struct SearchSpace {
    search: Search,
    engine: Box<dyn Engine>,
    /// Steps after which the spheres are put in order again.
    sort_every: u32,
    /// Steps since they were.
    since: u32,
    order: Vec<u32>,
    counts: Counts,
}

impl SearchSpace {
    /// A space whose `engine` decides in the arithmetic of `search`. After each `sort_every` calls, at least one, it
    /// puts the spheres in the order of a Hilbert curve again. That changes the time and not the contacts.
    pub fn new(search: Search, engine: impl Engine + 'static, sort_every: u32) -> Self {
        let (engine, order, counts) = (Box::new(engine), Vec::new(), Counts::default());
        Self { search, engine, sort_every: sort_every.max(1), since: 0, order, counts }
    }

    /// The comparisons of the last call of [`World::contacts_in`].
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
        let found = self.search.find_in_order(&mut *self.engine, &records, &self.order).map_err(Error::Engine)?;
        self.counts = found.counts;
        Ok(found.hits.into_iter().map(|hit| (hit.spheres.map(|n| Sphere(n as usize)), hit.contact)).collect())
    }
}

impl std::fmt::Debug for SearchSpace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SearchSpace").field("search", &self.search).field("sort_every", &self.sort_every).finish()
    }
}

impl World {
    /// Every present contact, found and computed by `space`, sorted by the first and then the second sphere, of which
    /// the first was added earlier. Unlike [`World::candidates`], it does not skip two spheres that sleep.
    ///
    /// # Errors
    /// Returns an error if a sphere is lost (see [`World::step`]), or if the engine fails or gives an invalid answer.
    pub fn contacts_in(&self, space: &mut SearchSpace) -> Result<Vec<Touch>, Error> {
        self.all_in_reach()?;
        let mut touches = Vec::new();
        for ([first, second], answer) in space.contacts(self)? {
            let contact = checked(first, second, answer)?;
            touches.extend(contact.map(|contact| Touch { first, second, contact }));
        }
        Ok(touches)
    }
}
