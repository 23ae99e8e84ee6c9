//! Engines: anything that computes contacts in batches, such as a kernel in software or an AFU.

use super::Reference;
use super::batch::{Batch, Level};
use crate::query::{ContactRecord, Fields, PairRecord};

/// The error of an engine, of any type.
pub type EngineError = Box<dyn std::error::Error + Send + Sync>;

/// Computes one contact per pair, in order: a kernel in software, or an AFU behind its host.
///
/// The unit is a batch, because an AFU needs a transaction for each call.
pub trait Engine {
    /// The contacts of `pairs`, one each, in order.
    ///
    /// # Errors
    /// Returns an error if the engine fails; it then returns no contacts.
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

/// Computes every field of every contact with the batch kernel at this level.
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
