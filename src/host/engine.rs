//! A session as an engine: batches as transactions.

use super::error::HostError;
use super::session::Session;
use super::transport::Transport;
use crate::kernel::{Engine, EngineError};
use crate::query::{ContactRecord, PairRecord};

impl<T: Transport> Session<T> {
    /// The contacts of `pairs`, from one transaction, or from several if the buffers hold fewer pairs. Empty without
    /// pairs.
    ///
    /// # Errors
    /// Returns the errors of the steps of [`Transaction`](super::Transaction).
    pub fn run(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, HostError> {
        let capacity = usize::try_from(self.workspace().capacity()).unwrap_or(usize::MAX);
        let mut contacts = Vec::with_capacity(pairs.len());
        for pairs in pairs.chunks(capacity) {
            let done = self.transaction().send(pairs)?.start()?.confirm()?.wait()?;
            contacts.extend(done.retrieve()?.end()?.by_pair());
        }
        Ok(contacts)
    }
}

impl<T: Transport> Engine for Session<T> {
    fn contacts(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
        Ok(self.run(pairs)?)
    }
}
