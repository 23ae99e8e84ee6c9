//! Who answers pairs.

use super::measure::in_parallel;
use super::{Answer, Formula};
use crate::config::{Config, Profile, RecordFormat};
use crate::kernel::{EngineError, Reference, settle};
use crate::query::{ContactRecord, Fields, PairRecord, Query};

/// Something that answers pairs: a profile's reference kernel, or another engine.
pub trait Contender {
    /// The name that results are kept and shown under: the same name answers the same bits.
    fn name(&self) -> String;

    /// The answers to `pairs`, one each, in their order.
    ///
    /// # Errors
    /// Returns an error if the engine could not do its work.
    fn answers(&mut self, pairs: &[PairRecord]) -> Result<Vec<Answer>, EngineError>;
}

/// A profile's reference kernel, which the hardware equals bit for bit. Over shorter records it answers the pair that
/// was rounded to them, and is judged by the one that was given: that rounding is part of what they cost.
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

/// The profiles asked for, then the peers that this build has and that answer the query. Returns what is missing too,
/// each with what would bring it.
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
