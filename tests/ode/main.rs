//! The crate beside the real ODE: its answers, its engines, its world, and scenes that run for long.
#![cfg(feature = "ode")]

#[cfg(feature = "cosim")]
mod afu;
mod benchmark;
mod engine;
mod stability;
mod world;
