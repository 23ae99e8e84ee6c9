//! The results of a transaction.

use super::error::HostError;
use super::received::by_pair;
use super::report::Report;
use crate::query::{ContactRecord, PairRecord};
use crate::record::Layout;

/// The contacts of a transaction, with what the AFU said at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct JobResults {
    /// A record for each pair, or only for each pair that touches, as the AFU's results are, in the pairs' order. Words
    /// that the AFU does not compute are zero.
    pub contacts: Vec<ContactRecord>,
    /// For each of `contacts` its pair's number in the job, from 0.
    pub numbers: Vec<u32>,
    /// Contacts, as the AFU counted.
    pub hits: u32,
    /// Invalid pairs, as the AFU counted.
    pub invalid: u32,
    /// The number of the first.
    pub first_invalid: Option<u32>,
    /// Pairs that the AFU left to the host (profile exact), which settled them: their contacts are the host's.
    pub unsettled: u64,
    /// The AFU's records: what is invalid is so in their numbers.
    pub layout: Layout,
    /// The cycles of its phases.
    pub report: Report,
}

impl JobResults {
    /// A contact for each pair, in their order; where only contacts come back, the others read as pairs without one.
    pub fn by_pair(&self) -> Vec<ContactRecord> {
        by_pair(usize::try_from(self.report.pairs).unwrap_or(usize::MAX), &self.numbers, &self.contacts)
    }

    /// Nothing, if every pair was one.
    ///
    /// # Errors
    /// Returns [`HostError::InvalidPairs`], which names the first invalid pair of `pairs` and its field.
    pub fn strict(&self, pairs: &[PairRecord]) -> Result<(), HostError> {
        let Some(first) = self.first_invalid else { return Ok(()) };
        let record = self.layout.record();
        let pair = pairs.get(first as usize).map(|pair| pair.rounded(record.format()));
        let field = pair.and_then(|pair| pair.broken(self.layout.query())).map_or("word", |input| input.name);
        Err(HostError::InvalidPairs { count: self.invalid, first, field, record })
    }
}
