//! Links, link models, and Verilated AFUs of the library: built, driven, checked and measured.

#[cfg(feature = "cosim")]
mod accuracy_stage;
#[cfg(feature = "cosim")]
mod accuracy_study;
#[cfg(feature = "cosim")]
mod drive;
#[cfg(feature = "cosim")]
mod evaluated;
#[cfg(feature = "cosim")]
mod exact_afu;
#[cfg(feature = "cosim")]
mod host;
#[cfg(feature = "cosim")]
mod images;
mod link;
#[cfg(feature = "cosim")]
mod link_models;
#[cfg(feature = "cosim")]
mod models;
#[cfg(feature = "cosim")]
mod planes;
#[cfg(feature = "cosim")]
mod profiles;
#[cfg(feature = "cosim")]
mod verify;
