//! `afu choose`: the cheapest configuration that meets bounds, from a study's results.

use std::fs;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use contact_afu::accuracy::trade::{Bounds, Study, Time, choose, committed, to_build};
use contact_afu::config::MANIFEST_SCHEMA;
use serde_json::json;

use super::failure::{Classify, Failure, Kind};
use super::output;

/// Name the cheapest configuration that meets bounds, from the results of `afu accuracy --out`
///
/// The cheapest has the fewest LUTs, of those that were placed and routed where any was; where no cells were counted,
/// it has the least time. At least one bound is needed. Where nothing meets the bounds, it says what it would take,
/// bound by bound, and ends with status 1. The configuration's clock is the one that the router reached for stages that
/// were cut for a higher one (--clock and --cut-for).
#[derive(Args, Debug)]
pub struct Choose {
    /// Largest relative error on the scenes, at most
    #[arg(long, value_name = "ERROR", value_parser = positive)]
    max_error: Option<f64>,
    /// Nanoseconds, at most: of what --time says
    #[arg(long, value_name = "NS", value_parser = positive)]
    max_ns: Option<f64>,
    /// LUTs of an SCPU, at most
    #[arg(long, value_name = "N", value_parser = positive)]
    max_luts: Option<f64>,
    /// Gross failures on all pairs of the study, at most
    #[arg(long, value_name = "N", value_parser = at_least_zero)]
    max_bad: Option<f64>,
    /// Which time --max-ns is of
    #[arg(long, value_name = "WHICH", default_value = "lone")]
    time: Which,
    /// Results to choose from: results.json, or a folder with one [default: those that are part of this program]
    #[arg(long, value_name = "FILE|DIR")]
    from: Option<PathBuf>,
    /// File to write the configuration to, for --config of other commands; - is standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Which {
    /// A lone pair, line in to line out
    Lone,
    /// A pair of a device full of SCPUs
    Device,
    /// A pair over the study's link
    Link,
}

fn positive(text: &str) -> Result<f64, String> {
    at_least_zero(text).and_then(|value| if value > 0.0 { Ok(value) } else { Err("must be above 0".to_owned()) })
}

fn at_least_zero(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..f64::INFINITY).contains(&value) => Ok(value),
        _ => Err("give a number, such as 300 or 1e-6".to_owned()),
    }
}

pub fn run(options: &Choose) -> Result<(), Failure> {
    let bounds = Bounds { error: options.max_error, ns: options.max_ns, luts: options.max_luts, bad: options.max_bad };
    if bounds == Bounds::default() {
        let message =
            "nothing to choose by: give at least one bound, of --max-error, --max-ns, --max-luts and --max-bad";
        return Err(Failure::new(Kind::Usage, message));
    }
    let results = options.results()?;
    let time = match options.time {
        Which::Lone => Time::Lone,
        Which::Device => Time::Device,
        Which::Link => Time::Link,
    };
    if !results.has_areas() && (options.max_luts.is_some() || time == Time::Device) {
        let message = "these results have no areas, which --max-luts and --time device need; `afu accuracy --quick --synth` \
                       or the full study counts cells";
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
                "{}: error at most {:.1e} on the scenes, {} gross failures in {} pairs; {ns} ns at {:.0} MHz ({clock}), {luts} LUTs\n({of})",
                point.name,
                results.worst(point),
                point.tally().bad,
                results.pairs(),
                point.clock_mhz(),
            );
            let stdout_taken = options.out.as_deref().is_some_and(output::is_stdout);
            output::show(&text, stdout_taken)?;
            let config = to_build(&results, point, time);
            match &options.out {
                Some(path) => output::json(path, &json!({ "schema": MANIFEST_SCHEMA, "config": config })),
                None => output::show(&format!("options: {}", config.flags().join(" ")), false),
            }
        }
        Err(instead) => {
            let mut message = format!("nothing meets these bounds ({of})");
            for instead in &instead {
                message += &format!("; {} would do: {}", instead.bound.words(instead.value), instead.point.name);
            }
            if instead.is_empty() {
                message += "; more than one of them would have to give way";
            }
            Err(Failure::new(Kind::Failed, message))
        }
    }
}

impl Choose {
    fn results(&self) -> Result<Study, Failure> {
        let Some(path) = &self.from else { return committed().ends(Kind::Other) };
        let path = if path.is_dir() { path.join("results.json") } else { path.clone() };
        let fail = |error: &dyn std::fmt::Display| Failure::new(Kind::Usage, format!("{}: {error}", path.display()));
        let text = fs::read(&path).map_err(|error| fail(&error))?;
        serde_json::from_slice(&text).map_err(|error| fail(&error))
    }
}
