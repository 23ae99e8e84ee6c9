//! Why a configuration is refused.

use super::{LONGEST_PREFIX, RecordFormat, SearchError, Shell};
use crate::query::Query;

/// Why a configuration is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Outside [`super::SCPUS`].
    #[error("{0} SCPUs: expected 1 to 64")]
    Scpus(u32),
    /// Outside [`super::INTERVALS`].
    #[error("interval {0}: expected 1 to 64 cycles")]
    Interval(u32),
    /// Not a power of two within [`super::OUTSTANDING`].
    #[error("{0} requests in flight: expected 16, 32, 64, 128 or 256")]
    Outstanding(u32),
    /// More than SPL2 takes.
    #[error("{0} requests in flight: expected at most 64 below shell spl2; use shell axi or line for more")]
    OutstandingOverSpl2(u32),
    /// A clock out of range.
    #[error("clock {0} MHz: expected 1 to 2000 MHz")]
    Clock(f64),
    /// A prefix that cannot begin a Verilog name.
    #[error("prefix `{0}`: expected 1 to {LONGEST_PREFIX} letters, digits and `_`, and no digit at the start")]
    Prefix(String),
    /// A record of one bit cannot mark a pair as unsettled.
    #[error("profile exact with contact hit alone: one bit cannot mark a pair as unsettled; ask for the depth too")]
    ExactHit,
    /// If records come back only for contacts, unsettled pairs would be lost.
    #[error(
        "profile exact with results hits: unsettled pairs would not come back for the host to resolve; use results all"
    )]
    ExactHits,
    /// An option that exists for sphere-sphere only.
    #[error("query {0} with {1}: {1} is for sphere-sphere only; leave it out")]
    SpheresAlone(Query, &'static str),
    /// A radius that is negative, infinite or a NaN.
    #[error("radius {0}: expected a finite length of at least 0")]
    Radius(f32),
    /// A radius that overflows in the records' format.
    #[error("radius {0}: infinite in {1} records; use a smaller radius or record f32")]
    RecordRadius(f32, RecordFormat),
    /// The profile `exact` would be exact for rounded pairs only.
    #[error(
        "profile exact with record {0}: results would be exact for the rounded pairs only, not for yours; use record f32"
    )]
    ExactRecord(RecordFormat),
    /// Not one of [`super::BUSES`].
    #[error("bus of {0} bits: expected 128, 256 or 512")]
    Bus(u32),
    /// Deciders where they make no sense.
    #[error("decide {0} with {1}: {2}")]
    Decide(u32, &'static str, &'static str),
    /// Not one of [`super::DECIDE`].
    #[error("decide {0}: expected 0, 1, 2 or 4 SCPUs that decide")]
    DecideRange(u32),
    /// Spheres come in, and the search is not possible.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// A width for a bus that the shell does not have.
    #[error("bus of {0} bits below shell {1}: only shell axi has a bus of another width; leave it out")]
    NoBus(u32, Shell),
}
