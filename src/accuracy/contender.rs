//! Who answers pairs.

use super::measure::in_parallel;
use super::{Answer, Formula};
use crate::config::{Profile, RecordFormat};
use crate::kernel::{ContactRecord, EngineError, Fields, PairRecord, Reference, settle};

/// Something that answers pairs: a profile's reference kernel, or another engine.
pub trait Contender {
    /// The name that results are kept and shown under: the same name answers the same bits.
    fn name(&self) -> String;

    /// The answers to `pairs`, one each, in their order.
    ///
    /// # Errors
    /// When the engine could not do its work.
    fn answers(&mut self, pairs: &[PairRecord]) -> Result<Vec<Answer>, EngineError>;
}

/// A profile's reference kernel, which the hardware equals bit for bit. Over shorter records it answers the pair that
/// was rounded to them, and is judged by the one that was given: that rounding is part of what they cost.
#[derive(Clone, Debug)]
pub struct Profiled {
    profile: Profile,
    record: RecordFormat,
    reference: Reference,
}

impl Profiled {
    /// The kernel of a profile.
    pub fn new(profile: &Profile) -> Self {
        Self::over(profile, RecordFormat::F32)
    }

    /// The kernel of a profile over such records in memory.
    pub fn over(profile: &Profile, record: RecordFormat) -> Self {
        let reference = profile.reference(Fields::ALL).with_record(record.format());
        Self { profile: profile.clone(), record, reference }
    }

    /// Its name as a contender.
    pub fn title(&self) -> String {
        match self.record {
            RecordFormat::F32 => self.profile.to_string(),
            record => format!("{} record {record}", self.profile),
        }
    }
}

impl Contender for Profiled {
    fn name(&self) -> String {
        self.title()
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

/// The profiles asked for, then the peers that this build has. The names of the other peers are given apart, each
/// with the feature that brings it.
///
/// # Errors
/// When a peer does not start.
pub fn contenders(profiles: &[Profile]) -> Result<(Contenders, Vec<&'static str>), EngineError> {
    let mut all = Contenders::new();
    for profile in profiles {
        all.push(Box::new(Profiled::new(profile)));
    }
    all.push(Box::new(Formula));
    #[cfg(feature = "ode")]
    all.push(Box::new(super::OdeDouble::new()?));
    #[cfg(feature = "parry")]
    all.push(Box::new(super::Parry));
    let missing = [
        (cfg!(feature = "ode"), "ODE f64 is not in this program: build it with --features ode"),
        (cfg!(feature = "parry"), "parry3d is not in this program: build it with --features parry"),
    ];
    let absent = missing.into_iter().filter(|(there, _)| !there).map(|(_, said)| said).collect();
    Ok((all, absent))
}
