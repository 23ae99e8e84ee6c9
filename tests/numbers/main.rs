//! Numbers, kernels and pairs: what arithmetic gives, against the truth. No hardware is built here.

mod accuracy;
mod batch;
mod exact;
mod faithful;
mod hard;
mod hard_properties;
mod kernel;
mod pair_files;
mod planes;
mod soft_formats;
mod soft_native;
#[path = "../support/mod.rs"]
mod support;
