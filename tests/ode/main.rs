//! The crate with the real ODE: its collider, engines in its place, its worlds, and long runs.
#![cfg(feature = "ode")]

#[cfg(feature = "cosim")]
mod afu;
mod benchmark;
mod engine;
mod stability;
mod world;
