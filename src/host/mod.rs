//! The host's side of an AFU below SPL2: memory that both see, and transactions whose steps cannot be confused.
//!
//! A [`Session`] has a device, by its [`Transport`], and a [`Workspace`]. It gives [`Transaction`]s, whose types are
//! the paper's seven steps. A device is the Verilated AFU ([`Machine`](crate::cosim::spl2::Machine)) or a model of it
//! in software ([`Software`]), which answer alike, byte for byte; or it is on a board, behind a [`Device`]. A session
//! is also an [`Engine`](crate::kernel::Engine): a batch is one transaction, or several where the buffers hold fewer
//! pairs.

#[cfg(feature = "cosim")]
mod behind_axi;
mod engine;
mod error;
mod handshake;
mod hardware;
mod open;
pub(crate) mod received;
mod report;
mod results;
mod session;
#[cfg(feature = "cosim")]
pub(crate) mod simulated;
mod software;
pub(crate) mod spheres;
mod task;
mod tiles;
mod transaction;
mod transport;
#[cfg(feature = "cosim")]
mod verilated;
mod workspace;

pub use error::{HitError, HostError};
pub use handshake::Protocol;
pub use hardware::{Device, Hardware};
pub use report::Report;
pub use results::JobResults;
pub use session::{Expected, Session};
pub use software::Software;
pub use spheres::{SpheresJob, SpheresResults};
pub use tiles::TiledResults;
pub use transaction::{Done, Loaded, PairsJob, Pointed, Retrieved, Running, Started, Transaction};
pub use transport::{Transport, TransportError};
pub use workspace::Workspace;
