//! Spheres in, contacts out: finds every pair of spheres that touch, without being given pairs.
//!
//! Spheres stand in rows of 16, in the order in which they came. Each sphere has a box of integers that preserve order
//! ([`Bounds`]), each row and each 16 rows have the box around theirs. Boxes are compared from the largest to the
//! smallest ([`Search`]), and the kernel decides the pairs whose boxes meet.
//!
//! No contact is lost: a box is wide enough for every pair that the arithmetic calls a contact ([`BoundsRule`]). The
//! order of the spheres changes the time and never the set that is found; [`hilbert_order`] gives a good one.

mod bounds;
mod file;
mod finder;
mod lanes;
mod order;
mod rows;
mod search;
mod set;
mod sphere;
mod tiles;
mod trace;

pub use bounds::{BOX_BITS, Bounds, BoundsRule, RefusedArithmetic};
pub use file::{LoadError, load, read_spheres, write_hits, write_spheres};
pub use finder::{Decided, Finder};
pub use order::{hilbert_order, reorder};
pub use rows::{ROW, Rows};
pub use search::{Candidates, Counts, Found, Hit, Search};
pub use set::{SphereSet, SphereSetError, Spheres};
pub use sphere::Sphere;
pub use tiles::{Tile, TileSizeError, join_tiles, tiles};
pub(crate) use trace::{GroupTrace, MemberTrace, RowTrace};
