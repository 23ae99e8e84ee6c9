//! The contact of two spheres, written once for every [`Number`](crate::number::Number): the reference kernel, its
//! exact twins and the netlist are readings of [`contact`]. Records are what memory holds.

pub mod batch;
mod contact;
pub mod double;
mod engine;
mod exact;
mod fields;
mod memory;
mod record;
mod reference;
mod settle;
mod truth;

pub use contact::{Contact, Pair, contact};
pub use engine::{Engine, EngineError};
pub use exact::{Filtered, exact};
pub use fields::{Fields, FieldsError};
pub use memory::{narrow, widen};
pub use record::{ContactRecord, Flow, PAIR_FIELDS, PairRecord};
pub use reference::{Arithmetic, Reference};
pub use settle::settle;
pub use truth::{Truth, UlpErrors, ulp};
