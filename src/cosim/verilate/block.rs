//! The part of a design that is there many times, compiled once.
//!
//! Left alone, Verilator flattens every instance into the top and writes its C++ anew: sixteen units are 40 MB, which
//! take minutes to compile and outrun every cache when they run. Two ways out, whose figures are in `docs/cosim.md`:
//! the module [`BLOCK`] becomes a library of its own (`--lib-create`), which the rest of the design calls for each
//! instance, and whose objects are cached apart, so that another number of instances compiles only the rest. A waveform
//! does not reach into a library; so in a traced design the module [`SHARED`] is kept from being flattened, whose
//! instances then share most of their functions.

use std::fs;
use std::path::{Path, PathBuf};

use super::compile::{self, Classes, Compiler};
use super::{Design, Error, File, RECIPE, Tool, Trace, cache, key_of, rtl_sha256, run_verilator};

/// The module: one processing unit of the AFU.
const BLOCK: &str = "scpu";
/// The module that is kept apart in a traced design: around the block, with a register before each of its inputs. (What
/// reaches the inputs of a module's logic directly is named after the instance, and nothing is shared.)
const SHARED: &str = "scpu_slot";
/// A configuration for Verilator beside the folder `rtl`: generated Verilog carries no pragmas.
pub(super) const CONFIG_NAME: &str = "shared.vlt";
/// The class Verilator makes of the block.
const PREFIX: &str = "Vblock";

/// A compiled block.
pub(super) struct Block {
    /// Stands for the block's own file in the rest of the design.
    pub wrapper: File,
    /// Its objects.
    pub objects: Vec<PathBuf>,
    /// What it needs of Verilator's runtime.
    pub runtime: Vec<String>,
}

/// Builds the block of `design`, or finds it in `cache`; nothing where the design has none, or is traced.
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
        classes.model.push(BLOCK.to_owned());
        let sources = compile::bundle(&generated, &classes.model, PREFIX, "")?;
        compiler.compile_all(&sources, &compile::model_flags(tool, Trace::Off), aside)?;
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

/// The files of the rest of the design: the wrapper in place of the block.
pub(super) fn rest(design: &Design, block: &Block) -> Vec<File> {
    let of = |file: &File| if file.name == format!("{BLOCK}.v") { block.wrapper.clone() } else { file.clone() };
    design.files.iter().map(of).collect()
}

/// What [`CONFIG_NAME`] says.
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
