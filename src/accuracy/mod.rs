//! How right answers are: engines and profiles on the same pairs, judged against the truth, in one store of results.
//!
//! A [`Contender`] answers pairs; [`judge`] says what is wrong with an answer; [`fill`] runs contenders over the hard
//! categories and keeps what came of them in a [`Record`], keyed by what went in.

mod answer;
mod contender;
mod formula;
mod judge;
#[cfg(feature = "ode")]
mod ode;
#[cfg(feature = "parry")]
mod parry;
mod record;
mod study;
mod tally;

pub use answer::Answer;
pub use contender::{Contender, Contenders, Profiled, contenders};
pub use formula::Formula;
pub use judge::{Judgement, Standard, judge};
#[cfg(feature = "ode")]
pub use ode::OdeDouble;
#[cfg(feature = "parry")]
pub use parry::Parry;
pub use record::{Record, RecordError, Row, SCHEMA};
pub use study::{StudyError, Task, fill};
pub use tally::Tally;
