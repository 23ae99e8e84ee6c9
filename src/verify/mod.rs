//! Sends pairs through a simulated AFU, and compares every bit of the result with the reference kernel.

mod account;
mod bench;
mod check;
pub mod corpus;
mod engine;
mod error;
mod finder;
mod mismatch;
mod replay;
mod spheres;

pub use account::{Part, account};
pub use bench::{Bench, Origin, Progress, rtl_sha256};
pub use check::Verdict;
pub use engine::{BenchEngine, Disagreement, Totals};
pub use error::VerifyError;
pub use finder::{BenchFinder, Unlike};
pub use mismatch::Mismatch;
pub use replay::{Command, Setup};
pub use spheres::SpheresVerdict;
