//! `afu choose`: the cheapest configuration that meets bounds, from a study's results; or the search for a scene.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use contact_afu::accuracy::trade::{Bounds, Study, Time, choose, committed, to_build};
use contact_afu::config::{Config, Input, MANIFEST_SCHEMA, Search, Shell};
use contact_afu::report::table::{counted, grouped};
use contact_afu::scene::{Choice, Part, Plan, Scene, Still};
use serde_json::json;

use super::failure::{Classify, Failure, Kind};
use super::output;

/// Pick the cheapest configuration that meets your bounds on error, time or area
///
/// The command reads results of `afu accuracy --out`; at least one bound is needed. The cheapest configuration is the
/// one with the fewest LUTs per SCPU (sphere collision processing unit). If no cells were counted, it is the fastest
/// one. If some configurations were placed and routed, only those are considered, at the clock that the router reached.
/// If no configuration meets the bounds, the command says by how much to relax each and ends with status 1.
///
/// With --scene FILE --input spheres, the command says instead what to build for a scene whose spheres are sent. A
/// cycle model of the scene's start begins with the smallest search, and doubles the slowest stage as long as that
/// takes a tenth less time and the link does not set the pace. Behind it come the fewest SCPUs to which more would not
/// gain a tenth.
#[derive(Args, Debug)]
pub struct Choose {
    /// Maximum relative error on the diamond and the crowded scenes
    #[arg(long, value_name = "ERROR", value_parser = positive)]
    max_error: Option<f64>,
    /// Maximum time in ns, of the kind that --time selects
    #[arg(long, value_name = "NS", value_parser = positive)]
    max_ns: Option<f64>,
    /// Maximum number of LUTs per SCPU
    #[arg(long, value_name = "N", value_parser = positive)]
    max_luts: Option<f64>,
    /// Maximum number of gross failures (grossly wrong contacts, see docs/hard.md) on all pairs of the study
    #[arg(long, value_name = "N", value_parser = at_least_zero)]
    max_bad: Option<f64>,
    /// Time that --max-ns bounds
    #[arg(long, value_name = "KIND", default_value = "lone")]
    time: Which,
    /// Results to choose from: a results.json or the folder of one [default: the results that are built in]
    #[arg(long, value_name = "FILE|DIR")]
    from: Option<PathBuf>,
    /// Scene to choose for, a TOML file as in `afu scene`, with --input spheres
    ///
    /// The fields of a contact and the arithmetic are those that the scene calls for.
    #[arg(long, value_name = "FILE", requires = "input",
        conflicts_with_all = ["max_error", "max_ns", "max_luts", "max_bad", "time", "from"])]
    scene: Option<PathBuf>,
    /// What the AFU is sent, for --scene: spheres
    #[arg(long, value_name = "KIND")]
    input: Option<Input>,
    /// Link between AFU and memory, for --scene: a name or file as in `afu cosim` [default: harp1]
    #[arg(long, value_name = "NAME|FILE")]
    link: Option<String>,
    /// Logic around the AFU's line port, for --scene: spl2, axi or line [default: spl2]
    #[arg(long, value_name = "SHELL")]
    shell: Option<Shell>,
    /// Write the configuration to a file for --config of other commands, or to standard output for -
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Which {
    /// Latency of a single pair, from its line in to its line out
    Lone,
    /// Time per pair of an FPGA full of SCPUs
    Device,
    /// Time per pair over the study's link
    Link,
}

fn positive(text: &str) -> Result<f64, String> {
    at_least_zero(text).and_then(|value| if value > 0.0 { Ok(value) } else { Err("must be above 0".to_owned()) })
}

fn at_least_zero(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..f64::INFINITY).contains(&value) => Ok(value),
        _ => Err("expected a number of at least 0, such as 300 or 1e-6".to_owned()),
    }
}

pub fn run(options: &Choose) -> Result<(), Failure> {
    if let Some(file) = &options.scene {
        return options.for_scene(file);
    }
    if options.input.is_some() || options.link.is_some() || options.shell.is_some() {
        let message = "--input, --link and --shell choose for a scene; give --scene <FILE>, or leave them out";
        return Err(Failure::new(Kind::Usage, message.to_owned()));
    }
    let bounds = Bounds { error: options.max_error, ns: options.max_ns, luts: options.max_luts, bad: options.max_bad };
    if bounds == Bounds::default() {
        let message = "no bound is given; give at least one of --max-error, --max-ns, --max-luts and --max-bad";
        return Err(Failure::new(Kind::Usage, message));
    }
    let results = options.results()?;
    let time = match options.time {
        Which::Lone => Time::Lone,
        Which::Device => Time::Device,
        Which::Link => Time::Link,
    };
    if !results.has_areas() && (options.max_luts.is_some() || time == Time::Device) {
        let message = "--max-luts and --time device need areas, which these results lack; `afu accuracy --out DIR` or \
                       `--quick --synth` counts cells";
        return Err(Failure::new(Kind::Usage, message.to_owned()));
    }
    let routed = if results.comparable().any(|point| point.routed_mhz().is_some()) { "placed and routed " } else { "" };
    let count = results.comparable().count();
    let of = format!("of {count} {routed}configurations, {}: {}", results.date, results.command);
    match choose(&results, &bounds, time) {
        Ok(point) => {
            let ns = time.of(point, &results).map_or("-".to_owned(), |ns| format!("{ns:.1}"));
            let luts = point.area().map_or("-".to_owned(), |area| area.luts.to_string());
            let clock = if point.routed_mhz().is_some() { "placed and routed" } else { "by the delay model" };
            let text = format!(
                "{}: largest error {:.1e} on the scenes, {} in {}; {ns} ns at {:.0} MHz ({clock}), {luts} LUTs\n({of})",
                point.name,
                results.worst(point),
                counted(point.tally().bad, "gross failure"),
                counted(results.pairs(), "pair"),
                point.clock_mhz(),
            );
            options.show(&text, &to_build(&results, point, time))
        }
        Err(instead) => {
            let mut message = format!("no configuration meets these bounds ({of})");
            for instead in &instead {
                message += &format!("; {} could be met: {}", instead.bound.words(instead.value), instead.point.name);
            }
            if instead.is_empty() {
                message += "; relaxing a single bound is not enough";
            }
            Err(Failure::new(Kind::Failed, message))
        }
    }
}

impl Choose {
    /// Shows a choice, and writes its configuration.
    fn show(&self, text: &str, config: &Config) -> Result<(), Failure> {
        let stdout_taken = self.out.as_deref().is_some_and(output::is_stdout);
        output::show(text, stdout_taken)?;
        match &self.out {
            Some(path) => output::json(path, &json!({ "schema": MANIFEST_SCHEMA, "config": config })),
            None => output::show(&format!("options: {}", config.flags().join(" ")), false),
        }
    }

    /// What to build for a scene whose spheres are sent.
    fn for_scene(&self, file: &Path) -> Result<(), Failure> {
        let usage = |message: String| Failure::new(Kind::Usage, message);
        if self.input != Some(Input::Spheres) {
            let message = "--scene chooses an AFU that is sent spheres: give --input spheres; for pairs, `afu scene \
                           FILE --plan` plans one";
            return Err(usage(message.to_owned()));
        }
        let story = Scene::read(file)?;
        let name = file.display().to_string();
        let plan = Plan::of(&story)?;
        if !plan.has(Part::Hit) {
            return Err(usage(format!("{name}: nothing in this scene needs contacts, so there is no AFU to choose")));
        }
        let bus = plan.config.bus;
        let plan = plan.below(self.shell.unwrap_or(Shell::Spl2), bus);
        let table = super::spheres::table_for(&name, &Still::of(&story)?.sets().0)?;
        let base = plan.clone().of_spheres(Search { table, ..Search::default() }).config;
        base.check()?;
        let of_link = self.link.as_deref().unwrap_or("harp1");
        let mut link = super::link::read(of_link, base.clock_mhz)?;
        if base.shell == Shell::Axi {
            link = link.on_bus(base.bus);
        }
        let choice = Choice::of(&story, &plan, &base, &link)?;
        let title = format!(
            "{name}: predicted for its start; --contact {}, table of {}, {} MHz, link {of_link}",
            base.contact,
            grouped(table.into()),
            base.clock_mhz
        );
        self.show(&format!("{title}\n{}", choice.text()), &choice.chosen.config)
    }

    fn results(&self) -> Result<Study, Failure> {
        let Some(path) = &self.from else { return committed().ends(Kind::Other) };
        let path = if path.is_dir() { path.join("results.json") } else { path.clone() };
        let fail = |error: &dyn std::fmt::Display| Failure::new(Kind::Usage, format!("{}: {error}", path.display()));
        let text = fs::read(&path).map_err(|error| fail(&error))?;
        serde_json::from_slice(&text).map_err(|error| fail(&error))
    }
}
