//! What stands around the core: [`spl2`], or nothing.

pub mod spl2;
