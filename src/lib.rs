//! Generates, simulates and checks the Verilog of a collision-detection accelerator.
//!
//! A [`Config`] describes the AFU: how many SCPUs, which arithmetic, which clock. [`afu::Afu`] generates its Verilog:
//!
//! ```
//! use contact_afu::Config;
//! use contact_afu::afu::{Afu, Spec};
//!
//! let config = Config { scpus: 1, contact: "hit".parse()?, ..Config::default() };
//! let afu = Afu::generate(Spec::from(config))?;
//! assert!(afu.files().iter().any(|(name, _)| name == "afu_top.v"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! With the feature `cosim`, `Bench` simulates the AFU: pairs of spheres ([`PairRecord`]) go through it over a link
//! ([`LinkModel`]). `Bench` compares every bit of the contacts ([`ContactRecord`]) with the reference kernel. A test in
//! another crate, which needs Verilator and a C++ compiler:
//!
#![cfg_attr(feature = "cosim", doc = "```no_run")]
#![cfg_attr(not(feature = "cosim"), doc = "```ignore")]
#![doc = include_str!("../examples/verify.rs")]
//! ```
//!
//! # Features
//!
//! | feature | default | what it adds | what it needs |
//! |---|---|---|---|
//! | `cli` | yes | the program `afu` | clap, clap_complete, indicatif, anyhow |
//! | `cosim` | yes | simulation: `verify`, `cosim`, `sweep` | Verilator, a C++ compiler, libclang |
//! | `ode` | no | `ode`: the Open Dynamics Engine; with `cosim`, `paper` | libode in double precision, libclang |
//! | `parry` | no | parry3d beside the other engines in `accuracy` | parry3d |
//!
//! A library should use `default-features = false, features = ["cosim"]`. Without any feature the crate is pure Rust
//! and needs no tool.
//!
//! `ARCHITECTURE.md` describes the modules and which of them may import which.
#![warn(missing_docs)]

pub mod accuracy;
pub mod afu;
pub mod config;
#[cfg(feature = "cosim")]
pub mod cosim;
mod count;
pub mod files;
pub mod hdl;
pub mod host;
pub mod kernel;
pub mod link;
pub mod number;
#[cfg(feature = "ode")]
pub mod ode;
pub mod operator;
pub mod outcome;
pub mod pairs;
#[cfg(all(feature = "cosim", feature = "ode"))]
pub mod paper;
pub mod patience;
pub mod pipeline;
pub mod plot;
pub mod query;
pub mod record;
pub mod report;
pub mod scene;
pub mod spheres;
pub mod store;
pub mod study;
#[cfg(feature = "cosim")]
pub mod sweep;
pub mod synth;
pub mod tools;
#[cfg(feature = "cosim")]
pub mod verify;

pub use config::Config;
pub use link::LinkModel;
pub use query::{ContactRecord, PairRecord};
#[cfg(feature = "cosim")]
pub use verify::{Bench, Verdict, VerifyError};
