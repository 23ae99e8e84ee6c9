//! The part of a design that is instantiated many times, compiled once.
//!
//! Left alone, Verilator flattens every instance into the top and writes its C++ again. Sixteen units are 40 MB, which
//! take minutes to compile and exceed every cache when they run. There are two ways out, with figures in
//! `docs/cosim.md`. Without a waveform, the module [`BLOCK`] becomes a library of its own (`--lib-create`), which the
//! rest of the design calls for each instance. Its objects are cached separately, so another number of instances
//! compiles only the rest. A waveform does not reach into a library. In a traced design, the module [`SHARED`] is not
//! flattened, so its instances share most of their functions.

use std::fs;
use std::path::{Path, PathBuf};

use super::compile::{self, Classes, Compiler};
use super::{Design, Error, File, RECIPE, Tool, Trace, cache, key_of, rtl_sha256, run_verilator};

/// The module: one processing unit of the AFU.
const BLOCK: &str = "scpu";
/// The module that is kept separate in a traced design. It surrounds the block, with a register before each of its
/// inputs. (Logic that reads a module's input directly is named after the instance, and is not shared.)
const SHARED: &str = "scpu_slot";
/// A configuration for Verilator beside the folder `rtl`, because generated Verilog carries no pragmas.
pub(super) const CONFIG_NAME: &str = "shared.vlt";
/// The class Verilator makes of the block.
const PREFIX: &str = "Vblock";

/// A compiled block.
pub(super) struct Block {
    /// The wrapper that replaces the block's own file in the rest of the design.
    pub wrapper: File,
    /// The objects of the block.
    pub objects: Vec<PathBuf>,
    /// The parts of Verilator's runtime that the block needs.
    pub runtime: Vec<String>,
}

/// Builds the block of `design`, or finds it in `cache`. `None` if the design has no block, or is traced.
pub(super) fn build(design: &Design, tool: &Tool, compiler: &Compiler, cache: &Path) -> Result<Option<Block>, Error> {
    let file_name = format!("{BLOCK}.v");
    let has_block = design.files.iter().any(|file| file.name == file_name);
    if !has_block || design.top == BLOCK || design.trace != Trace::Off {
        return Ok(None);
    }
    let arguments = arguments(design);
    let rtl = rtl_sha256(design.files);
    let parts = [RECIPE, "block", tool.sha256(), compiler.identity(), &rtl, &arguments.join(" ")];
    let folder = cache::once(cache, &key_of(&parts), |aside| {
        let generated = aside.join("cpp");
        run_verilator(design, tool, aside, &generated, &arguments)?;
        let mut classes = Classes::read(&generated.join(format!("{PREFIX}_classes.mk")))?;
        classes.fast.push(BLOCK.to_owned());
        compiler.compile_model(&classes, "", &compile::model_flags(tool, Trace::Off), [&generated, aside])?;
        let wrapper = format!("{BLOCK}.sv");
        fs::copy(generated.join(&wrapper), aside.join(&wrapper)).map_err(|e| Error::io("read", &generated, e))?;
        super::write(&aside.join("runtime"), &classes.runtime.join("\n"))?;
        for folder in [generated, aside.join("rtl")] {
            fs::remove_dir_all(&folder).map_err(|e| Error::io("remove", &folder, e))?;
        }
        Ok(())
    })?;
    let read = |name: &str| {
        let path = folder.join(name);
        fs::read_to_string(&path).map_err(|e| Error::io("read", &path, e))
    };
    let wrapper = File { name: file_name.replace(".v", ".sv"), text: read(&format!("{BLOCK}.sv"))? };
    let runtime = read("runtime")?.lines().map(str::to_owned).collect();
    Ok(Some(Block { wrapper, objects: cache::files_in(&folder, "o")?, runtime }))
}

/// The files of the rest of the design, with the wrapper in place of the block.
pub(super) fn rest(design: &Design, block: &Block) -> Vec<File> {
    let of = |file: &File| if file.name == format!("{BLOCK}.v") { block.wrapper.clone() } else { file.clone() };
    design.files.iter().map(of).collect()
}

/// The text of [`CONFIG_NAME`].
pub(super) fn config() -> String {
    format!("`verilator_config\nno_inline -module \"{SHARED}\"\n")
}

/// Arguments that let the instances of [`SHARED`] share their code in a traced design. The data-flow optimiser, which
/// -O3 turns on, would name intermediate values after the instance.
pub(super) fn shared_arguments(design: &Design) -> Vec<String> {
    let has = design.files.iter().any(|file| file.name == format!("{SHARED}.v"));
    if !has || design.trace == Trace::Off {
        return Vec::new();
    }
    vec!["-fno-dfg".to_owned(), format!("../{CONFIG_NAME}")]
}

fn arguments(design: &Design) -> Vec<String> {
    let mut arguments: Vec<String> = super::FIXED_ARGUMENTS.map(str::to_owned).to_vec();
    let own = ["--prefix", PREFIX, "--top-module", BLOCK, "--lib-create", BLOCK];
    arguments.extend(own.map(str::to_owned));
    arguments.extend(design.files.iter().map(|file| file.name.clone()));
    arguments
}
