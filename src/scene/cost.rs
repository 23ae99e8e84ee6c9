//! What an AFU costs, as far as its generator knows, and as Yosys counts it.

use std::collections::BTreeMap;

use serde::Serialize;

use super::SceneError;
use crate::afu::{Afu, Spec};
use crate::config::{Config, Profile};
use crate::pipeline::KernelReport;
use crate::synth::{Options, Target, Unit, synthesise};

/// What an AFU takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Operators of an SCPU by module name, and how many there are.
    pub operators: BTreeMap<String, usize>,
    /// Modules of the whole AFU, each counted once.
    pub modules: usize,
    /// Cycles from a pair to its contact.
    pub latency_cycles: u32,
    /// Bytes over the link for a pair.
    pub bytes_sent: f64,
    /// Bytes over the link for a contact that comes back.
    pub bytes_returned: f64,
    /// Whether pairs that do not touch come back too.
    pub returns_misses: bool,
    /// LUTs of an SCPU on an ECP5, counted by Yosys; nothing where it was not asked or is not there.
    pub luts: Option<u64>,
    /// DSP blocks of an SCPU, likewise.
    pub dsps: Option<u64>,
    /// Host time of a step, all but the engine's part, nanoseconds; nothing where it was not measured.
    pub host_step_ns: Option<f64>,
}

impl Cost {
    /// The cost of a configuration, without LUTs.
    ///
    /// # Errors
    /// When there is no such AFU.
    pub fn of(config: &Config) -> Result<Self, SceneError> {
        let afu = Afu::generate(Spec::from(config.clone()))?;
        let layout = afu.layout();
        let line = 64.0;
        let operators = KernelReport::of(afu.kernel()).operators;
        Ok(Self {
            operators: operators.into_iter().map(|operator| (operator.module, operator.instances)).collect(),
            modules: afu.top().hierarchy().len(),
            latency_cycles: afu.kernel().latency,
            bytes_sent: line / f64::from(layout.pairs_per_line()),
            bytes_returned: line / f64::from(layout.contacts_per_line()),
            returns_misses: config.results == crate::config::Results::All,
            luts: None,
            dsps: None,
            host_step_ns: None,
        })
    }

    /// Has Yosys count an SCPU for an ECP5.
    ///
    /// # Errors
    /// When Yosys is not there, or refuses.
    pub fn count(&mut self, config: &Config) -> Result<(), SceneError> {
        let options = Options { target: Target::Ecp5, seeds: Vec::new() };
        let area = synthesise(&Unit::scpu(config)?, &options, |_| {})?.area;
        (self.luts, self.dsps) = (Some(area.luts), Some(area.dsps));
        Ok(())
    }

    /// Bytes that `pairs` pairs of which `contacts` touch take over the link, up and down.
    pub fn bytes(&self, pairs: u64, contacts: u64) -> f64 {
        let back = if self.returns_misses { pairs } else { contacts };
        self.bytes_sent * pairs as f64 + self.bytes_returned * back as f64
    }
}

/// The profile with the fewest fraction bits whose depths and positions err no more than `bound`, relative to the largest
/// coordinate or radius of the pair.
///
/// A coordinate or radius is rounded once on its way in, and no result is made of more than sixteen roundings, each of
/// half a unit of something no larger than a few of them. (A normal's error is that divided by the distance: spheres
/// that nearly coincide have a normal that no bound but `exact` helps.) Beyond what 23 bits do there is `exact`.
pub(super) fn narrowest(bound: f64) -> Profile {
    const ROUNDINGS: f64 = 16.0;
    let errs = |fraction: i32| ROUNDINGS * 0.5 * 2.0_f64.powi(-fraction);
    match (4..=23).find(|&fraction| errs(fraction) <= bound) {
        Some(23) => Profile::WIDE,
        Some(fraction) => format!("e10f{fraction}z").parse().unwrap_or(Profile::WIDE),
        None => Profile::EXACT,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{Fields, PairRecord};
    use crate::pairs::Set;

    /// The bound is kept, on pairs of many sizes, and is not idle: the next narrower format breaks a thirtieth of it.
    #[test]
    fn an_error_bound_picks_a_format_that_keeps_it() {
        let pairs: Vec<PairRecord> = Set::Random(20_000).pairs(3).into_iter().filter(|pair| pair.is_valid()).collect();
        for bound in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
            let profile = narrowest(bound);
            let (narrow, wide) = (profile.reference(Fields::ALL), Profile::EXACT.reference(Fields::ALL));
            let mut worst: f64 = 0.0;
            for (one, other) in narrow.settled(&pairs).0.iter().zip(wide.settled(&pairs).0).zip(&pairs).filter_map(
                |((one, other), pair)| {
                    (one.is_contact() && other.is_contact()).then_some((worth(one, pair), worth(&other, pair)))
                },
            ) {
                let size = one.0;
                let errors = one.1.iter().zip(other.1).map(|(a, b)| (a - b).abs() / size);
                worst = errors.fold(worst, f64::max);
            }
            assert!(worst <= bound, "{bound}: {profile} errs by {worst}");
            assert!(worst >= bound / 100.0, "{bound}: {profile} errs by {worst} alone");
        }
        assert!(narrowest(1e-9).is_exact());
    }

    /// The largest number of a pair; depth and position of its contact.
    fn worth(contact: &crate::kernel::ContactRecord, pair: &PairRecord) -> (f64, [f64; 4]) {
        let size = pair.values().iter().fold(0.0_f64, |size, value| size.max(f64::from(value.abs())));
        let [x, y, z] = contact.position();
        (size, [contact.depth(), x, y, z].map(f64::from))
    }
}
