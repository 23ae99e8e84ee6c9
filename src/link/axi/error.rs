//! Violations of AXI4 and AXI4-Lite.

use crate::link::Violation;

/// A rule that the AFU, or the memory behind it, broke.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AxiError {
    /// A VALID that fell, or what belongs to it changed, before its READY.
    #[error("channel {0} changed before it was ready")]
    Unstable(&'static str),
    /// A VALID in reset.
    #[error("channel {0} is valid in reset")]
    InReset(&'static str),
    /// A burst that is not allowed here.
    #[error("a burst on channel {channel} at {address:#x} with {beats} beats: {why}")]
    Burst {
        /// AW or AR.
        channel: &'static str,
        /// The byte address.
        address: u64,
        /// The beats.
        beats: u64,
        /// The rule.
        why: &'static str,
    },
    /// A beat of a write that is not allowed here.
    #[error("beat {beat} of a write burst: {why}")]
    Beat {
        /// The beat's number in its burst.
        beat: u64,
        /// The rule.
        why: &'static str,
    },
    /// The AFU refused a response, although it promises that it never does.
    #[error("{0} is low")]
    Refused(&'static str),
    /// A response that nothing waits for, or in the wrong place.
    #[error("channel {channel}: {why}")]
    Response {
        /// The channel.
        channel: &'static str,
        /// The rule.
        why: &'static str,
    },
    /// An access that the job must not make.
    #[error(transparent)]
    Memory(#[from] Violation),
}
