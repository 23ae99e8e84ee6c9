//! Violations at SPL2's port.

/// An access or request that the AFU or the host must not make.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Spl2Error {
    /// More requests than SPL accepts after almost-full.
    #[error("a {what} as request {after} after almost-full: SPL accepts at most 4")]
    Overshoot {
        /// Read or write.
        what: &'static str,
        /// Requests since almost-full rose.
        after: u32,
    },
    /// A header that SPL does not know.
    #[error("a {what} header {header:#027x}: {why}")]
    Header {
        /// Read or write.
        what: &'static str,
        /// The 99 bits.
        header: u128,
        /// The violation.
        why: &'static str,
    },
    /// The `mdata` of a request that is still outstanding.
    #[error("a {what} used mdata {mdata:#06x} before the response to its last use")]
    MdataReused {
        /// Read or write.
        what: &'static str,
        /// The mdata.
        mdata: u16,
    },
    /// A request long after SPL was disabled or reset.
    #[error("a {what} although SPL has been disabled or in reset for {cycles} cycles")]
    Disabled {
        /// Read or write.
        what: &'static str,
        /// Cycles since SPL was disabled or reset.
        cycles: u64,
    },
    /// An interrupt. This AFU raises none.
    #[error("an interrupt, which this AFU never raises")]
    Interrupt,
    /// An address outside the page table.
    #[error("page fault: a {what} of virtual line {line:#x}")]
    PageFault {
        /// Read or write.
        what: &'static str,
        /// The line address.
        line: u64,
    },
    /// A line outside the job's source, destination and status.
    #[error("a {what} of virtual line {line:#x}, which the job does not own")]
    Outside {
        /// Read or write.
        what: &'static str,
        /// The line address.
        line: u64,
    },
    /// A second write to a line of the results.
    #[error("a second write to virtual line {0:#x}")]
    WrittenTwice(u64),
    /// The host enabled SPL with an invalid context.
    #[error("SPL2 context: {0}")]
    Context(&'static str),
}
