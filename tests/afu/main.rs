//! The Verilated AFU as a whole, against the reference kernel: every destination word, over every link, for every kind
//! of record; speed; what happens after resets, aborts and faults of the link; and that faults planted in the Verilog
//! are found.
//!
//! Nearly all of the time is Verilator and the C++ compiler; models are cached, so a second run takes seconds.
#![cfg(feature = "cosim")]

mod bench;
mod blocks;
mod faults;
mod hits;
mod interval;
mod matrix;
mod ports;
#[path = "../support/primitives.rs"]
mod primitives;
mod records;
mod recovery;
mod speed;
mod spheres;
mod traces;
mod verilators;
