//! Checks whether a run's energy rose by more than its effects can explain.

use serde::Serialize;

/// The energy of a run at its start and end, kinetic and in the field of gravity, and the energy that it may have
/// gained.
///
/// Of all effects, only the pull adds energy, and its work is summed over the steps. Damping, friction, sleep and a
/// bounce of up to 1 remove or keep energy, and gravity only converts it. Three errors are allowed for. A step in which
/// a body turns around in the field of gravity moves it too far by the way of one step. Bodies that lie on each other
/// sink in and are lifted. Contacts have the plan's arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Balance {
    /// The energy before the first step.
    pub start: f64,
    /// The energy after the last step.
    pub end: f64,
    /// The work of the pull.
    pub work: f64,
    /// The energy that these errors may have added.
    pub allowance: f64,
}

impl Balance {
    /// The energy that nothing in the scene accounts for; `None` if there is none.
    pub fn excess(&self) -> Option<f64> {
        let excess = self.end - self.start - self.work.max(0.0) - self.allowance;
        (excess > 0.0).then_some(excess)
    }

    /// The warning at the end of a run that gained unexplained energy.
    pub fn warning(&self) -> Option<String> {
        self.excess()?;
        let Self { start, end, work, .. } = *self;
        Some(format!(
            "energy rose from {start:.4} to {end:.4}, of which pulls account for {work:.4}: bodies that overlap are pushed \
             apart, so begin with them apart or take a smaller time_step"
        ))
    }
}
