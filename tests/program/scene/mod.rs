//! Scenes: the parts that their text requires, and that no other part is built or run.

mod bad;
mod lines;
#[cfg(feature = "ode")]
mod pages;
#[cfg(feature = "ode")]
mod physics;
mod plans;
mod program;

use std::path::{Path, PathBuf};

use contact_afu::scene::Scene;

pub const EXAMPLES: [&str; 5] = ["diamond", "billiards", "column", "touching", "gas"];

pub fn path(example: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/scenes/{example}.toml"))
}

pub fn scene(example: &str) -> Scene {
    Scene::read(&path(example)).expect("an example is a scene")
}
