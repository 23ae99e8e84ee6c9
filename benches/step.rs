//! Simulated cycles per second: this crate's driver, with its link model, its memory and every check, against a loop
//! written by hand in C++ around the same model (`step.cpp`). Both run in one program: `cargo bench --bench step`.
//!
//! Both run the same job over the ideal link, in alternation, each on its own instance. Figures are medians, in CPU
//! seconds of the thread. With `--check` the program fails unless the driver is within 5 % on the default AFU. An AFU
//! of one SCPU is shown as the hard case: its cycle is so short that the cost of the checks is measurable.
//!
//! `cargo test` runs one alternation: both must take the same cycles and write the same lines.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use contact_afu::cosim::{Driver, Job, Model, Source, Trace};
use contact_afu::link::{Line, Link, LinkModel};
use contact_afu::query::PairRecord;
use libloading::os::unix::{Library, Symbol};

/// Number of alternations, whose median is reported.
const TURNS: usize = 15;
/// How much slower the driver may be, as a fraction.
const TOLERANCE: f64 = 0.05;

type Failure = Box<dyn std::error::Error>;
type OpenModel = unsafe extern "C" fn(*const std::ffi::c_char) -> *const std::ffi::c_void;
type RunJob = unsafe extern "C" fn(*const std::ffi::c_void, *const u32, *mut u32, u32, u64, u64, *mut f64) -> u64;

/// The loop in C++.
struct Loop {
    open_model: Symbol<OpenModel>,
    run_job: Symbol<RunJob>,
    cpu_seconds: Symbol<unsafe extern "C" fn() -> f64>,
}

impl Loop {
    /// Compiles and loads `step.cpp` with the optimisation that is usual for C++ programs.
    fn build(folder: &Path) -> Result<Self, Failure> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let library = folder.join("step.so");
        let compiler = std::env::var_os("CXX").unwrap_or_else(|| "c++".into());
        let mut command = Command::new(compiler);
        command.args(["-std=c++17", "-O3", "-shared", "-fPIC", "-o"]).arg(&library);
        if !command.arg(root.join("benches/step.cpp")).arg("-ldl").status()?.success() {
            return Err("benches/step.cpp does not compile".into());
        }
        // SAFETY: the library was compiled from the source above, and its functions have these types.
        unsafe {
            let library = Library::new(&library)?;
            let found = Self {
                open_model: library.get(b"open_model\0")?,
                run_job: library.get(b"run_job\0")?,
                cpu_seconds: library.get(b"cpu_seconds\0")?,
            };
            std::mem::forget(library);
            Ok(found)
        }
    }

    fn seconds(&self) -> f64 {
        // SAFETY: the function takes no argument and only reads a clock.
        unsafe { (self.cpu_seconds)() }
    }
}

fn source_lines(pairs: u32) -> Vec<Line> {
    let pair = |i: u32| PairRecord::from_spheres([0.0, 0.0, 0.0, 0.5], [(i % 97) as f32 / 64.0, 0.25, 0.5, 0.5]).0;
    let line = |i: u32| std::array::from_fn(|word| pair(2 * i + word as u32 / 8)[word % 8]);
    (0..pairs / 2).map(line).collect()
}

fn median(mut figures: Vec<f64>) -> f64 {
    figures.sort_by(f64::total_cmp);
    figures[figures.len() / 2]
}

/// Prints cycles per second of the driver and of the loop for `scpus` SCPUs. Returns the driver's rate as a share of
/// the loop's.
fn compare(by_hand: &Loop, turns: usize, scpus: u32, pairs: u32) -> Result<f64, Failure> {
    let rtl = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("rtl");
    let source = Source::from_folder(&rtl, "contact_afu")?.parameter("SCPUS", scpus.into());
    let model = Model::build(&source, Trace::Off)?;
    let library = model.shared_object().ok_or("the model is not in a library")?;
    let library = std::ffi::CString::new(library.to_str().ok_or("the cache's path is not UTF-8")?)?;
    // SAFETY: the text ends with a zero byte.
    let table = unsafe { (by_hand.open_model)(library.as_ptr()) };
    if table.is_null() {
        return Err("the loop cannot open the model".into());
    }
    let lines = source_lines(pairs);
    let mut written = vec![[0u32; 16]; lines.len()];
    let (mut ours, mut theirs, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for turn in 0..=turns {
        let instance = model.instance(0)?;
        let mut driver = Driver::new(&instance, Link::new(LinkModel::ideal(), 0)?)?;
        let begun = by_hand.seconds();
        let outcome = driver.run(&Job::new(&lines, pairs, lines.len() as u64))?;
        let ours_now = outcome.cycles as f64 / (by_hand.seconds() - begun);

        let mut seconds = 0.0;
        let (from, to) = (lines.as_ptr().cast(), written.as_mut_ptr().cast());
        // The driver has waited until a job begins at once.
        let idle = driver.capability().cycles_after_reset();
        let limit = 10 * u64::from(pairs) + 10_000;
        // SAFETY: the table is the model's, and both arrays hold the job's lines.
        let cycles = unsafe { (by_hand.run_job)(table, from, to, pairs, idle, limit, &mut seconds) };
        let theirs_now = cycles as f64 / seconds;

        let same = outcome.lines.iter().zip(&written).all(|(ours, theirs)| ours.as_ref() == Some(theirs));
        if cycles != outcome.cycles || !same {
            return Err(format!("the loops differ: {} and {cycles} cycles", outcome.cycles).into());
        }
        // The first turn warms up.
        if turn > 0 {
            ours.push(ours_now);
            theirs.push(theirs_now);
            ratios.push(ours_now / theirs_now);
        }
    }
    let ratio = median(ratios);
    println!("{scpus:>5}  {:>12.0}  {:>12.0}  {ratio:>6.3}", median(ours), median(theirs));
    Ok(ratio)
}

fn run(turns: usize) -> Result<bool, Failure> {
    let folder = tempfile::tempdir()?;
    let by_hand = Loop::build(folder.path())?;
    println!("SCPUs    driver c/s       C++ c/s   ratio");
    compare(&by_hand, turns, 1, 40_000)?;
    Ok(compare(&by_hand, turns, 10, 8_000)? >= 1.0 - TOLERANCE)
}

fn main() -> ExitCode {
    let is_asked = |option: &str| std::env::args().any(|argument| argument == option);
    let check = is_asked("--check");
    match run(if is_asked("--bench") { TURNS } else { 1 }) {
        Ok(within) if within || !check => ExitCode::SUCCESS,
        Ok(_) => {
            eprintln!("the driver is more than {:.0} % slower than the C++ loop", 100.0 * TOLERANCE);
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(4)
        }
    }
}
