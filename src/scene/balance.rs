//! Whether a run's energy rose by more than its effects can give.

use serde::Serialize;

/// The energy of a run at its ends, kinetic and in the field of gravity, and what it may have gained.
///
/// Of all effects the pull alone gives energy: its work is summed over the steps. Damping, friction, sleep and a bounce
/// of up to 1 take it or keep it, and gravity only moves it between the two kinds. Three roundings are allowed for: a
/// step in which a body turns around in the field of gravity moves it by a step's way too far, bodies that lie on each
/// other sink in and are lifted, and contacts come in the plan's arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Balance {
    /// Before the first step.
    pub start: f64,
    /// After the last.
    pub end: f64,
    /// The work of the pull.
    pub work: f64,
    /// What roundings may have added.
    pub allowance: f64,
}

impl Balance {
    /// The energy that nothing in the scene accounts for; `None` if there is none.
    pub fn excess(&self) -> Option<f64> {
        let excess = self.end - self.start - self.work.max(0.0) - self.allowance;
        (excess > 0.0).then_some(excess)
    }

    /// What to say at the end of a run that gained energy from nowhere.
    pub fn warning(&self) -> Option<String> {
        self.excess()?;
        let Self { start, end, work, .. } = *self;
        Some(format!(
            "energy rose from {start:.4} to {end:.4}, of which pulls account for {work:.4}: bodies that overlap are pushed \
             apart, so begin with them apart or take a smaller time_step"
        ))
    }
}
