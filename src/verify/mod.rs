//! Pairs through a simulated AFU, and every bit of what comes back compared with the reference kernel.

mod account;
mod bench;
mod check;
pub mod corpus;
mod engine;
mod error;

pub use account::{Part, account};
pub use bench::{Bench, Origin, Progress, rtl_sha256};
pub use check::{Mismatch, Verdict};
pub use engine::{BenchEngine, Differs, Totals};
pub use error::VerifyError;
