//! The outcome of a job: what the AFU counted, what it wrote and when, whatever shell is around it.

use std::fmt;

use crate::afu::JobError;
use crate::link::Line;

/// An access of memory that was answered with an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Read or write.
    pub channel: Channel,
    /// The response: 2 SLVERR, 3 DECERR.
    pub response: u8,
    /// The byte address of the line that was read, or of the burst that was written.
    pub address: u64,
}

/// The channel of a response.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// R of AXI4.
    Read,
    /// B of AXI4.
    Write,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let response = if self.response == 2 { "SLVERR" } else { "DECERR" };
        match self.channel {
            Channel::Read => write!(f, "the read of {:#x} was answered with {response} on channel R", self.address),
            Channel::Write => write!(f, "the write at {:#x} was answered with {response} on channel B", self.address),
        }
    }
}

/// The outcome of a job that ended, well or with an error.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Cycles from its start to its end: of the line port's `start` and `done`, or from the start word to the status.
    pub cycles: u64,
    /// The AFU's error code: 0 if all went well.
    pub error: u8,
    /// The first access of memory that failed, if the shell says which.
    pub failure: Option<Failure>,
    /// Contacts, as the AFU counted them.
    pub contacts: u32,
    /// Pairs of spheres whose boxes meet, as the AFU counted them, if spheres came in.
    pub candidates: Option<u32>,
    /// Invalid pairs, as the AFU counted them.
    pub invalid: u32,
    /// The first invalid pair's number.
    pub first_invalid: Option<u32>,
    /// Cycles of the job, as the AFU counted them.
    pub cycles_busy: u64,
    /// Cycles in which it waited for input.
    pub cycles_input: u64,
    /// Cycles in which it waited for its output to leave.
    pub cycles_output: u64,
    /// Cycles from the first read's data to the first write request; `None` if either never was.
    pub latency_cycles: Option<u64>,
    /// Bytes of the lines that were read.
    pub bytes_read: u64,
    /// Bytes of the lines that were written.
    pub bytes_written: u64,
    /// The least cycles that these lines take over this link.
    pub limit_cycles: f64,
    /// The destination lines in order; `None` for a line that was never written.
    pub lines: Vec<Option<Line>>,
    /// For each destination line the cycle of the job in which its last write was accepted.
    pub write_cycles: Vec<Option<u64>>,
}

impl Outcome {
    /// How the job failed, if it did; a code that no AFU should give is a failed mode.
    pub fn job_error(&self) -> Option<JobError> {
        (self.error != 0).then(|| JobError::of_code(self.error).unwrap_or(JobError::Mode))
    }

    /// The share of the link's speed that was reached.
    pub fn efficiency(&self) -> f64 {
        if self.cycles == 0 { 0.0 } else { self.limit_cycles / self.cycles as f64 }
    }
}
