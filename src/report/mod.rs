//! What people and other programs read: tables, JSON, JUnit, and folders that are there whole or not at all.

pub mod cosim;
pub mod doctor;
pub mod folder;
pub mod junit;
pub mod manifest;
pub mod mismatch;
pub mod table;
pub mod tally;
