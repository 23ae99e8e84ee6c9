//! The shell `spl2` as a whole: the Verilated `afu_top` with the model of SPL2. Every destination word is compared with
//! the reference kernel, with any timing of SPL2 and the link, and after resets, aborts and lost responses.
#![cfg(feature = "cosim")]

mod bench;
mod faults;
mod matrix;
mod places;
mod recovery;
mod sequence;
mod spheres;
