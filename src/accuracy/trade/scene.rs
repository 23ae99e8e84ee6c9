//! The effect of an arithmetic on a scene: the distance of the diamond's spheres from their places in `f64`, after some
//! steps.

use serde::{Deserialize, Serialize};

/// Steps of the simulation.
pub const STEPS: usize = 300;
/// Layers of the diamond, the paper's hMax.
pub const LAYERS: u32 = 3;
/// The gap between its spheres, the paper's dSph. Without a gap, they stay where every number is exact.
pub const GAP: f64 = 0.05;

/// The distance of the diamond's spheres, after [`STEPS`] steps, from their places with ODE's own collider in `f64`, in
/// radii. The scene is chaotic: errors grow, and in the end two paths have nothing in common.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drift {
    /// The mean over the spheres.
    pub mean: f64,
    /// The largest.
    pub largest: f64,
}

/// Why this program cannot measure the drift.
#[cfg(not(feature = "ode"))]
pub(super) const ABSENT: &str =
    "where the diamond's spheres are after 300 steps: this program has no ODE; build it with --features ode";

#[cfg(feature = "ode")]
pub(super) use with_ode::Scene;

#[cfg(feature = "ode")]
mod with_ode {
    use super::{Drift, GAP, LAYERS, STEPS};
    use crate::kernel::Engine;
    use crate::ode::{Collider, Diamond, Error, Ode, Simulation};

    /// The scene in `f64`.
    pub struct Scene {
        exact: Vec<[f64; 3]>,
    }

    impl Scene {
        /// Simulates the scene with ODE's own collider.
        pub fn new() -> Result<Self, Error> {
            let ode = Ode::start(Collider::Own)?;
            let mut simulation = diamond().build(&ode)?;
            while simulation.steps() < STEPS {
                let touches = simulation.world().contacts()?;
                simulation.advance(&touches)?;
            }
            Ok(Self { exact: positions(&simulation) })
        }

        /// The drift that an engine's contacts cause; `None` if the engine gives a record that is not a contact.
        pub fn drift(&self, engine: &mut dyn Engine) -> Result<Option<Drift>, Error> {
            let ode = Ode::start(Collider::Engine)?;
            let diamond = diamond();
            let mut simulation = diamond.build(&ode)?;
            while simulation.steps() < STEPS {
                let touches = match simulation.world().contacts_by(engine) {
                    Err(Error::Contact { .. } | Error::Flags { .. }) => return Ok(None),
                    found => found?,
                };
                simulation.advance(&touches)?;
            }
            let apart = |(a, b): (&[f64; 3], &[f64; 3])| {
                let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
                squares.sqrt() / diamond.radius
            };
            let found = positions(&simulation);
            let distances: Vec<f64> = found.iter().zip(&self.exact).map(apart).collect();
            let mean = distances.iter().sum::<f64>() / distances.len().max(1) as f64;
            Ok(Some(Drift { mean, largest: distances.into_iter().fold(0.0, f64::max) }))
        }
    }

    fn diamond() -> Diamond {
        Diamond::new(LAYERS, GAP)
    }

    fn positions(simulation: &Simulation) -> Vec<[f64; 3]> {
        simulation.positions().collect()
    }

    #[cfg(test)]
    mod tests {
        use super::*;
        use crate::config::Profile;
        use crate::kernel::{EngineError, Truth};
        use crate::query::{ContactRecord, Fields, PairRecord};

        /// The truth in place of the collider. Only the rounding of records differs.
        struct True;

        impl Engine for True {
            fn contacts(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
                Ok(pairs.iter().map(|pair| Truth::of(pair).record()).collect())
            }
        }

        #[test]
        fn a_coarse_arithmetic_leads_elsewhere() {
            let scene = Scene::new().expect("ODE");
            let profile = |name: &str| name.parse::<Profile>().expect("a profile").reference(Fields::ALL);
            let drift = |engine: &mut dyn Engine| scene.drift(engine).expect("ODE").expect("contacts");
            let truth = drift(&mut True);
            let (wide, bfloat) = (drift(&mut profile("wide")), drift(&mut profile("bfloat")));
            assert!(truth.mean > 0.0 && truth.mean <= truth.largest, "records are binary32: {truth:?}");
            assert!(bfloat.mean > 1e-3 && wide.largest.is_finite(), "{wide:?} {bfloat:?}");
        }
    }
}
