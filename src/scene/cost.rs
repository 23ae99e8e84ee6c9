//! The cost of an AFU, as its generator knows it and as Yosys counts it.

use std::collections::BTreeMap;

use serde::Serialize;

use super::SceneError;
use crate::afu::{Afu, Spec};
use crate::config::{Config, Input, Profile};
use crate::pipeline::KernelReport;
use crate::synth::{Options, Placer, Target, Unit, synthesise};

/// Three coordinates and a radius of binary32.
const BYTES_OF_A_SPHERE: u32 = 16;

/// The cost of an AFU.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Operators of an SCPU, by module name, with their number.
    pub operators: BTreeMap<String, usize>,
    /// Modules of the whole AFU, each counted once.
    pub modules: usize,
    /// Cycles from a pair to its contact.
    pub latency_cycles: u32,
    /// What is sent.
    pub input: Input,
    /// Bytes over the link for a pair, or for a sphere.
    pub bytes_sent: f64,
    /// Bytes over the link for a contact that comes back.
    pub bytes_returned: f64,
    /// True if pairs that do not touch come back too.
    pub returns_misses: bool,
    /// LUTs of an SCPU on an ECP5, counted by Yosys; `None` if they were not counted.
    pub luts: Option<u64>,
    /// DSP blocks of an SCPU, likewise.
    pub dsps: Option<u64>,
    /// LUTs of all SCPUs, those that only decide among them; `None` if they were not counted.
    pub luts_of_all: Option<u64>,
    /// DSP blocks of all SCPUs, likewise.
    pub dsps_of_all: Option<u64>,
    /// Host time of a step without the engine's part, in nanoseconds; `None` if it was not measured.
    pub host_step_ns: Option<f64>,
}

impl Cost {
    /// The cost of a configuration, without LUTs.
    ///
    /// # Errors
    /// Returns an error if there is no such AFU.
    pub fn of(config: &Config) -> Result<Self, SceneError> {
        let afu = Afu::generate(Spec::from(config.clone()))?;
        let layout = afu.layout();
        let line = 64.0;
        let operators = KernelReport::of(afu.kernel()).operators;
        Ok(Self {
            operators: operators.into_iter().map(|operator| (operator.module, operator.instances)).collect(),
            modules: afu.top().hierarchy().len(),
            latency_cycles: afu.latency_cycles(),
            input: config.input,
            bytes_sent: match config.input {
                Input::Direct => line / f64::from(layout.pairs_per_line()),
                Input::Spheres => f64::from(BYTES_OF_A_SPHERE),
            },
            bytes_returned: line / f64::from(layout.contacts_per_line()),
            returns_misses: config.results == crate::config::Results::All,
            luts: None,
            dsps: None,
            luts_of_all: None,
            dsps_of_all: None,
            host_step_ns: None,
        })
    }

    /// Lets Yosys count the cells of an SCPU for an ECP5.
    ///
    /// # Errors
    /// Returns an error if Yosys is missing or fails.
    pub fn count(&mut self, config: &Config) -> Result<(), SceneError> {
        let options = Options { target: Target::Ecp5, seeds: Vec::new(), placer: Placer::default() };
        let count = |config: &Config| -> Result<[u64; 2], SceneError> {
            let area = synthesise(&Unit::scpu(config)?, &options, |_| {})?.area;
            Ok([area.luts, area.dsps])
        };
        let spec = Spec::from(config.clone());
        let one = count(config)?;
        let built = u64::from(spec.scpus_in_turn(config.interval));
        let mut all = one.map(|cells| cells * built);
        if let Some(deciding) = spec.deciding() {
            let decider = count(&Config { decide: 0, ..deciding.config })?;
            all = [0, 1].map(|kind| all[kind] + u64::from(config.decide) * decider[kind]);
        }
        (self.luts, self.dsps) = (Some(one[0]), Some(one[1]));
        if config.input == Input::Spheres {
            // The search is no SCPU: `afu synth --input spheres` counts the whole.
            return Ok(());
        }
        (self.luts_of_all, self.dsps_of_all) = (Some(all[0]), Some(all[1]));
        Ok(())
    }

    /// Bytes over the link, in both directions, for so many pairs or spheres that are `sent`, with this number of
    /// contacts.
    pub fn bytes(&self, sent: u64, contacts: u64) -> f64 {
        let back = if self.returns_misses { sent } else { contacts };
        self.bytes_sent * sent as f64 + self.bytes_returned * back as f64
    }
}

/// The profile with the fewest fraction bits whose error in depth is at most `bound`, relative to the largest
/// coordinate or radius of the pair.
///
/// A coordinate or radius is rounded once on its way in. No result includes more than sixteen roundings, each of half a
/// unit of a number that is at most a few times as large. A normal's error is this error divided by the distance, and a
/// position's error includes the normal's. For spheres that nearly coincide, only `exact` has the right direction.
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
    use crate::pairs::Set;
    use crate::query::{Fields, Flow, PairRecord, Query};

    /// Depths, and normals times the distance, keep the bound on pairs of many sizes, and the bound is not idle.
    #[test]
    fn an_error_bound_picks_a_format_that_keeps_it() {
        let pairs: Vec<PairRecord> = Set::Random(20_000).pairs(3).into_iter().filter(ordinary).collect();
        assert!(pairs.len() > 5_000, "{}", pairs.len());
        for bound in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
            let profile = narrowest(bound);
            let (narrow, right) = (profile.reference(Fields::ALL), Profile::EXACT.reference(Fields::ALL));
            let mut worst: f64 = 0.0;
            for ((found, right), pair) in narrow.settled(&pairs).0.iter().zip(&right.settled(&pairs).0).zip(&pairs) {
                if found.flow() != Some(Flow::Real) || right.flow() != Some(Flow::Real) {
                    continue;
                }
                let share = distance(pair) / size(pair);
                let depth = (f64::from(found.depth()) - f64::from(right.depth())).abs() / size(pair);
                let normals = found.normal().into_iter().zip(right.normal());
                let normals = normals.map(|(a, b)| (f64::from(a) - f64::from(b)).abs() * share);
                worst = normals.fold(worst.max(depth), f64::max);
            }
            assert!(worst <= bound, "{bound}: {profile} errs by {worst}");
            assert!(worst >= bound / 100.0, "{bound}: {profile} errs by {worst} alone");
        }
        assert!(narrowest(1e-9).is_exact());
    }

    fn size(pair: &PairRecord) -> f64 {
        pair.values().iter().fold(0.0_f64, |size, value| size.max(f64::from(value.abs())))
    }

    fn distance(pair: &PairRecord) -> f64 {
        let v = pair.values().map(f64::from);
        (0..3).map(|axis| (v[axis] - v[axis + 4]).powi(2)).sum::<f64>().sqrt()
    }

    /// True if no number is near the ends of binary32.
    fn ordinary(pair: &PairRecord) -> bool {
        pair.is_valid(Query::SphereSphere) && (1e-30..1e30).contains(&size(pair))
    }
}
