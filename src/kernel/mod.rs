//! The contact mathematics, written once. Imports `number` only.

mod fields;

pub use fields::{Fields, FieldsError};
