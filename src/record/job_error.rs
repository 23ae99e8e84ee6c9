//! The error codes of a job, shared by hardware, hosts and documentation.

use crate::config::{Input, Shell};

/// The error of a job, in the port `error` and in the status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobError {
    /// Stopped by `abort`.
    Aborted = 1,
    /// A read was answered with an error.
    Read = 2,
    /// A write was answered with an error.
    Write = 3,
    /// No response for as many cycles as `watchdog` says, with requests outstanding.
    Watchdog = 4,
    /// The job asked for a `mode` that this AFU does not have.
    Mode = 5,
    /// The job has more lines of contacts than its destination. The others were not written, but all contacts were
    /// counted.
    Overflow = 6,
    /// A response came that no request of this job waits for.
    Response = 7,
    /// The job takes more lines than the host's buffers have; reported by a shell that knows their length.
    Room = 8,
    /// The first set has more spheres than the table holds, or the second more than a hit's number counts.
    Table = 9,
}

impl JobError {
    /// All errors in the order of their codes.
    pub const ALL: [Self; 9] = [
        Self::Aborted,
        Self::Read,
        Self::Write,
        Self::Watchdog,
        Self::Mode,
        Self::Overflow,
        Self::Response,
        Self::Room,
        Self::Table,
    ];
    /// The number of bits of a code. Code 0 means no error.
    pub const BITS: u32 = 4;

    /// The code in the port and in the status.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The error of a code; `None` if it is 0 or unknown.
    pub(crate) fn of_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|error| error.code() == code)
    }

    /// A description of the error.
    pub const fn what(self) -> &'static str {
        self.texts().0
    }

    /// Advice for the user of an AFU with this shell and this input.
    pub const fn advice(self, shell: Shell, input: Input) -> &'static str {
        match (self, shell) {
            (Self::Mode, _) if matches!(input, Input::Spheres) => "use mode 0, 1 or 2",
            (Self::Room, _) if matches!(input, Input::Spheres) => "send fewer spheres, or set up longer buffers",
            (Self::Read, Shell::Spl2) => {
                "check that source and page table are where the context says, then send the transaction again"
            }
            (Self::Read, Shell::Axi) => {
                "check that `source` and the lines behind it are memory that the master can reach, then start the job again"
            }
            (Self::Write, Shell::Axi) => {
                "check that `destination` is memory that the master can write, then start the job again"
            }
            (Self::Response, Shell::Axi) => {
                "reset the interconnect and the accelerator together, then start the job again: memory answered what \
                 nobody had asked for"
            }
            _ => self.texts().1,
        }
    }

    /// The errors that an AFU with this shell and this input can give, in the order of their codes.
    pub fn of(shell: Shell, input: Input) -> impl Iterator<Item = Self> {
        // Only SPL2's context tells the AFU how long its buffers are.
        Self::ALL.into_iter().filter(move |&error| match error {
            Self::Room => shell == Shell::Spl2,
            Self::Table => input == Input::Spheres,
            _ => true,
        })
    }

    const fn texts(self) -> (&'static str, &'static str) {
        match self {
            Self::Aborted => ("aborted", "send the transaction again, unless you aborted it yourself"),
            Self::Read => ("read error", "check that the source is readable, then send the transaction again"),
            Self::Write => ("write error", "check that the destination is writable, then send the transaction again"),
            Self::Watchdog => (
                "watchdog",
                "a response did not come in time: send the transaction again, on a slow link with a longer watchdog",
            ),
            Self::Mode => ("unknown mode", "use mode 0, the only mode of this AFU"),
            Self::Overflow => (
                "more contacts than the destination has lines for",
                "give the destination more lines: all contacts were counted, but only those that fit were written",
            ),
            Self::Response => (
                "a response that no request waits for",
                "reset the AFU, then send the transaction again: the link answered a request twice or too late",
            ),
            Self::Room => (
                "the job takes more lines than the buffers have",
                "send fewer pairs, or set up the buffers for the AFU's own record layout",
            ),
            Self::Table => (
                "more spheres than the table holds, or than a hit's number counts",
                "send fewer spheres, or generate the AFU with a larger --table",
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_is_its_error_s() {
        for code in 0..=u8::MAX {
            let error = JobError::of_code(code);
            assert_eq!(error.map(JobError::code), (1..=JobError::ALL.len() as u8).contains(&code).then_some(code));
        }
        assert!(JobError::ALL.iter().all(|error| u32::from(error.code()) < 1 << JobError::BITS));
    }

    /// Advice speaks of what the shell's user has: no page table without SPL2.
    #[test]
    fn advice_is_of_the_shell() {
        for (shell, input) in
            [Shell::Line, Shell::Axi].into_iter().flat_map(|s| [(s, Input::Direct), (s, Input::Spheres)])
        {
            let errors: Vec<_> = JobError::of(shell, input).collect();
            assert!(errors.iter().all(|error| !error.advice(shell, input).contains("page table")), "{shell}");
            assert!(errors.iter().all(|error| *error != JobError::Room), "{shell}");
            assert_eq!(errors.contains(&JobError::Table), input == Input::Spheres, "{shell}");
            let says_one = JobError::Mode.advice(shell, input).contains("the only mode");
            assert_eq!(says_one, input == Input::Direct, "{shell}");
        }
        let but_spheres = JobError::ALL.into_iter().filter(|error| *error != JobError::Table);
        assert!(JobError::of(Shell::Spl2, Input::Direct).eq(but_spheres));
        assert!(JobError::Read.advice(Shell::Spl2, Input::Direct).contains("page table"));
    }
}
