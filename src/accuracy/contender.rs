//! The contenders that answer pairs.

use super::measure::in_parallel;
use super::{Answer, Formula};
use crate::config::{Config, Profile, RecordFormat};
use crate::kernel::{EngineError, Reference, settle};
use crate::query::{ContactRecord, Fields, PairRecord, Query};

/// Something that answers pairs: a profile's reference kernel, or another engine.
pub trait Contender {
    /// The name under which results are stored and shown. The same name must always answer the same bits.
    fn name(&self) -> String;

    /// The answers to `pairs`, one each, in their order.
    ///
    /// # Errors
    /// Returns an error if the engine failed.
    fn answers(&mut self, pairs: &[PairRecord]) -> Result<Vec<Answer>, EngineError>;
}

/// A profile's reference kernel, which the hardware equals bit for bit. Over shorter records it answers the rounded
/// pair, but is judged by the given one, because this rounding is part of the cost of such records.
#[derive(Clone, Debug)]
pub struct Profiled {
    name: String,
    reference: Reference,
}

impl Profiled {
    /// The kernel of two spheres, in a profile.
    pub fn new(profile: &Profile) -> Self {
        Self::of(&Config { profile: profile.clone(), ..Config::default() })
    }

    /// The kernel of a configuration's query and profile, over its records in memory, with every field.
    pub fn of(config: &Config) -> Self {
        let Config { profile, record, .. } = config;
        let name = match record {
            RecordFormat::F32 => profile.to_string(),
            record => format!("{profile} record {record}"),
        };
        Self { name, reference: Config { contact: Fields::ALL, ..config.clone() }.reference() }
    }
}

impl Contender for Profiled {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn answers(&mut self, pairs: &[PairRecord]) -> Result<Vec<Answer>, EngineError> {
        let answer = |(raw, settled): (ContactRecord, ContactRecord)| Answer {
            unsettled: raw.is_unsettled(),
            ..Answer::from(settled)
        };
        Ok(in_parallel(pairs, |pairs| {
            let raw = self.reference.run_all(pairs);
            let mut settled = raw.clone();
            settle(pairs, &mut settled, Fields::ALL);
            raw.into_iter().zip(settled).map(answer).collect()
        }))
    }
}

/// Contenders, in the order of a report.
pub type Contenders = Vec<Box<dyn Contender>>;

/// The given profiles, then the peers of this build that can answer the query. Also returns the missing peers, each
/// with the way to get it.
///
/// # Errors
/// Returns an error if a peer does not start.
pub fn contenders(query: Query, profiles: &[Profile]) -> Result<(Contenders, Vec<&'static str>), EngineError> {
    let mut all = Contenders::new();
    for profile in profiles {
        all.push(Box::new(Profiled::of(&Config { query, profile: profile.clone(), ..Config::default() })));
    }
    all.push(Box::new(Formula(query)));
    #[cfg(feature = "ode")]
    all.push(Box::new(super::OdeDouble::new(query)?));
    let of_spheres = query == Query::SphereSphere;
    #[cfg(feature = "parry")]
    if of_spheres {
        all.push(Box::new(super::Parry));
    }
    let missing = [
        (cfg!(feature = "ode"), "ODE f64 is not in this program: build it with --features ode"),
        (of_spheres, "parry3d is compared for sphere-sphere alone"),
        (cfg!(feature = "parry") || !of_spheres, "parry3d is not in this program: build it with --features parry"),
    ];
    let absent = missing.into_iter().filter(|(there, _)| !there).map(|(_, said)| said).collect();
    Ok((all, absent))
}
