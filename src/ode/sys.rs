//! ODE's C interface, from its installed headers. It is used only in this folder.

#![allow(non_camel_case_types, non_snake_case, non_upper_case_globals, dead_code, clippy::all)]

include!(concat!(env!("OUT_DIR"), "/ode.rs"));
