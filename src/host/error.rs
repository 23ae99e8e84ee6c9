//! Errors of a session, and what to do about them.

use super::transport::TransportError;
use crate::afu::shell::spl2::map::AFU_ID;
use crate::config::{Input, RecordFormat, Shell};
use crate::count::counted;
use crate::outcome::{Failure, Outcome};
use crate::record::{JobError, OtherRadius, SetTooLarge};
use crate::spheres::TileSizeError;

/// Why a transaction has no results.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HostError {
    /// The workspace cannot have this number of pages.
    #[error("a workspace of {0} pages of 2 MB: expected 1 to 1024 pages")]
    Pages(u64),
    /// Source and destination cannot be there.
    #[error("the buffers: {0}")]
    Buffers(&'static str),
    /// The address is not in the workspace.
    #[error("virtual address {0:#x} is not in the workspace: give it more pages")]
    Outside(u64),
    /// There are more pairs than the buffers hold.
    #[error(
        "nCol {pairs} is beyond the buffers, which hold {capacity}: give the workspace {pages} pages (1024 at most), or send the \
         pairs in several transactions, as the session as an engine does"
    )]
    TooManyPairs {
        /// The number of pairs to be sent.
        pairs: u64,
        /// The number of pairs that fit.
        capacity: u64,
        /// The number of pages that would hold them.
        pages: u64,
    },
    /// The AFU takes something else.
    #[error(
        "this AFU takes {taken}, not {sent}: send {taken}, or load an AFU of --input {option} and create the session for it"
    )]
    Input {
        /// What it takes.
        taken: &'static str,
        /// What was to be sent.
        sent: &'static str,
        /// The option of an AFU that takes it.
        option: Input,
    },
    /// A set has more spheres than the AFU takes.
    #[error(transparent)]
    Set(#[from] SetTooLarge),
    /// No tile has this size.
    #[error(transparent)]
    Tile(#[from] TileSizeError),
    /// The sets take more lines than the source has.
    #[error(
        "the spheres take {lines} lines, and the source has {room}: give the session a larger workspace (`for_spheres`), or send \
         fewer spheres"
    )]
    TooManySpheres {
        /// Lines of the sets.
        lines: u64,
        /// Lines of the source.
        room: u64,
    },
    /// The pair has a radius that differs from the AFU's.
    #[error(transparent)]
    Radius(#[from] OtherRadius),
    /// The device never identified itself.
    #[error(
        "AFU_ID not in the DSM after {0} cycles: check that the FPGA holds this AFU and that its clock runs, then begin a new \
         transaction"
    )]
    NoIdentity(u64),
    /// The device is not this AFU.
    #[error(
        "expected AFU_ID {:032x} version {}, found {afu_id:032x} version {version}: load the AFU that this version of the \
         program generates",
        AFU_ID,
        expected
    )]
    Identity {
        /// The AFU_ID that was found.
        afu_id: u128,
        /// The version of its register map.
        version: u32,
        /// The version that the host knows.
        expected: u32,
    },
    /// The device is an AFU of another configuration.
    #[error(
        "the FPGA's AFU differs in {what}: expected {expected}, found {found}; load the AFU of this configuration, or create the \
         session for the one that is loaded"
    )]
    Capability {
        /// The property that differs.
        what: &'static str,
        /// The expected value.
        expected: u64,
        /// The value that the device reports.
        found: u64,
    },
    /// The status never arrived.
    #[error(
        "the job did not finish after {cycles} cycles: no status, waiting for {} ({} and {} without a \
         response); end the transaction, which resets the AFU, and send it again",
        if (*reads, *writes) == (0, 0) { "the AFU" } else { "the link" },
        counted(*reads, "read"),
        counted(*writes, "write")
    )]
    NoStatus {
        /// Cycles since the start word.
        cycles: u64,
        /// Read requests without a response.
        reads: u64,
        /// Write requests without a response.
        writes: u64,
    },
    /// A line of the results was never written.
    #[error(
        "line {0} of the destination was never written, although the job succeeded: the link lost a write; send the job again"
    )]
    Unwritten(u64),
    /// The records cannot be those of the pairs that touch.
    #[error("{0}, although the job succeeded: send it again, or load the AFU of this version of the program")]
    Hit(#[from] HitError),
    /// The device ended the job with an error.
    #[error("the AFU ended the job with error {code} ({what}): {advice}")]
    Job {
        /// The error code.
        code: u8,
        /// The meaning of the code.
        what: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// An access of memory failed, and with it the job.
    #[error("the AFU ended the job with error {code} ({what}): {failure}; {advice}")]
    Access {
        /// The error code.
        code: u8,
        /// The meaning of the code.
        what: &'static str,
        /// The access.
        failure: Failure,
        /// What to do.
        advice: &'static str,
    },
    /// The soft reset did not end.
    #[error(
        "the soft reset did not end after {0} cycles: memory owes a response; reset the interconnect and the AFU together"
    )]
    NotDrained(u64),
    /// The job had invalid pairs.
    #[error(
        "{}; the {field} of the first, pair {first}, is in {record} NaN, infinite or a negative radius: correct it or leave it out",
        counted((*count).into(), "invalid pair")
    )]
    InvalidPairs {
        /// The number of invalid pairs.
        count: u32,
        /// The number of the first invalid pair.
        first: u32,
        /// The first invalid field of that pair.
        field: &'static str,
        /// The format of the AFU's records.
        record: RecordFormat,
    },
    /// The job had invalid spheres.
    #[error(
        "{}; the {field} of the first, sphere {first}, is NaN, infinite or a negative radius: correct it or leave it out",
        counted((*count).into(), "invalid sphere")
    )]
    InvalidSpheres {
        /// The number of invalid spheres.
        count: u32,
        /// The number of the first invalid sphere, counted through the sets.
        first: u32,
        /// The first invalid field of that sphere.
        field: &'static str,
    },
    /// The transport failed.
    #[error(transparent)]
    Transport(#[from] TransportError),
}

/// Why the remaining hits of an AFU cannot be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HitError {
    /// The line of a record was never written.
    #[error("contact {index} of {count} was never written")]
    Unwritten {
        /// The index of the record, from 0.
        index: usize,
        /// The number of records that the AFU counted.
        count: u32,
    },
    /// Pair numbers must ascend and be below the number of pairs.
    #[error(
        "contact {index} is of pair {number}, after {}, of {pairs} pairs",
        after.map_or_else(|| "no other".to_owned(), |last| format!("pair {last}"))
    )]
    Number {
        /// The index of the record, from 0.
        index: usize,
        /// The number of its pair.
        number: u32,
        /// The pair number before it.
        after: Option<u32>,
        /// The number of pairs in the job.
        pairs: usize,
    },
    /// Two spheres must be in their sets, and come in the order of the search.
    #[error(
        "contact {index} is of spheres {} and {}, of {} and {} spheres, or not in the order of the search",
        spheres[0], spheres[1], sets[0], sets[1]
    )]
    Spheres {
        /// The index of the record, from 0.
        index: usize,
        /// The numbers of both spheres.
        spheres: [u32; 2],
        /// The numbers of spheres that there are in their sets.
        sets: [u32; 2],
    },
}

impl HostError {
    /// The error with which a job ended; `None` if it ended well.
    pub(super) fn of_outcome(outcome: &Outcome, shell: Shell, input: Input) -> Option<Self> {
        let code = outcome.error;
        if code == 0 {
            return None;
        }
        let unknown = ("unknown code", "load an AFU of this program's version");
        let (what, advice) =
            JobError::of_code(code).map_or(unknown, |error| (error.what(), error.advice(shell, input)));
        Some(match outcome.failure {
            Some(failure) => Self::Access { code, what, failure, advice },
            None => Self::Job { code, what, advice },
        })
    }
}
