//! A world's contacts from an engine: gathered, computed in one batch, and passed to ODE one by one.

use super::{Collider, Contact, Error, Sphere, Touch, World, replace};
use crate::kernel::Engine;
use crate::query::{ContactRecord, Flow, PairRecord};

impl World {
    /// Two spheres as a record: each number rounded to binary32 once.
    pub fn record(&self, [first, second]: [Sphere; 2]) -> PairRecord {
        PairRecord::from_spheres(self.rounded(first), self.rounded(second))
    }

    /// The centre and the radius of a sphere, each number rounded to binary32 once.
    pub(super) fn rounded(&self, sphere: Sphere) -> [f32; 4] {
        let [x, y, z] = self.position(sphere);
        [x, y, z, self.radius(sphere)].map(|v| v as f32)
    }

    /// Every present contact, by an engine that replaces ODE's collider. The candidates go in one batch, rounded to
    /// binary32, and their contacts through ODE's collider override. The order is that of [`World::contacts`].
    ///
    /// # Errors
    /// Returns an error if ODE runs with its own collider, a sphere is lost, or the engine fails or gives an invalid
    /// answer.
    pub fn contacts_by(&self, engine: &mut dyn Engine) -> Result<Vec<Touch>, Error> {
        self.ode.needs(Collider::Engine)?;
        let pairs = self.candidates()?;
        let records: Vec<_> = pairs.iter().map(|&pair| self.record(pair)).collect();
        let answers = engine.contacts(&records).map_err(Error::Engine)?;
        if answers.len() != pairs.len() {
            return Err(Error::Count { pairs: pairs.len(), contacts: answers.len() });
        }
        let mut touches = Vec::new();
        for (&[first, second], &answer) in pairs.iter().zip(&answers) {
            let contact = checked(first, second, answer)?;
            let [g1, g2] = self.geoms(first, second);
            // SAFETY: both geoms live as long as the world.
            if let Some(contact) = unsafe { replace::answer(g1, g2, contact) } {
                touches.push(Touch { first, second, contact });
            }
        }
        Ok(touches)
    }
}

/// The contact in an engine's answer; `None` if the spheres do not touch.
pub(super) fn checked(first: Sphere, second: Sphere, answer: ContactRecord) -> Result<Option<Contact>, Error> {
    let (first, second) = (first.0, second.0);
    let flags = answer.flags();
    if !matches!(answer.flow(), Some(flow) if flow != Flow::Invalid) {
        return Err(Error::Flags { first, second, flags });
    }
    let contact = Contact::from_record(answer);
    if contact.is_some_and(|contact| !contact.is_plausible()) {
        return Err(Error::Contact { first, second });
    }
    Ok(contact)
}
