//! The results of a transaction.

use super::error::HostError;
use super::received::by_pair;
use super::report::Report;
use crate::query::{ContactRecord, PairRecord};
use crate::record::Layout;

/// The contacts of a transaction, with what the AFU reported at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct JobResults {
    /// A record for each pair, or only for each pair that touches, as the AFU writes them, in the order of the pairs.
    /// Words that the AFU does not compute are zero.
    pub contacts: Vec<ContactRecord>,
    /// For each record in `contacts`, the number of its pair in the job, from 0.
    pub numbers: Vec<u32>,
    /// The number of contacts that the AFU counted.
    pub hits: u32,
    /// The number of invalid pairs that the AFU counted.
    pub invalid: u32,
    /// The number of the first invalid pair.
    pub first_invalid: Option<u32>,
    /// The number of pairs that the AFU left to the host (profile exact). The host resolved them, so these contacts are
    /// the host's.
    pub unsettled: u64,
    /// The format of the AFU's records: a pair is invalid if it is invalid in that format.
    pub layout: Layout,
    /// The cycles of the transaction's phases.
    pub report: Report,
}

impl JobResults {
    /// A contact for each pair, in their order. If the AFU returns only contacts, the other pairs read as no contact.
    pub fn by_pair(&self) -> Vec<ContactRecord> {
        by_pair(usize::try_from(self.report.pairs).unwrap_or(usize::MAX), &self.numbers, &self.contacts)
    }

    /// Succeeds if every pair was valid.
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
