//! Faults that a test plants, to check that they are detected.

use serde::{Deserialize, Serialize};

/// A fault that happens once. Requests are counted from 0 in each direction, from the start of the link or the last
/// [`Link::plan`](super::Link::plan).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fault {
    /// The response to this read is an error.
    ReadError(u64),
    /// The response to this read never comes.
    ReadLost(u64),
    /// The response to this read comes twice. (The AFU can detect the second only while its tag is free. If the link
    /// holds it back long enough, the tag belongs to another request.)
    ReadTwice(u64),
    /// This read and the next one get each other's data. (Without a next read, this one gets no response.)
    ReadSwapped(u64),
    /// One bit (0 to 511) of this read's data is flipped.
    ReadFlipped {
        /// The read.
        read: u64,
        /// The bit.
        bit: u16,
    },
    /// The response to this write is an error, and nothing is written.
    WriteError(u64),
    /// The response to this write never comes, and nothing is written.
    WriteLost(u64),
    /// The acknowledgement of this write comes twice.
    WriteTwice(u64),
}
