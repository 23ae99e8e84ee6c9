//! What people and other programs read: tables, JSON, JUnit, and folders that are there whole or not at all.

pub mod folder;
pub mod manifest;
