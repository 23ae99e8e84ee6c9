//! Models of a target's primitives.

/// The models, and what makes the generated files take them: goes before those.
pub fn primitives() -> String {
    let models = concat!(
        include_str!("../../tb/mult18x18d.v"),
        include_str!("../../tb/ccu2c.v"),
        include_str!("../../tb/dp16kd.v")
    );
    format!("`define SYNTHESIS\n{models}")
}
