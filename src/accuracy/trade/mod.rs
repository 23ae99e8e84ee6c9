//! What accuracy costs: configurations with their errors, their time and their area.
//!
//! A [`Point`] is a configuration with all its measurements. [`run`] measures a [`Plan`]: errors against the truth on
//! named sets of pairs ([`measure`](super::measure)), cycles by co-simulation, area and clock by synthesis. Every
//! measurement is stored under the hash of its inputs, so that an interrupted study can resume.

mod axes;
mod choose;
mod columns;
mod cost;
mod front;
mod output;
mod page;
mod picture;
mod plan;
mod point;
mod results;
mod run;
mod scene;
mod software;
mod stages;
mod table;

pub use axes::name;
pub use choose::{Bound, Bounds, Instead, choose, to_build};
pub use cost::{Cycles, Hardware, cycles};
pub use front::{Time, front, step};
pub use output::write;
pub use page::{page, steps};
pub use picture::picture;
pub use plan::{Named, Plan, Request, Size};
pub use point::{Counted, Point};
pub use results::{SCHEMA, SetFigures, Study, committed};
pub use run::{Ended, TradeError, prepare, run};
pub use scene::{Drift, GAP, LAYERS, STEPS};
pub use table::table;
