//! What can go wrong in a session, and what to do about it.

use super::transport::TransportError;
use crate::afu::OtherRadius;
use crate::afu::shell::spl2::map;
use crate::config::RecordFormat;

/// Why a transaction has no results.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HostError {
    /// No workspace is like that.
    #[error("a workspace of {0} pages of 2 MB: give it 1 to 1024")]
    Pages(u64),
    /// An AFU that sends contacts alone.
    #[error("this host takes a record for each pair: generate the AFU with --results all")]
    OnlyHits,
    /// An address that is not the workspace's.
    #[error("virtual address {0:#x} is not in the workspace: give it more pages")]
    Outside(u64),
    /// More pairs than the buffers hold.
    #[error(
        "nCol {pairs} is beyond the buffers, which hold {capacity}: give the workspace {pages} pages (1024 at most), or send the \
         pairs in several transactions, as the session as an engine does"
    )]
    TooManyPairs {
        /// Pairs that were to be sent.
        pairs: u64,
        /// Pairs that there is room for.
        capacity: u64,
        /// Pages that would hold them.
        pages: u64,
    },
    /// A pair with another radius than the AFU's.
    #[error(transparent)]
    Radius(#[from] OtherRadius),
    /// The device never said who it is.
    #[error(
        "AFU_ID never seen in the DSM after {0} cycles: see that the FPGA holds this AFU and that its clock runs, then begin a \
         new transaction"
    )]
    NoIdentity(u64),
    /// The device is something else.
    #[error(
        "the FPGA holds AFU_ID {afu_id:032x} version {version}, this host is for {:032x} version {}: load the AFU that the same \
         version of this program generated",
        map::AFU_ID,
        map::VERSION
    )]
    Identity {
        /// Who it is.
        afu_id: u128,
        /// Its register map's version.
        version: u32,
    },
    /// The device is another AFU of ours.
    #[error(
        "the FPGA's AFU has {what} {found}, this session expects {expected}: load the AFU that was asked for, or make the \
         session for the configuration that is there"
    )]
    Capability {
        /// Of what.
        what: &'static str,
        /// As asked for.
        expected: u64,
        /// As the device says.
        found: u64,
    },
    /// The status never came.
    #[error(
        "Status never set, {cycles} cycles after the start word ({reads} reads and {writes} writes without a response): end the \
         transaction, which resets the AFU, and send it again; a watchdog would have ended the job earlier"
    )]
    NoStatus {
        /// Cycles waited.
        cycles: u64,
        /// Reads that were asked for and not answered.
        reads: u64,
        /// Writes likewise.
        writes: u64,
    },
    /// The results are another transaction's.
    #[error(
        "the status is of transaction {found}, not of {expected}: these results were read too early, wait for their status"
    )]
    Stale {
        /// This one's number.
        expected: u32,
        /// The status's.
        found: u32,
    },
    /// A line of the results that was never written.
    #[error(
        "line {0} of the destination was never written, though the job ended well: the link lost a write; send it again"
    )]
    Unwritten(u64),
    /// The device ended the job with an error.
    #[error("the AFU ended the job with error {code} ({what}): {advice}")]
    Job {
        /// Its code.
        code: u8,
        /// What it stands for.
        what: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// Pairs that are none.
    #[error(
        "{count} invalid pairs, the first is pair {first}, whose {field} is, as {record}, NaN, infinite or a negative radius: mend or leave it out"
    )]
    InvalidPairs {
        /// How many.
        count: u32,
        /// The number of the first.
        first: u32,
        /// Its field.
        field: &'static str,
        /// The numbers of the AFU's records.
        record: RecordFormat,
    },
    /// The transport.
    #[error(transparent)]
    Transport(#[from] TransportError),
}

impl HostError {
    /// The error of a status's code, if it is one.
    pub(super) fn of_status(code: u8) -> Option<Self> {
        let (what, advice) = match code {
            0 => return None,
            1 => ("aborted", "send the transaction again if it was not you who aborted it"),
            2 => ("read error", "see that source and page table are where the context says, then send it again"),
            3 => ("write error", "see that the destination may be written, then send it again"),
            4 => ("watchdog", "a response did not come in time; send it again, with a longer watchdog on a slow link"),
            5 => ("unknown mode", "this AFU has mode 0 alone"),
            8 => ("more pairs than the buffers have lines for", "use a workspace of the AFU's own record layout"),
            _ => ("unknown code", "load an AFU of this program's version"),
        };
        Some(Self::Job { code, what, advice })
    }
}
