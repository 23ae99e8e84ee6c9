//! The shell `axi` as a whole: the Verilated `contact_afu_axi` between a memory behind AXI4 and a host's AXI4-Lite
//! master. Every destination word is compared with the reference kernel, at any timing of all ten channels, and after
//! resets, aborts, error responses and lost responses. Every cycle is checked against the rules of both buses.
#![cfg(feature = "cosim")]

mod bench;
mod faults;
mod hardware;
mod header;
mod matrix;
mod places;
mod recovery;
mod registers;
mod sequence;
mod spheres;
mod stopped;
