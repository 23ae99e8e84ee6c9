//! ODE's C interface as its installed headers have it. Nothing outside this folder sees it.

#![allow(non_camel_case_types, non_snake_case, non_upper_case_globals, dead_code, clippy::all)]

include!(concat!(env!("OUT_DIR"), "/ode.rs"));
