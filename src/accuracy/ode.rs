//! The Open Dynamics Engine itself, in double precision.

use super::{Answer, Contender};
use crate::kernel::EngineError;
use crate::ode::{Collider, Ode, SpherePair};
use crate::query::{PairRecord, Query};

/// ODE's own collider, on the pairs' exact values.
#[derive(Debug)]
pub struct OdeDouble {
    pair: SpherePair,
}

impl OdeDouble {
    /// Starts ODE.
    ///
    /// # Errors
    /// Returns an error if it cannot be started.
    pub fn new(query: Query) -> Result<Self, EngineError> {
        let ode = Ode::start(Collider::Own)?;
        Ok(Self { pair: SpherePair::of_query(query, &ode)? })
    }
}

impl Contender for OdeDouble {
    fn name(&self) -> String {
        "ODE f64".to_owned()
    }

    fn answers(&mut self, pairs: &[PairRecord]) -> Result<Vec<Answer>, EngineError> {
        let mut answers = Vec::with_capacity(pairs.len());
        for pair in pairs {
            let [x1, y1, z1, r1, x2, y2, z2, r2] = pair.values().map(f64::from);
            self.pair.set([x1, y1, z1, r1], [x2, y2, z2, r2])?;
            let answer = self.pair.collide().map(|contact| Answer {
                hit: true,
                position: contact.position,
                normal: contact.normal,
                depth: contact.depth,
                unsettled: false,
            });
            answers.push(answer.unwrap_or_default());
        }
        Ok(answers)
    }
}
