//! Studies that several processes work on at once.
//!
//! A study has [`Point`]s, each with the [`Key`](crate::store::Key) of its measurement. A [`Worker`] measures those of
//! its [`Shard`] and keeps them in a [`Store`](crate::store::Store). While it works on a point it holds a claim, so
//! that no other process does the same work. A [`Record`] keeps what was asked for: whoever has the store alone can
//! make the results.

mod claim;
mod failure;
mod needs;
mod pass;
mod point;
mod record;
mod shard;
#[cfg(test)]
mod tests;
mod worker;

pub use failure::Failed;
pub use needs::{Needs, needs};
pub use point::{Point, PointError, State};
pub use record::Record;
pub use shard::Shard;
pub use worker::{News, Progress, Role, Worker};
