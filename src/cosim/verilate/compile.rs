//! Compiles Verilator's output. `cc` finds the compiler and its flags. The processes are run here, so that all cores
//! work and the compiler's messages reach the caller.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::{Error, Tool, Trace};

/// Never 0, whatever the Cargo profile: a model at -O0 ran 17 times slower. Above 1 only compilation slows down. What
/// runs once is not optimised.
const OPTIMISATION: u32 = 1;

/// Variables that GCC and Clang read: folders of headers, programs and libraries, and the SDK of a Mac.
const READ_BY_COMPILERS: [&str; 7] = [
    "CPATH",
    "CPLUS_INCLUDE_PATH",
    "COMPILER_PATH",
    "GCC_EXEC_PREFIX",
    "LIBRARY_PATH",
    "MACOSX_DEPLOYMENT_TARGET",
    "SDKROOT",
];

/// A file to compile.
pub(super) struct Source {
    path: PathBuf,
    /// A flag behind those of all files.
    own_flag: Option<&'static str>,
}

impl From<PathBuf> for Source {
    fn from(path: PathBuf) -> Self {
        Self { path, own_flag: None }
    }
}

/// The C++ compiler.
#[derive(Clone, Debug)]
pub struct Compiler {
    tool: cc::Tool,
    identity: String,
}

impl Compiler {
    /// Finds the compiler that runs on `host` and compiles for `target`. Both are Rust target triples.
    ///
    /// # Errors
    /// Returns [`Error::MissingTool`] if there is no compiler.
    pub fn find(target: &str, host: &str) -> Result<Self, Error> {
        let tool = cc::Build::new()
            .cpp(true)
            .std("c++17")
            .target(target)
            .host(host)
            .opt_level(OPTIMISATION)
            .debug(false)
            .pic(true)
            .warnings(false)
            .cargo_metadata(false)
            .cargo_warnings(false)
            .try_get_compiler()
            .map_err(|e| missing(e.to_string()))?;
        let name = tool.path().display().to_string();
        let output = tool.to_command().arg("--version").output().map_err(|e| missing(format!("`{name}`: {e}")))?;
        if !output.status.success() {
            return Err(missing(format!("`{name} --version` failed")));
        }
        let version = String::from_utf8_lossy(&output.stdout).into_owned();
        let command = tool.to_command();
        let called: Vec<_> = [command.get_program()].into_iter().chain(command.get_args()).collect();
        // From the environment, the variables that compilers read. The flags that `cc` takes from it are among the
        // arguments.
        let read = READ_BY_COMPILERS.map(env::var_os);
        let identity = format!("{target}\n{version}\n{called:?}\n{read:?}\n{:?}", model_options());
        Ok(Self { tool, identity })
    }

    /// Everything about the compiler that can change its output.
    pub(super) fn identity(&self) -> &str {
        &self.identity
    }

    /// The first line of its version text.
    pub fn version(&self) -> &str {
        self.identity.lines().nth(1).unwrap_or("")
    }

    /// Compiles the model's files in `generated` into `folder`, `first` at their head.
    pub(super) fn compile_model(
        &self,
        classes: &Classes,
        first: &str,
        flags: &[String],
        [generated, folder]: [&Path; 2],
    ) -> Result<Vec<PathBuf>, Error> {
        let fast = bundle(generated, &classes.fast, "fast", first, jobs())?;
        let slow = bundle(generated, &classes.slow, "slow", "", 1)?;
        let slow = slow.into_iter().map(|path| Source { path, own_flag: Some("-O0") });
        let sources: Vec<_> = fast.into_iter().map(Source::from).chain(slow).collect();
        self.compile_all(&sources, flags, folder)
    }

    /// Compiles each of `sources` into `folder`, several at a time. The objects are in the order of the sources.
    pub(super) fn compile_all(
        &self,
        sources: &[Source],
        flags: &[String],
        folder: &Path,
    ) -> Result<Vec<PathBuf>, Error> {
        let object = |source: &Source| folder.join(source.path.file_name().unwrap_or_default()).with_extension("o");
        let next = AtomicUsize::new(0);
        let failure = Mutex::new(None);
        let work = || {
            while let Some(source) = sources.get(next.fetch_add(1, Ordering::Relaxed)) {
                let mut command = self.tool.to_command();
                command.args(flags).args(source.own_flag).arg("-c").arg(&source.path).arg("-o").arg(object(source));
                if let Err(error) = run(&mut command, &source.path.display().to_string()) {
                    next.store(sources.len(), Ordering::Relaxed); // the others stop after their current source
                    *failure.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(error);
                }
            }
        };
        thread::scope(|scope| (0..jobs().min(sources.len())).for_each(|_| drop(scope.spawn(work))));
        match failure.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner()) {
            Some(error) => Err(error),
            None => Ok(sources.iter().map(object).collect()),
        }
    }

    /// Links `objects` into the shared library `model`, which exports one symbol. (Hidden visibility is not enough: the
    /// C++ library's templates declare theirs visible.)
    pub(super) fn link_shared(
        &self,
        objects: &[PathBuf],
        tool: &Tool,
        trace: Trace,
        model: &Path,
    ) -> Result<(), Error> {
        let mut command = self.tool.to_command();
        command.arg("-shared").arg("-o").arg(model).args(objects).arg("-pthread");
        if cfg!(target_os = "macos") {
            command.arg("-Wl,-exported_symbol,_afu_model");
        } else {
            let script = model.with_extension("map");
            super::write(&script, "{ global: afu_model; local: *; };\n")?;
            // -z defs: a missing symbol is an error here, not when the model is loaded.
            command.arg(format!("-Wl,--version-script={}", script.display())).arg("-Wl,-z,defs");
        }
        if trace == Trace::Fst {
            command.arg("-lz");
            // Verilator 5.006 brings its own copy of lz4; later ones use the system's.
            if !tool.include().join("gtkwave/lz4.c").is_file() {
                command.arg("-llz4");
            }
        }
        run(&mut command, "the link of the model")
    }
}

/// The command that installs a tool, including the repository's script if it is in the current folder.
pub(super) fn install(commands: &str) -> String {
    if Path::new("scripts/setup").is_file() { format!("scripts/setup, or {commands}") } else { commands.to_owned() }
}

fn missing(found: String) -> Error {
    let install = install("`apt-get install g++`");
    Error::MissingTool { name: "a C++ compiler".to_owned(), found, install }
}

fn run(command: &mut Command, what: &str) -> Result<(), Error> {
    let output = command.output().map_err(|e| Error::io("run", Path::new(command.get_program()), e))?;
    if output.status.success() {
        return Ok(());
    }
    let text: Vec<String> = String::from_utf8_lossy(&output.stderr).lines().take(30).map(str::to_owned).collect();
    Err(Error::Compile { what: what.to_owned(), text: text.join("\n") })
}

/// The number of jobs: Cargo's in a build script, otherwise the number of cores.
fn jobs() -> usize {
    let cargo = env::var("NUM_JOBS").ok().and_then(|text| text.parse().ok());
    cargo.or_else(|| thread::available_parallelism().ok().map(usize::from)).unwrap_or(1).max(1)
}

/// Hidden symbols, and no GNU unique ones. Otherwise Verilator's globals would be shared by all models of a process,
/// whatever their Verilator and flags, even under RTLD_LOCAL.
fn model_options() -> [&'static str; 3] {
    ["-fvisibility=hidden", "-fvisibility-inlines-hidden", "-pthread"]
}

fn flags(tool: &Tool, trace: Trace) -> Vec<String> {
    let include = tool.include();
    let vcd = u32::from(trace == Trace::Vcd);
    let fst = u32::from(trace == Trace::Fst);
    let mut flags: Vec<String> = model_options().map(str::to_owned).to_vec();
    if !cfg!(target_os = "macos") {
        flags.push("-fno-gnu-unique".to_owned());
    }
    flags.extend([
        "-w".to_owned(),
        format!("-I{}", include.display()),
        format!("-I{}", include.join("vltstd").display()),
        "-DVERILATOR=1".to_owned(),
        "-DVM_COVERAGE=0".to_owned(),
        "-DVM_SC=0".to_owned(),
        format!("-DVM_TRACE={}", vcd | fst),
        format!("-DVM_TRACE_VCD={vcd}"),
        format!("-DVM_TRACE_FST={fst}"),
        "-DVM_TRACE_SAIF=0".to_owned(),
    ]);
    flags
}

/// Flags for the model and the harness.
pub(super) fn model_flags(tool: &Tool, trace: Trace) -> Vec<String> {
    flags(tool, trace)
}

/// Flags for Verilator's runtime. The harness defines the functions that would otherwise end the process, and $display
/// must not write to the program's standard output.
pub(super) fn runtime_flags(tool: &Tool, trace: Trace) -> Vec<String> {
    let mut flags = flags(tool, trace);
    let own = ["-DVL_USER_FATAL", "-DVL_USER_STOP", "-DVL_USER_FINISH", "-DVL_PRINTF(...)=fprintf(stderr,__VA_ARGS__)"];
    flags.extend(own.map(str::to_owned));
    flags
}

/// The C++ files of one model, as Verilator lists them (their names change from version to version).
pub(super) struct Classes {
    /// Files of the model that run in every cycle, without folder and extension.
    pub fast: Vec<String>,
    /// Files of the model that run once.
    pub slow: Vec<String>,
    /// Files of Verilator's runtime, likewise.
    pub runtime: Vec<String>,
}

impl Classes {
    /// Reads `V*_classes.mk`.
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let text = fs::read_to_string(path).map_err(|e| Error::io("read", path, e))?;
        let mut classes = Self { fast: Vec::new(), slow: Vec::new(), runtime: Vec::new() };
        let mut list: Option<&mut Vec<String>> = None;
        for line in text.lines() {
            let item = line.trim().trim_end_matches('\\').trim();
            if let Some((variable, _)) = item.split_once("+=") {
                list = match variable.trim() {
                    "VM_CLASSES_FAST" | "VM_SUPPORT_FAST" => Some(&mut classes.fast),
                    "VM_CLASSES_SLOW" | "VM_SUPPORT_SLOW" => Some(&mut classes.slow),
                    name if name.starts_with("VM_GLOBAL_") => Some(&mut classes.runtime),
                    _ => None,
                };
            } else if item.is_empty() || item.starts_with('#') {
                list = None;
            } else if let Some(list) = &mut list {
                list.push(item.to_owned());
            }
        }
        if classes.fast.is_empty() || classes.runtime.is_empty() {
            let what = "lists no class or no runtime file".to_owned();
            return Err(Error::Unexpected { path: path.to_owned(), what });
        }
        Ok(classes)
    }
}

/// Bytes of C++ above which another translation unit pays off. For each unit, reading Verilator's headers takes about
/// as long as compiling this much.
const UNIT_BYTES: u64 = 400_000;

/// Joins many small C++ files into few translation units of about equal size, at most `most`, which `#include` them.
/// `first` is at the head of the first unit. Returns the units.
fn bundle(folder: &Path, names: &[String], kind: &str, first: &str, most: usize) -> Result<Vec<PathBuf>, Error> {
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let mut files = Vec::new();
    for name in names {
        let path = folder.join(format!("{name}.cpp"));
        let bytes = fs::metadata(&path).map_err(|e| Error::io("read", &path, e))?.len();
        files.push((bytes, format!("{name}.cpp")));
    }
    files.sort_by(|a, b| b.cmp(a));
    let total: u64 = files.iter().map(|(bytes, _)| bytes).sum();
    let units = usize::try_from(total.div_ceil(UNIT_BYTES)).unwrap_or(1).clamp(1, files.len().min(most));
    let mut filled = vec![(0u64, String::new()); units];
    filled[0].1.push_str(first);
    for (bytes, name) in files {
        if let Some(unit) = filled.iter_mut().min_by_key(|(filled, _)| *filled) {
            unit.0 += bytes;
            unit.1.push_str(&format!("#include \"{name}\"\n"));
        }
    }
    let mut paths = Vec::new();
    for (index, (_, text)) in filled.iter().enumerate() {
        let path = folder.join(format!("{kind}_unit_{index}.cpp"));
        super::write(&path, text)?;
        paths.push(path);
    }
    Ok(paths)
}
