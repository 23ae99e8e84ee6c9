//! One set of collisions, timed in every way.

use super::{Recording, Timing};
use crate::kernel::Engine;
use crate::kernel::batch::{Batch, Level};
use crate::ode::dcollide::Room;
use crate::ode::{Error, Ode, SpherePair};
use crate::query::{ContactRecord, Fields, PairRecord};
use std::hint::black_box;

/// The time of the same collisions, all together, in nanoseconds. All times are measured on this machine with one
/// thread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Number of collisions.
    pub collisions: usize,
    /// ODE by the paper's rule: the sum of the averages, the clock's share included.
    pub rule_ns: f64,
    /// ODE, called for one collision after the other, with the loop timed as a whole. Its spheres are in memory in the
    /// order of the collisions, as `f64`.
    pub calls: Timing,
    /// The f32 kernel, from a batch in its own layout into another.
    pub kernel: Timing,
    /// The f32 kernel from records to records, including rearranging.
    pub records: Timing,
    /// The instruction set of the two kernels.
    pub level: &'static str,
}

impl Recording {
    /// Times the first `count` collisions, or all if there are fewer, in `passes` passes.
    ///
    /// # Errors
    /// Returns an error if ODE runs without its own collider, or has no memory.
    pub fn figures(&self, ode: &Ode, count: usize, passes: usize) -> Result<Figures, Error> {
        let collisions = self.first(count);
        let mut pairs = Vec::with_capacity(collisions.len());
        for collision in collisions {
            let mut pair = SpherePair::new(ode)?;
            pair.set(collision.spheres[0], collision.spheres[1])?;
            pairs.push(pair);
        }
        let calls = Timing::of(passes, || calls(&pairs));
        drop(pairs);

        let records = self.pairs(count);
        let level = Level::best();
        let (kernel, records) = (kernel(level, &records, passes), whole(level, &records, passes));
        let rule_ns = self.total_ns(count);
        Ok(Figures { collisions: collisions.len(), rule_ns, calls, kernel, records, level: level.name() })
    }
}

fn calls(pairs: &[SpherePair]) {
    let mut room = Room::new();
    for pair in pairs {
        let [first, second] = pair.geoms();
        // SAFETY: both live as long as the pair.
        black_box(unsafe { room.ask(first, second) });
    }
    black_box(&room);
}

fn kernel(level: Level, records: &[PairRecord], passes: usize) -> Timing {
    let pairs = Batch::from_pairs(records);
    let mut contacts = Batch::zeros(pairs.len());
    Timing::of(passes, || level.run(black_box(&pairs), black_box(&mut contacts), Fields::ALL))
}

fn whole(mut level: Level, records: &[PairRecord], passes: usize) -> Timing {
    Timing::of(passes, || {
        let contacts: Result<Vec<ContactRecord>, _> = level.contacts(black_box(records));
        let _ = black_box(contacts);
    })
}
