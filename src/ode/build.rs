//! The feature `ode`: makes Rust declarations of the installed Open Dynamics Engine, and links it.
//!
//! Unlike a missing Verilator, a missing ODE fails the build, because the feature needs the library.

use std::env;
use std::fmt::Write as _;
use std::fs;
use std::panic;
use std::path::{Path, PathBuf};
use std::process::Command;

const INSTALL: &str =
    "install the Open Dynamics Engine with ./scripts/setup --ode (Debian: apt-get install libode-dev)";

/// The functions that src/ode calls.
const FUNCTIONS: &str = "
    dAllocateODEDataForThread dBodyAddForce dBodyCreate dBodyGetAngularVel dBodyGetLinearVel dBodyGetMass
    dBodyGetPosition dBodyGetQuaternion dBodyIsEnabled dBodySetAngularVel dBodySetLinearVel dBodySetMass
    dBodySetMaxAngularSpeed dBodySetPosition dCheckConfiguration dCloseODE dCollide dCreatePlane dCreateSphere dGeomDestroy dGeomGetData
    dGeomPlaneSetParams dGeomSetBody dGeomSetData dGeomSetPosition dGeomSphereSetRadius dHashSpaceCreate
    dInitODE2 dJointAttach dJointCreateContact dJointGroupCreate dJointGroupDestroy dJointGroupEmpty
    dMassSetSphere dRandGetSeed dRandSetSeed dSetColliderOverride dSpaceCollide dSpaceDestroy
    dSweepAndPruneSpaceCreate dWorldCreate
    dWorldDestroy dWorldQuickStep dWorldSetAngularDampingThreshold dWorldSetAutoDisableAngularThreshold
    dWorldSetAutoDisableFlag dWorldSetAutoDisableLinearThreshold dWorldSetAutoDisableSteps
    dWorldSetAutoDisableTime dWorldSetCFM dWorldSetDamping dWorldSetERP dWorldSetGravity
    dWorldSetLinearDampingThreshold dWorldSetQuickStepNumIterations
";
const CONSTANTS: &[&str] = &["dContactBounce", "dSphereClass"];
/// The type of `dAllocateMaskAll`.
const FLAGS: &str = "dAllocateODEDataFlags";

/// Only what is used is included. Single precision is refused, because positions would have the wrong type.
const HEADER: &str = "\
#include <ode/common.h>
#ifndef dDOUBLE
#error this ODE is of single precision, and double precision is needed
#endif
#include <ode/odeinit.h>
#include <ode/contact.h>
#include <ode/objects.h>
#include <ode/collision.h>
#include <ode/collision_space.h>
#include <ode/mass.h>
#include <ode/misc.h>
";

pub fn main() {
    println!("cargo:rerun-if-changed=src/ode/build.rs");
    for name in ["AFU_ODE", "CC", "LIBCLANG_PATH"] {
        println!("cargo:rerun-if-env-changed={name}");
    }
    if let Err(why) = declare().and_then(|()| link()) {
        println!("cargo::error=feature `ode`: {why}");
    }
}

/// Folder of an ODE that the compiler does not find on its own; it has `include/ode` and `lib`.
fn prefix() -> Option<PathBuf> {
    env::var_os("AFU_ODE").map(PathBuf::from)
}

fn declare() -> Result<(), String> {
    let out = env::var_os("OUT_DIR").map(PathBuf::from).ok_or("OUT_DIR is not set")?;
    let mut builder = bindgen::Builder::default()
        .header_contents("contact_afu_ode.h", HEADER)
        .rust_edition(bindgen::RustEdition::Edition2024)
        .generate_comments(false)
        .prepend_enum_name(false)
        .formatter(bindgen::Formatter::Prettyplease)
        .disable_header_comment();
    if let Some(prefix) = prefix() {
        builder = builder.clang_arg(format!("-I{}", prefix.join("include").display()));
    }
    builder = builder.allowlist_type(FLAGS);
    for name in FUNCTIONS.split_whitespace() {
        builder = builder.allowlist_function(name);
    }
    for name in CONSTANTS {
        builder = builder.allowlist_var(name);
    }
    // clang-sys panics where libclang is missing.
    let made = panic::catch_unwind(panic::AssertUnwindSafe(|| builder.generate()))
        .map_err(|_| "libclang is missing, which reads ODE's headers; ./scripts/setup installs it".to_owned())?;
    let text = made.map_err(|e| format!("ODE's headers: {}; {INSTALL}", one_line(&e.to_string())))?.to_string();
    // bindgen ignores names that are missing in the headers.
    let mut missing = String::new();
    for name in FUNCTIONS.split_whitespace() {
        if !text.contains(&format!("fn {name}(")) {
            let _ = write!(missing, " {name}");
        }
    }
    if !missing.is_empty() {
        return Err(format!("ODE's headers lack{missing}; ODE 0.16 has all of them; {INSTALL}"));
    }
    let to = out.join("ode.rs");
    fs::write(&to, text).map_err(|e| format!("cannot write {}: {e}", to.display()))
}

/// Links libode after checking that it exists, because a linker's own message would not name a command.
fn link() -> Result<(), String> {
    if let Some(prefix) = prefix() {
        let folder = prefix.join("lib");
        if !["libode.so", "libode.dylib"].iter().any(|name| folder.join(name).is_file()) {
            return Err(format!("no libode in {} (AFU_ODE names the folder above it)", folder.display()));
        }
        println!("cargo:rustc-link-search=native={}", folder.display());
    } else if !linker_finds("libode.so") {
        return Err(format!("libode is missing; {INSTALL}"));
    }
    println!("cargo:rustc-link-lib=dylib=ode");
    Ok(())
}

/// True if the linker of the C compiler finds a library, or if the compiler cannot be asked.
fn linker_finds(library: &str) -> bool {
    let compiler = env::var_os("CC").unwrap_or_else(|| "cc".into());
    let Ok(answer) = Command::new(compiler).arg(format!("-print-file-name={library}")).output() else { return true };
    // The compiler repeats the bare name if it does not find the library.
    let answer = String::from_utf8_lossy(&answer.stdout);
    !answer.trim().is_empty() && Path::new(answer.trim()) != Path::new(library)
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
