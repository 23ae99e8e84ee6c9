//! The paper's experiment, run again: collisions recorded in ODE's diamond, timed on this machine, and sent through the
//! simulated AFU; its Figures 6 and 7, and its text checked by arithmetic.
//!
//! [`measure`](measure::measure) needs ODE (feature `ode`); everything else does not.

mod claims;
mod figures;
#[cfg(feature = "ode")]
pub mod measure;
mod page;
mod published;
mod results;
mod simulate;
mod size;

pub use claims::{Claim, claims};
pub use figures::{figure6, figure7, per_collision};
pub use page::page;
pub use published::Published;
pub use results::{AfuPoint, Experiment, Joined, OdePoint, SCHEMA, Settings, Summary};
pub use simulate::{SimulateError, Simulated, Task, simulate};
pub use size::Size;
