//! Simulation models of a target's primitives.

/// The models, preceded by the macro that makes the generated files instantiate them. Must come before those files.
pub fn primitives() -> String {
    let models = concat!(
        include_str!("../../tb/mult18x18d.v"),
        include_str!("../../tb/ccu2c.v"),
        include_str!("../../tb/dp16kd.v")
    );
    format!("`define SYNTHESIS\n{models}")
}
