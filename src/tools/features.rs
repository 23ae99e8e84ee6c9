//! The parts of this program that a build may leave out.

use serde::Serialize;

/// A cargo feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Feature {
    /// The name.
    pub name: &'static str,
    /// True if it is part of this program.
    pub built_in: bool,
    /// The commands that need it.
    pub needed_for: &'static str,
}

/// All features.
pub(crate) const FEATURES: [Feature; 3] = [
    Feature {
        name: "cosim",
        built_in: cfg!(feature = "cosim"),
        needed_for: "afu cosim, sweep, accuracy, choose and paper, and afu scene on the simulated AFU",
    },
    Feature {
        name: "ode",
        built_in: cfg!(feature = "ode"),
        needed_for: "afu paper, afu scene where bodies move; afu hard and accuracy beside ODE",
    },
    Feature { name: "parry", built_in: cfg!(feature = "parry"), needed_for: "afu hard beside parry3d" },
];

/// The features that are built in and those that are not, in one line.
pub fn summary() -> String {
    let names = |built_in: bool| {
        let of = FEATURES.iter().filter(|feature| feature.built_in == built_in).map(|feature| feature.name);
        Some(of.collect::<Vec<_>>().join(", ")).filter(|names| !names.is_empty())
    };
    let absent = names(false).map(|names| format!("; not built in: {names}")).unwrap_or_default();
    format!("features: {}{absent}", names(true).unwrap_or_else(|| "none".to_owned()))
}
