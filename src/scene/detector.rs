//! Who computes a scene's contacts, and what it is sent.

use crate::kernel::Engine;
use crate::spheres::Finder;

/// Computes a scene's contacts.
pub enum Detector<'a> {
    /// Is sent the pairs that could touch.
    Pairs(&'a mut dyn Engine),
    /// Is sent the spheres, and finds what touches.
    Spheres(&'a mut dyn Finder),
}
