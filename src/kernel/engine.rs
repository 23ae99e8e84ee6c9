//! What computes contacts in batches: the seam between those who have pairs and those who can do them.

use super::Reference;
use super::batch::{Batch, Level};
use crate::query::{ContactRecord, Fields, PairRecord};

/// Why an engine gave no contacts: whatever its own error is.
pub type EngineError = Box<dyn std::error::Error + Send + Sync>;

/// A batch of pairs in, as many contacts out, in their order: a kernel in software, or an AFU behind its host.
///
/// A batch and not a pair, because an AFU needs a transaction for each call.
pub trait Engine {
    /// The contacts of `pairs`, one each, in their order.
    ///
    /// # Errors
    /// When the engine could not do its work; there are no contacts then.
    fn contacts(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError>;
}

impl<E: Engine + ?Sized> Engine for &mut E {
    fn contacts(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
        (**self).contacts(pairs)
    }
}

impl Engine for Reference {
    fn contacts(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
        Ok(self.settled(pairs).0)
    }
}

/// Every field of every contact, by the batch kernel at this level.
impl Engine for Level {
    fn contacts(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
        let pairs = Batch::from_pairs(pairs);
        let mut contacts = Batch::zeros(pairs.len());
        self.run(&pairs, &mut contacts, Fields::ALL);
        Ok(contacts.contacts().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Format;

    #[test]
    fn the_engines_of_this_module_agree() {
        let sphere = |i: u32| [i as f32 * 0.25, 0.0, 0.0, 0.5];
        let pairs: Vec<_> = (0..100).map(|i| PairRecord::from_spheres(sphere(0), sphere(i % 7))).collect();
        let mut reference = Reference::new(Format::BINARY32, Fields::ALL);
        let expected = reference.contacts(&pairs).unwrap();
        assert_eq!(expected.iter().filter(|contact| contact.is_contact()).count(), 72);
        for mut level in Level::available() {
            let mut engine: &mut dyn Engine = &mut level;
            assert_eq!((&mut engine).contacts(&pairs).unwrap(), expected);
        }
    }
}
