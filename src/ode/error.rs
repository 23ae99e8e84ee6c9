//! Errors of ODE, its worlds, and engines in its collider's place.

use super::Collider;
use crate::count::counted;
use crate::kernel::EngineError;
use crate::query::Flow;

/// Why ODE could not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The library did not start.
    #[error("ODE did not start: it could not allocate its memory for this thread")]
    Start,
    /// The library that was found when the program began is not the one it was built with.
    #[error("expected a libode of double precision, found one of single precision")]
    SinglePrecision,
    /// ODE has one collider for all spheres of a process, and it is the other one.
    #[error(
        "ODE runs with {running} on this thread, but {wanted} was requested; first drop every `Ode` and its objects"
    )]
    OtherCollider {
        /// The collider that is in use.
        running: Collider,
        /// The collider that is needed.
        wanted: Collider,
    },
    /// A number that ODE would answer with an assertion, or not at all.
    #[error("{what} is {value}: expected {least} to {most}")]
    Number {
        /// The quantity.
        what: &'static str,
        /// Itself.
        value: f64,
        /// The least allowed.
        least: f64,
        /// The largest allowed.
        most: f64,
    },
    /// A sphere left the space that ODE's broad phase can divide, or has no place at all.
    #[error("sphere {sphere} is lost: its position became ({}, {}, {})", .position[0], .position[1], .position[2])]
    Lost {
        /// The number of the sphere in its world.
        sphere: usize,
        /// The position of the sphere.
        position: [f64; 3],
    },
    /// A contact of a sphere with itself.
    #[error("sphere {0} cannot touch itself")]
    Itself(usize),
    /// A contact with a number that is beyond any sphere, or none.
    #[error(
        "the contact of spheres {first} and {second} has a number beyond all limits, which would end the simulation"
    )]
    Contact {
        /// Number of the first sphere.
        first: usize,
        /// Number of the second.
        second: usize,
    },
    /// ODE's solver ran out of memory.
    #[error("ODE could not allocate the memory for a step")]
    Memory,
    /// The engine failed.
    #[error("the engine that replaces ODE's collider: {0}")]
    Engine(#[source] EngineError),
    /// The engine did not answer every pair, or more than every pair.
    #[error("expected {} from the engine, found {contacts}", counted(*pairs as u64, "contact"))]
    Count {
        /// Pairs it was given.
        pairs: usize,
        /// Contacts it gave.
        contacts: usize,
    },
    /// The engine's flags are neither contact nor no contact.
    #[error("the engine returned flags {flags:#x} for spheres {first} and {second}: neither a contact nor no contact")]
    Flags {
        /// Number of the first sphere.
        first: usize,
        /// Number of the second.
        second: usize,
        /// The flags word.
        flags: u32,
    },
    /// A simulation without enough collisions of a kind.
    #[error("expected {wanted} {flow} collisions, found {found} in {steps} steps")]
    TooFew {
        /// The kind.
        flow: Flow,
        /// Number of collisions found.
        found: usize,
        /// Number of collisions requested.
        wanted: usize,
        /// The steps simulated.
        steps: usize,
    },
    /// A kind of collision that no simulation has.
    #[error("ODE has no {0} collisions: use fake, real or grazing")]
    Flow(Flow),
}
