//! What hardware costs on an FPGA, measured: Yosys counts its cells, nextpnr places and routes it.
//!
//! A [`Unit`] (an operator, an SCPU, a whole AFU) is put into a [`wrapper`] of registers and scan chains, so that it
//! needs a handful of pins and every path that counts runs from register to register. The wrapper's own cells are
//! counted with the unit as a black box, and subtracted. The clock is the median over the seeds of the placer.

mod cells;
mod error;
mod figures;
pub mod fit;
mod floorplan;
mod names;
mod placer;
mod request;
mod route;
mod run;
mod target;
mod trimmed;
mod unit;
pub mod wrapper;
mod yosys;

pub use cells::Area;
pub use error::SynthError;
pub use figures::{Figures, Hop, SCHEMA, Seed, Tools};
pub use placer::{Placer, PlacerError};
pub use request::Request;
pub use run::{Options, synthesise};
pub use target::Target;
pub use trimmed::Trimmed;
pub use unit::Unit;
