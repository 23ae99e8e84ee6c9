//! The accuracy of answers: engines and profiles on the same pairs, judged against the truth.
//!
//! A [`Contender`] answers pairs, and [`judge`] finds the errors of an answer. [`measure`] does this for contenders on
//! a set of pairs and makes a [`Row`] of each, which it keeps in a [`Store`](crate::store::Store). [`fill`] does it for
//! the hard categories, and makes [`HardResults`] of them.

mod answer;
mod contender;
mod formula;
mod judge;
mod matrix;
mod measure;
#[cfg(feature = "ode")]
mod ode;
#[cfg(feature = "parry")]
mod parry;
mod results;
mod spread;
mod study;
mod tally;
#[cfg(feature = "cosim")]
pub mod trade;

pub use answer::Answer;
pub use contender::{Contender, Contenders, Profiled, contenders};
pub use formula::Formula;
pub use judge::{Judgement, Standard, judge};
pub use measure::{ContenderError, assess, measure};
#[cfg(feature = "ode")]
pub use ode::OdeDouble;
#[cfg(feature = "parry")]
pub use parry::Parry;
pub use results::{HardResults, Row, SCHEMA};
pub use spread::{ErrorStatistics, Spread};
pub use study::{StudyError, Task, fill};
pub use tally::Tally;
