//! Modules, operators and pipelines: in the evaluator, as Verilog, and in Yosys.

mod hdl_cut;
mod hdl_delays;
mod hdl_errors;
mod hdl_evaluate;
mod hdl_random;
mod interval;
mod iterative_roots;
mod operators;
#[cfg(feature = "cosim")]
mod operators_verilated;
mod pipeline;
#[cfg(feature = "cosim")]
#[path = "../support/primitives.rs"]
mod primitives;
#[path = "../support/recipe.rs"]
mod recipe;
mod sphere_kernel;
#[path = "../support/mod.rs"]
mod support;
mod synth;
mod verilog;
