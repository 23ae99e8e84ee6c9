//! Faults a test plants, to see them found.

use serde::{Deserialize, Serialize};

/// Something a link must not do, done once. Requests are counted from 0 in each direction, from the start of the link
/// or the last [`Link::plan`](super::Link::plan).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fault {
    /// The response to this read is an error.
    ReadError(u64),
    /// The response to this read never comes.
    ReadLost(u64),
    /// The response to this read comes twice. (The second is the AFU's error to find only while its tag is free: with a
    /// link that holds it back long enough, the tag belongs to another request.)
    ReadTwice(u64),
    /// This read and the next get each other's data. (If no next read comes, neither does this one's response.)
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
