//! The shell `spl2` as a whole: the Verilated `afu_top` below the model of SPL2, every destination word against the
//! reference kernel, whatever SPL2 and the link may do, and what happens after resets, aborts and lost responses.
#![cfg(feature = "cosim")]

mod bench;
mod faults;
mod matrix;
mod places;
mod recovery;
mod sequence;
