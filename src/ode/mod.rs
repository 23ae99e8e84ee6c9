//! The real [Open Dynamics Engine](http://www.ode.org), in double precision: worlds of spheres, its collision of two
//! spheres, and an [`Engine`](crate::kernel::Engine) (a kernel in software, an AFU) that replaces this collision.
//!
//! An [`Ode`] is the started library, and a [`World`] holds spheres. A step of a simulation is: [`World::add_force`],
//! then [`World::contacts`], [`World::contacts_by`] with an engine, or [`World::contacts_in`] with a space of its own,
//! [`World::join`] for each contact,
//! [`World::step`]. [`Diamond`] is the paper's simulation, and [`Benchmark`] the paper's measurement in it.
//!
//! # Licence
//!
//! ODE is offered under the LGPL or a BSD-style licence. This crate uses it under the BSD-style licence: it declares
//! what ODE's installed headers declare, links the installed library and contains none of its code.
//!
//! > Open Dynamics Engine, Copyright (c) 2001-2007, Russell L. Smith. All rights reserved.
//!
//! If you redistribute a program built with this feature, include this notice and the licence's conditions and
//! disclaimer (ODE's `LICENSE-BSD.TXT`; on Debian `/usr/share/doc/libode8/copyright`).

mod benchmark;
mod by_engine;
mod contact;
mod dcollide;
mod diamond;
mod effects;
mod error;
mod library;
mod motion;
mod numbers;
mod replace;
mod space;
mod sphere_pair;
mod sys;
mod world;

pub use benchmark::{Benchmark, Collision, Figures, Recording, Timing};
pub use contact::{Contact, Surface, Touch};
pub use diamond::{Diamond, Simulation};
pub use effects::{Sleep, WallTouch};
pub use error::Error;
pub use library::{Collider, Ode};
pub use motion::Motion;
pub use space::SearchSpace;
pub use sphere_pair::SpherePair;
pub use world::{BroadPhase, Sphere, World};
