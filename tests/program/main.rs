//! The program `afu`: its outputs, files and errors, its pages in a browser, and the documents that quote it.

#[cfg(feature = "cosim")]
mod accuracy_page;
#[cfg(any(feature = "cosim", feature = "ode"))]
#[path = "../support/browser.rs"]
mod browser;
mod cli;
#[cfg(feature = "cosim")]
mod cli_accuracy;
#[cfg(feature = "cosim")]
mod cli_choose;
#[cfg(feature = "cosim")]
mod cli_cosim;
mod cli_files;
mod cli_hard;
mod cli_merge;
#[cfg(feature = "cosim")]
mod cli_paper;
mod cli_rtl;
#[cfg(feature = "cosim")]
mod cli_spheres;
mod cli_sweep;
#[cfg(feature = "cosim")]
mod documented;
#[cfg(feature = "cosim")]
mod numpy;
mod scene;
