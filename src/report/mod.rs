//! Output for people and other programs: tables, JSON, JUnit, and folders that appear whole or not at all.

#[cfg(feature = "cosim")]
pub mod cosim;
pub mod doctor;
pub mod folder;
pub mod intervals;
#[cfg(feature = "cosim")]
pub mod junit;
#[cfg(feature = "cosim")]
pub mod latency;
pub mod manifest;
pub mod operators;
pub mod page;
pub mod spheres_times;
pub mod synth;
pub mod synth_study;
pub mod table;
#[cfg(feature = "cosim")]
pub mod tally;
