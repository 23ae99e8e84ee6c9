//! Repeats the paper's experiment: collisions are recorded in ODE's diamond, timed on this machine, and sent through
//! the simulated AFU. The results are the paper's Figures 6 and 7, and an arithmetic check of its text.
//!
//! [`run`] runs a [`Plan`], and [`write`](write()) writes its results.

mod claims;
mod experiment;
mod figures;
mod measure;
mod output;
mod page;
mod published;
mod results;
mod simulate;
mod size;

pub use experiment::{PaperError, Plan, Work, run};
pub use output::write;
pub use results::{Experiment, Joined, Settings, Summary};
pub use simulate::SimulateError;
pub use size::Size;

use claims::{Claim, claims};
use figures::{figure6, figure7, per_collision};
use page::page;
use published::Published;
use results::{AfuPoint, OdePoint, SCHEMA};
