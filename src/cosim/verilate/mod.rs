//! From Verilog to a compiled model: finds Verilator and a C++ compiler, runs them, and keeps the results.
//!
//! build.rs uses this folder too (by `#[path]`), so it uses only std, `cc` and a hash, and nothing of the crate.
//! Neither perl, python nor make is needed: Verilator's binary is run directly, and its C++ is compiled here.

// Each of the two users leaves some items unused.
#![allow(dead_code)]

mod block;
mod cache;
mod compile;
mod environments;
mod error;
mod ports;
mod tool;

use std::fs;
use std::path::{Path, PathBuf};

pub use compile::Compiler;
pub use error::Error;
pub use tool::Tool;

use sha2::{Digest, Sha256};

/// The kind of waveform a model can write. It is a property of the compiled model: tracing costs time even when off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Trace {
    /// No waveform: the fastest model.
    #[default]
    Off,
    /// Value change dump (IEEE 1364-2005, clause 18): text that every viewer reads.
    Vcd,
    /// GTKWave's compressed format; needs zlib's headers (Verilator 5.006) or lz4's (later).
    Fst,
}

impl Trace {
    /// The number this kind has in `tb/harness.h`.
    pub(crate) const fn number(self) -> u32 {
        match self {
            Self::Off => 0,
            Self::Vcd => 1,
            Self::Fst => 2,
        }
    }
}

/// One Verilog file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// A relative path without `..`, by which errors name the file.
    pub name: String,
    /// The content.
    pub text: String,
}

/// The files that wrap a model in the C ABI.
#[derive(Clone, Copy, Debug)]
pub struct Harness<'a> {
    /// `tb/harness.h`.
    pub header: &'a str,
    /// `tb/harness.cpp`.
    pub source: &'a str,
    /// `tb/fst.cpp`, which replaces the runtime's own writer of FST files.
    pub fst: &'a str,
}

/// A design to verilate.
#[derive(Clone, Copy, Debug)]
pub struct Design<'a> {
    /// Verilog files, each before the files that use it.
    pub files: &'a [File],
    /// The top module.
    pub top: &'a str,
    /// Parameters of the top module: name and Verilog constant.
    pub parameters: &'a [(String, String)],
    /// The kind of waveform.
    pub trace: Trace,
    /// The files of the C ABI.
    pub harness: Harness<'a>,
}

/// The source of this module is part of every model's key, so that a changed flag never meets an old model.
const RECIPE: &str =
    concat!(include_str!("mod.rs"), include_str!("block.rs"), include_str!("compile.rs"), include_str!("ports.rs"));

/// The class that Verilator makes of the top module. `tb/harness.cpp` uses this name.
const PREFIX: &str = "Vmodel";

/// SHA-256 of files, names, lengths and order included, in lower-case hex. This identifies a design, and is the same as
/// `afu::Afu::rtl_sha256` for generated ones.
pub fn rtl_sha256(files: &[File]) -> String {
    let parts: Vec<&str> = files.iter().flat_map(|file| [file.name.as_str(), file.text.as_str()]).collect();
    key_of(&parts)
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Reads a file list (`.f`): one relative path per line; `//` and `#` begin comments.
pub fn read_file_list(list: &Path) -> Result<Vec<File>, Error> {
    let text = fs::read_to_string(list).map_err(|e| Error::io("read", list, e))?;
    let folder = list.parent().unwrap_or(Path::new("."));
    let mut files = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let name = line.split("//").next().unwrap_or("").split('#').next().unwrap_or("").trim();
        if name.is_empty() {
            continue;
        }
        let plain = !name.starts_with(['-', '+', '/']) && !name.split('/').any(|part| part == "..");
        if !plain {
            let what = format!("line {}: `{name}` is not a relative path inside the folder", number + 1);
            return Err(Error::FileList { path: list.to_owned(), what });
        }
        let path = folder.join(name);
        let text = fs::read_to_string(&path).map_err(|e| Error::io("read", &path, e))?;
        files.push(File { name: name.to_owned(), text });
    }
    if files.is_empty() {
        return Err(Error::FileList { path: list.to_owned(), what: "names no file".to_owned() });
    }
    Ok(files)
}

/// The key under which a model is cached: everything that could change its bytes.
fn key(design: &Design, tool: &Tool, compiler: &Compiler, kind: &str) -> String {
    let (rtl, arguments) = (rtl_sha256(design.files), verilator_arguments(design, design.files).join(" "));
    let Harness { header, source, fst } = design.harness;
    let fst = if design.trace == Trace::Fst { fst } else { "" };
    key_of(&[RECIPE, kind, tool.sha256(), compiler.identity(), &rtl, header, source, fst, &arguments])
}

fn key_of(parts: &[&str]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part.as_bytes());
    }
    hex(&hash.finalize())
}

/// Lint errors stay errors. --output-split limits the size of a C++ file, so that all cores have work.
const FIXED_ARGUMENTS: [&str; 7] =
    ["--cc", "--no-timing", "-O3", "--output-split", "20000", "--output-split-cfuncs", "2000"];

fn verilator_arguments(design: &Design, files: &[File]) -> Vec<String> {
    let mut arguments: Vec<String> = FIXED_ARGUMENTS.map(str::to_owned).to_vec();
    // A port may have the name of a word of C++ libraries, as Vitis' `interrupt` has. The harness knows what Verilator
    // calls it.
    arguments.push("-Wno-SYMRSVDWORD".to_owned());
    arguments.extend(["--prefix".to_owned(), PREFIX.to_owned(), "--top-module".to_owned(), design.top.to_owned()]);
    match design.trace {
        Trace::Off => {}
        Trace::Vcd => arguments.push("--trace".to_owned()), // 5.006 does not know --trace-vcd
        Trace::Fst => arguments.push("--trace-fst".to_owned()),
    }
    arguments.extend(block::shared_arguments(design));
    arguments.extend(design.parameters.iter().map(|(name, value)| format!("-G{name}={value}")));
    arguments.extend(files.iter().map(|file| file.name.clone()));
    arguments
}

/// Folders that keep what was built.
#[derive(Clone, Copy, Debug)]
pub struct Cache<'a> {
    /// Models and their blocks.
    pub models: &'a Path,
    /// Verilator's runtime, which takes longer to compile than a small model and is the same for all of them.
    pub runtime: &'a Path,
}

impl<'a> From<&'a Path> for Cache<'a> {
    fn from(folder: &'a Path) -> Self {
        Self { models: folder, runtime: folder }
    }
}

/// Builds `design` as a shared library, or finds it in `cache`. Any number of processes may do this at once. `target`
/// is the Rust target triple of this process.
///
/// # Errors
/// See [`Error`].
pub fn shared(design: &Design, cache: Cache, target: &str) -> Result<PathBuf, Error> {
    let (tool, compiler) = (Tool::find()?, Compiler::find(target, target)?);
    let key = key(design, &tool, &compiler, "shared");
    let folder = cache::once(cache.models, &key, |aside| {
        let objects = objects(design, &tool, &compiler, cache, aside)?;
        compiler.link_shared(&objects, &tool, design.trace, &aside.join(MODEL))?;
        cache::keep_only(aside, MODEL)
    })?;
    Ok(folder.join(MODEL))
}

/// File name of a model in the cache.
const MODEL: &str = "model.so";

/// Builds `design` as object files for a static link, or finds them in the folder `cache`.
///
/// # Errors
/// See [`Error`].
pub fn objects_for_static(
    design: &Design,
    tool: &Tool,
    compiler: &Compiler,
    cache: &Path,
) -> Result<Vec<PathBuf>, Error> {
    let key = key(design, tool, compiler, "static");
    let folder = cache::once(cache, &key, |aside| {
        let kept = aside.join("objects");
        fs::create_dir(&kept).map_err(|e| Error::io("create", &kept, e))?;
        for (index, object) in objects(design, tool, compiler, cache.into(), aside)?.iter().enumerate() {
            let to = kept.join(format!("model_{index}.o"));
            fs::copy(object, &to).map_err(|e| Error::io("write", &to, e))?;
        }
        cache::keep_only(aside, "objects")
    })?;
    cache::files_in(&folder.join("objects"), "o")
}

/// Verilates `design` in the folder `aside` and compiles it. The runtime's objects come from the cache.
fn objects(
    design: &Design,
    tool: &Tool,
    compiler: &Compiler,
    cache: Cache,
    aside: &Path,
) -> Result<Vec<PathBuf>, Error> {
    let block = block::build(design, tool, compiler, cache.models)?;
    let files = block.as_ref().map(|block| block::rest(design, block));
    let design_files = files.as_deref().unwrap_or(design.files);
    let generated = aside.join("cpp");
    let arguments = verilator_arguments(design, design_files);
    run_verilator(&Design { files: design_files, ..*design }, tool, aside, &generated, &arguments)?;
    let mut classes = compile::Classes::read(&generated.join(format!("{PREFIX}_classes.mk")))?;
    if let Some(block) = &block {
        classes.runtime.extend(block.runtime.iter().cloned());
        classes.runtime.sort();
        classes.runtime.dedup();
    }

    let ports = ports::read(&generated.join(format!("{PREFIX}.h")))?;
    write(&generated.join("ports.inc"), &ports::include_file(&ports))?;
    write(&generated.join("harness.h"), design.harness.header)?;
    write(&generated.join("harness.cpp"), design.harness.source)?;

    let mut objects = runtime(&classes.runtime, design, tool, compiler, cache.runtime)?;
    let mut flags = compile::model_flags(tool, design.trace);
    flags.push(format!("-DAFU_TRACE={}", design.trace.number()));
    flags.push(format!("-DAFU_RTL_SHA256=\"{}\"", rtl_sha256(design.files)));
    let harness = "#include \"harness.cpp\"\n";
    objects.extend(compiler.compile_model(&classes, harness, &flags, [&generated, &generated])?);
    objects.extend(block.into_iter().flat_map(|block| block.objects));
    Ok(objects)
}

/// Runs Verilator on the files of `design`, in a folder `rtl` inside `aside`, so that messages use the caller's file
/// names.
fn run_verilator(
    design: &Design,
    tool: &Tool,
    aside: &Path,
    generated: &Path,
    arguments: &[String],
) -> Result<(), Error> {
    let rtl = aside.join("rtl");
    for file in design.files {
        let path = rtl.join(&file.name);
        let folder = path.parent().unwrap_or(&rtl);
        fs::create_dir_all(folder).map_err(|e| Error::io("create", folder, e))?;
        write(&path, &file.text)?;
    }
    write(&aside.join(block::CONFIG_NAME), &block::config())?;
    let mut command = tool.command();
    command.current_dir(&rtl).arg("--Mdir").arg(generated).args(arguments);
    let output = command.output().map_err(|e| Error::io("run", tool.program(), e))?;
    if output.status.success() {
        return Ok(());
    }
    Err(Error::Refused { top: design.top.to_owned(), text: tool::readable(&output) })
}

/// The runtime's writer of FST files.
const FST_WRITER: &str = "verilated_fst_c";

/// Verilator's own runtime, compiled once for each combination of Verilator, compiler and trace.
fn runtime(
    names: &[String],
    design: &Design,
    tool: &Tool,
    compiler: &Compiler,
    cache: &Path,
) -> Result<Vec<PathBuf>, Error> {
    let flags = compile::runtime_flags(tool, design.trace);
    let fst = if names.iter().any(|name| name == FST_WRITER) { design.harness.fst } else { "" };
    let parts = [RECIPE, "runtime", tool.sha256(), compiler.identity(), &names.join(" "), &flags.join(" "), fst];
    let folder = cache::once(cache, &key_of(&parts), |aside| {
        let of_ours = aside.join(format!("{FST_WRITER}_checked.cpp"));
        let source = |name: &String| match name.as_str() {
            FST_WRITER => of_ours.clone(),
            name => tool.include().join(format!("{name}.cpp")),
        };
        write(&of_ours, fst)?;
        let sources: Vec<_> = names.iter().map(source).map(compile::Source::from).collect();
        compiler.compile_all(&sources, &flags, aside).map(drop)
    })?;
    cache::files_in(&folder, "o")
}

fn write(path: &Path, text: &str) -> Result<(), Error> {
    fs::write(path, text).map_err(|e| Error::io("write", path, e))
}
