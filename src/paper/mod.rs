//! The paper's experiment, run again: collisions recorded in ODE's diamond, timed on this machine, and sent through the
//! simulated AFU; its Figures 6 and 7, and its text checked by arithmetic.
//!
//! `run` carries out a `Plan`, for which it needs ODE (feature `ode`); everything else does not.

mod claims;
#[cfg(feature = "ode")]
mod experiment;
mod figures;
#[cfg(feature = "ode")]
mod measure;
mod output;
mod page;
mod published;
mod results;
mod simulate;
mod size;

pub use claims::{Claim, claims};
#[cfg(feature = "ode")]
pub use experiment::{PaperError, Plan, Work, run};
pub use figures::{figure6, figure7, per_collision};
pub use output::write;
pub use page::page;
pub use published::Published;
pub use results::{AfuPoint, Experiment, Joined, OdePoint, SCHEMA, Settings, Summary};
pub use simulate::{SimulateError, Task, simulate};
pub use size::Size;
