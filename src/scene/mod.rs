//! Scenes: bodies, the effects on them and the wanted results, from which follows what must be built and run.
//!
//! A [`Scene`] is read from TOML ([`Scene::read`]). Its [`Plan`] says for every effect, every field of a contact and
//! every part of the hardware whether it is on, and which lines call for it (see `demand::RULES`). A part that nothing
//! calls for costs nothing: it is not in the Verilog and not in a record, and its part of ODE is never called. `run`
//! then runs the scene with only the parts of the plan.

mod balance;
mod bodies;
mod choice;
mod cost;
mod demand;
mod detector;
#[cfg(feature = "ode")]
mod energy;
mod error;
mod file;
mod ladder;
mod page;
mod picture;
mod plan;
mod read;
mod results;
#[cfg(feature = "ode")]
mod run;
mod start;
mod still;
mod text;
mod viewer;

pub use balance::Balance;
pub use bodies::{Ball, balls};
pub use choice::{Choice, Considered, Pairs};
pub use cost::Cost;
pub use demand::{Demand, Part};
pub use detector::Detector;
pub use error::SceneError;
pub use file::{Effects, Given, Group, Pull, Scene, Shape, Start, Want};
pub use ladder::ladder;
pub use page::page;
pub use plan::{Call, Plan, Row};
pub use results::{Energy, Meeting, SCHEMA, SceneRun, Summary, Touching};
#[cfg(feature = "ode")]
pub use run::run;
pub use start::check_start;
pub use still::{Still, query};
pub use text::costs;
