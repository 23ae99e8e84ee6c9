//! Generates, simulates and proves the Verilog of a collision-detection accelerator.
//!
//! `ARCHITECTURE.md` is the map: which module does what and who may import whom.

pub mod accuracy;
pub mod afu;
pub mod config;
#[cfg(feature = "cosim")]
pub mod cosim;
pub mod files;
pub mod hdl;
pub mod host;
pub mod kernel;
pub mod link;
pub mod number;
#[cfg(feature = "ode")]
pub mod ode;
pub mod operator;
pub mod pairs;
#[cfg(feature = "cosim")]
pub mod paper;
pub mod patience;
pub mod pipeline;
pub mod plot;
pub mod report;
pub mod scene;
#[cfg(feature = "cosim")]
pub mod sweep;
pub mod synth;
pub mod tools;
#[cfg(feature = "cosim")]
pub mod verify;
