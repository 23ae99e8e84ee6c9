//! `afu synth`: runs an operator, an SCPU or an AFU through Yosys and nextpnr.

use std::path::{Path, PathBuf};

use clap::Args;
use contact_afu::afu::BuildError;
use contact_afu::config::{Config, Multipliers};
use contact_afu::hdl::DelayModel;
use contact_afu::number::Format;
use contact_afu::operator::{Operator, Values};
use contact_afu::pipeline::is_normal;
use contact_afu::query::Fields;
use contact_afu::report::folder::{check_study, replace_file};
use contact_afu::report::synth_study::{SCHEMA, SynthStudy};
use contact_afu::report::{intervals, operators, synth as report};
use contact_afu::synth::{self, Figures, Placer, Request, SynthError, Target, Unit};

use super::failure::{Failure, Kind};
use super::list::List;
use super::machine::{One, warn_of_unused_scpus};
use super::study::Shared;
use super::{output, progress, study};

/// Report the area and clock of an operator, an SCPU or an AFU on an FPGA
///
/// Yosys counts cells, nextpnr places and routes. Without --operator, --kernel or --compare, the whole AFU is measured.
#[derive(Args, Debug)]
pub struct Synth {
    /// Measure operators, a comma-separated list: add, sub, add_magnitudes, mul, square, div, recip, sqrt, halve,
    /// greater, at_most, root_exceeds, from_record, to_record, or all
    #[arg(long, value_name = "NAMES", value_delimiter = ',', conflicts_with = "kernel")]
    operator: Vec<String>,
    /// Measure one SCPU (sphere collision processing unit): the kernel and its detection of invalid pairs
    #[arg(long)]
    kernel: bool,
    /// Fit the target's delay model to routed circuits and write the model and its errors to FILE
    #[arg(long, value_name = "FILE", conflicts_with_all = ["operator", "kernel", "json", "check", "store"])]
    fit: Option<PathBuf>,
    /// Print docs/operators.md, operators beside the best public cores, from files that --json wrote
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["operator", "kernel", "json", "check", "store", "fit"])]
    page: Vec<PathBuf>,
    /// Print docs/interval.md, an SCPU's area by initiation interval, from files that --json wrote
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["operator", "kernel", "json", "check", "store", "fit", "page"])]
    intervals: Vec<PathBuf>,
    /// Also write the picture of --intervals to an SVG file
    #[arg(long, value_name = "FILE", requires = "intervals")]
    picture: Option<PathBuf>,
    /// Seeds of the placer: 1,2,3 or 1..8 (includes 8); the clock is the median over them
    #[arg(long, value_name = "LIST", default_value = "1,2,3")]
    seeds: List,
    /// nextpnr's placer: heap, its own choice; static, whose wires are shorter in a large design; or floorplan: static,
    /// with multipliers and block memories placed before, by how data flow between them (ECP5)
    #[arg(long, value_name = "NAME", default_value_t, conflicts_with_all = ["no_route", "fit", "page", "intervals"])]
    placer: Placer,
    /// Count cells, without place and route
    #[arg(long)]
    no_route: bool,
    /// Compare the architectures of an operator: roots and reciprocals by table and digit by digit
    ///
    /// Without --operator, only sqrt and recip are measured.
    #[arg(long, conflicts_with_all = ["kernel", "fit", "page", "intervals"])]
    compare: bool,
    /// Exit with status 1 if a clock is below --clock
    #[arg(long)]
    check: bool,
    /// Also write the figures as JSON to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Folder to write: report.html, figures.csv, manifest.json with all figures, and measurements/ to resume from
    #[arg(long, value_name = "DIR", conflicts_with_all = ["fit", "page", "intervals"])]
    out: Option<PathBuf>,
    /// Write into a folder that afu did not make, or replace another study; other files stay
    #[arg(long, requires = "out")]
    force: bool,
    #[command(flatten)]
    one: One,
    #[command(flatten)]
    shared: Shared,
}

pub fn run(options: &Synth) -> Result<(), Failure> {
    if !options.page.is_empty() {
        return self::page(&options.page);
    }
    if !options.intervals.is_empty() {
        return by_interval(&options.intervals, options.picture.as_deref());
    }
    let target = options.one.machine.target()?.unwrap_or(Target::Ecp5);
    if let Some(file) = &options.fit {
        return fit(file, target, &options.seeds.0);
    }
    let placer = options.placer;
    if !placer.serves(target) {
        return Err(Failure::new(
            Kind::Usage,
            format!("--placer {placer} is for --target ecp5, not {target}: use heap or static"),
        ));
    }
    let config = options.one.at_full_rate(options.one.machine.config_for_any_target()?, "ideal")?;
    let seeds = if options.no_route { Vec::new() } else { options.seeds.0.clone() };
    let how = synth::Options { target, seeds, placer };
    let units = units(options, &config, target)?;
    let out = options.out.as_deref();
    if let Some(folder) = out {
        check_study(folder, SCHEMA, options.force)?;
    }
    let request = Request::new(&units, &how)?;
    options.shared.keep("synth", &request)?;
    let store = study::store(options.shared.store.as_deref(), out)?;
    let mut worker = options.shared.worker();
    if let Some(folder) = out {
        // From the first measurement on the folder is known as ours.
        SynthStudy::new(Vec::new(), &worker).save(folder)?;
    }
    let bar = progress::study();
    let step = |what: &str| bar.set_message(what.to_owned());
    let all = request.run(&units, &how, &store, &mut worker, step, |news| options.shared.show(&bar, &news));
    bar.finish_and_clear();
    let results = SynthStudy::new(all?, &worker);
    if let Some(folder) = out {
        results.save(folder)?;
    }
    let all = &results.figures;
    if !options.shared.is_part() && !all.is_empty() {
        show(&results, options.json.as_deref())?;
    }
    options.shared.end(&worker)?;
    match all.iter().find(|figures| options.check && figures.meets() == Some(false)) {
        None => Ok(()),
        Some(slow) => {
            let clock = slow.clock_mhz.unwrap_or_default();
            let message = format!("{}: expected {} MHz, found {clock:.1}", report::title(slow), slow.asked_mhz);
            Err(Failure::new(Kind::Failed, message))
        }
    }
}

/// Shows the tables, and writes the figures as JSON: one unit's, or a list.
pub fn show(results: &SynthStudy, json: Option<&Path>) -> Result<(), Failure> {
    output::show(&results.text(), json.is_some_and(output::is_stdout))?;
    match (json, results.figures.as_slice()) {
        (None, _) => Ok(()),
        (Some(path), [one]) => output::json(path, one),
        (Some(path), _) => output::json(path, &results.figures),
    }
}

fn by_interval(files: &[PathBuf], picture: Option<&Path>) -> Result<(), Failure> {
    let all = figures_in(files)?;
    if let Some(path) = picture {
        replace_file(path, intervals::picture(&all).svg().as_bytes())?;
    }
    output::show(intervals::page(&all).trim_end(), false)
}

fn page(files: &[PathBuf]) -> Result<(), Failure> {
    let page = operators::page(&figures_in(files)?).map_err(|error| Failure::caused(Kind::Other, error))?;
    output::show(page.trim_end(), false)
}

/// The figures of all files.
fn figures_in(files: &[PathBuf]) -> Result<Vec<Figures>, Failure> {
    let mut all: Vec<Figures> = Vec::new();
    for file in files {
        let fail = |error: &dyn std::fmt::Display| Failure::new(Kind::Usage, format!("{}: {error}", file.display()));
        let text = std::fs::read_to_string(file).map_err(|error| fail(&error))?;
        // A file holds the figures of one unit or a list of figures.
        if text.trim_start().starts_with('[') {
            all.extend(serde_json::from_str::<Vec<Figures>>(&text).map_err(|error| fail(&error))?);
        } else {
            all.push(serde_json::from_str(&text).map_err(|error| fail(&error))?);
        }
    }
    Ok(all)
}

fn fit(file: &Path, target: Target, seeds: &[u32]) -> Result<(), Failure> {
    let spinner = progress::spinner("");
    let fit = synth::fit::fit(target, seeds, |what| spinner.set_message(what.to_owned()))?;
    spinner.finish_and_clear();
    let Some(fit) = fit else {
        return Err(Failure::new(
            Kind::Usage,
            format!("--target {target}: --fit needs a router, and afu has none for this family; use ecp5 or ice40"),
        ));
    };
    output::show(&report::fit(&fit), output::is_stdout(file))?;
    output::json(file, &fit)
}

fn units(options: &Synth, config: &Config, target: Target) -> Result<Vec<Unit>, Failure> {
    if options.kernel {
        return Ok(vec![Unit::scpu_for(config, target)?]);
    }
    if options.operator.is_empty() && !options.compare {
        warn_of_unused_scpus(config);
        return Ok(vec![Unit::afu(config, target)?]);
    }
    let names: Vec<&str> = match options.operator.as_slice() {
        [] => vec!["recip", "sqrt"],
        [all] if all == "all" => names(),
        names => names.iter().map(String::as_str).collect(),
    };
    let model = target.delays().with_spared_multipliers(config.multipliers == Multipliers::Spare);
    let is_normal = is_normal(config.query, config.profile.arithmetic(), Fields::ALL)
        .map_err(BuildError::from)
        .map_err(SynthError::from)?;
    let models = if options.compare { vec![model.clone(), model.with_spared_multipliers(true)] } else { vec![model] };
    let unit = |name: &str, model: &DelayModel| {
        let (operator, profile) = operator(name, config)?;
        // The values that the operator sees in the kernel of this profile.
        let values = match name {
            "from_record" => Values::Finite,
            _ if is_normal => Values::Normal,
            _ => Values::Any,
        };
        let unit = Unit::operator(operator, &profile, values, model, config.clock_mhz)?;
        Ok::<_, Failure>(Unit { name: name.to_owned(), ..unit })
    };
    let mut units: Vec<Unit> = Vec::new();
    for name in names {
        for made in models.iter().map(|model| unit(name, model)) {
            let made = made?;
            // An operator with a single architecture comes out of both models alike.
            if !units.iter().any(|unit| (&unit.name, unit.architecture) == (&made.name, made.architecture)) {
                units.push(made);
            }
        }
    }
    Ok(units)
}

/// The operators of one format, in the order of `all`; the conversions follow them.
const OPERATORS: [Operator; 12] = [
    Operator::Square,
    Operator::AddMagnitudes,
    Operator::Add,
    Operator::Sub,
    Operator::Mul,
    Operator::Div,
    Operator::Recip,
    Operator::Sqrt,
    Operator::Halve,
    Operator::Greater,
    Operator::AtMost,
    Operator::RootExceeds,
];

/// The names of all operators and conversions.
fn names() -> Vec<&'static str> {
    OPERATORS.iter().map(|operator| operator.name()).chain(["from_record", "to_record"]).collect()
}

/// An operator by its name, and the profile of its operands.
fn operator(name: &str, config: &Config) -> Result<(Operator, contact_afu::config::Profile), Failure> {
    let arithmetic = config.profile.clone();
    let operator = match name {
        "to_record" => Operator::Convert { to: arithmetic.format().record(Format::BINARY32) },
        "from_record" => {
            let record = arithmetic.format().record(Format::BINARY32);
            let record = record.to_string().parse().map_err(|error| Failure::new(Kind::Other, error))?;
            return Ok((Operator::Convert { to: arithmetic.format() }, record));
        }
        _ => {
            let unknown = || format!("unknown operator `{name}`: use {}", names().join(", "));
            let known = OPERATORS.into_iter().find(|operator| operator.name() == name);
            known.ok_or_else(|| Failure::new(Kind::Usage, unknown()))?
        }
    };
    Ok((operator, arithmetic))
}

impl From<SynthError> for Failure {
    fn from(error: SynthError) -> Self {
        let kind = match error {
            SynthError::MissingTool(_) => Kind::Tool,
            SynthError::Generate(error) => return error.into(),
            _ => Kind::Other,
        };
        Self::caused(kind, error)
    }
}
