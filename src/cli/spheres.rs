//! `afu spheres`: a named set of spheres as a file, or the spheres that touch.

use std::path::{Path, PathBuf};

use clap::Args;
use contact_afu::afu::{PredictError, SearchModel};
use contact_afu::config::{self, Config, Input, Profile, Results, Shell, TABLES};
use contact_afu::pairs::check_name;
use contact_afu::query::Fields;
use contact_afu::report::table::{counted, grouped, table};
use contact_afu::spheres::{
    self, Counts, Found, LoadError, RefusedArithmetic, Search, Sphere, SphereSetError, Spheres as Sets, hilbert_order,
    reorder,
};
use serde::Serialize;

use super::failure::{Failure, Kind};
use super::{output, usage};

/// Write spheres to a file, or find which of them touch
///
/// With --out, the spheres of a named set (or of a file, with --sort in another order) are written. Otherwise they are
/// searched in software: boxes of spheres, in rows of 16, choose the candidates, and the reference kernel decides
/// these. docs/spheres.md explains it.
#[derive(Args, Debug)]
pub struct Spheres {
    /// Set of spheres, diamond:H, gas:N:FILL or probes:Q:M, or a file of spheres
    ///
    /// `diamond:H` holds the touching spheres of the paper's diamond with H layers. `gas:N:FILL` holds N spheres of
    /// equal size at random in a cube, of whose volume they are the part FILL, 0.001 to 0.74. `probes:Q:M` is two sets:
    /// M points, and Q spheres against them. A set with +D behind it, diamond:10+1000 for example, is moved by D along
    /// each axis. A file is .csv with the header x,y,z,r, or .npy with an N × 4 array.
    #[arg(value_name = "SET|FILE")]
    source: String,
    /// File of a second set: finds which of its spheres touch which of the first set
    #[arg(long, value_name = "FILE")]
    against: Option<PathBuf>,
    /// Seed of gas and probes
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = usage::seed)]
    seed: u64,
    /// Put the spheres in the order of a Hilbert curve first, which makes the search faster
    #[arg(long)]
    sort: bool,
    /// File to write the spheres to, .csv or .npy; nothing is searched
    #[arg(long, value_name = "FILE", conflicts_with_all = ["hits", "json", "against"])]
    out: Option<PathBuf>,
    /// File to write the second set of probes to, with --out
    #[arg(long, value_name = "FILE", requires = "out")]
    out_against: Option<PathBuf>,
    /// File to write the spheres that touch to, .csv or .npy: the numbers of both, and their contact
    #[arg(long, value_name = "FILE")]
    hits: Option<PathBuf>,
    /// Predict how fast hardware of several sizes finds what touches; nothing else is written
    ///
    /// A model counts the cycles of `--input spheres` for each number of --lanes and --deciders, with a table that
    /// holds the first set, at 200 MHz over --link. It counts those for numbers alone and, with more fields of
    /// --contact, those for contacts by one and by two SCPUs at interval 1.
    #[arg(long, conflicts_with_all = ["out", "hits", "json"])]
    plan: bool,
    /// Link between AFU and memory, for --plan: a name or file as in `afu cosim` [default: harp1]
    #[arg(long, value_name = "NAME|FILE", requires = "plan")]
    link: Option<String>,
    /// Arithmetic that decides: wide, exact, or eXfY with at least 10 exponent bits
    #[arg(long, value_name = "NAME|eXfY", default_value = "wide")]
    profile: Profile,
    /// Fields of a contact: a comma-separated list of hit, depth, normal, position
    #[arg(long, value_name = "FIELDS", default_value = "hit,depth,normal,position")]
    contact: Fields,
    /// Bits of a box's numbers, 10 to 32: fewer make more candidates and the same contacts
    #[arg(long, value_name = "N", default_value_t = 24)]
    box_bits: u32,
    /// File to write counts to as JSON; - writes to standard output
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// The counts as JSON. Keys are only added within a schema number.
#[derive(Serialize)]
struct Report<'a> {
    schema: &'static str,
    source: &'a str,
    seed: u64,
    profile: String,
    box_bits: u32,
    spheres: usize,
    against: Option<usize>,
    invalid: u64,
    group_tests: u64,
    row_tests: u64,
    sphere_tests: u64,
    column_tests: u64,
    candidates: u64,
    contacts: usize,
}

pub fn run(options: &Spheres) -> Result<(), Failure> {
    let sets = sets(&options.source, options.against.as_deref(), options.sort, options.seed)?;
    match &options.out {
        Some(out) => write(options, out, &sets),
        None if options.plan => plan(options, &sets),
        None => search(options, &sets),
    }
}

/// The spheres of a set or a file, with a second set of another file if there is one.
pub(super) fn sets(source: &str, against: Option<&Path>, sort: bool, seed: u64) -> Result<Sets, Failure> {
    let mut sets = load(source, seed)?;
    if let Some(against) = against {
        if sets.second.is_some() {
            let message = format!("{source}: this set has a second set of its own; leave out --against");
            return Err(Failure::new(Kind::Usage, message));
        }
        sets.second = Some(load(&against.display().to_string(), seed)?.first);
    }
    if sort {
        sets = Sets { first: sorted(&sets.first), second: sets.second.as_deref().map(sorted) };
    }
    Ok(sets)
}

/// The spheres of a set or a file. A note on standard error counts numbers that had to be rounded.
fn load(source: &str, seed: u64) -> Result<Sets, Failure> {
    let (sets, rounded) = spheres::load(source, seed)?;
    if let Some(rounded) = rounded {
        eprintln!("afu: {source}: {rounded}");
    }
    Ok(sets)
}

fn sorted(spheres: &[Sphere]) -> Vec<Sphere> {
    reorder(spheres, &hilbert_order(spheres))
}

/// The lanes and the deciders that a plan compares.
const PLANNED: [(u32, u32); 8] = [(16, 1), (16, 4), (32, 4), (64, 4), (64, 8), (128, 8), (256, 8), (256, 16)];

/// The SCPUs behind them, each of which begins a contact per cycle.
const PLANNED_SCPUS: [u32; 2] = [1, 2];

fn plan(options: &Spheres, sets: &Sets) -> Result<(), Failure> {
    let base = Config { profile: options.profile.clone(), contact: options.contact, ..Config::default() };
    let search = config::Search { table: table_for(&options.source, sets)?, ..config::Search::default() };
    let search = config::Search { box_bits: options.box_bits, ..search };
    output::show(&predictions(&options.source, sets, &Config { search, ..base }, options.link.as_deref())?, false)
}

/// The smallest table that holds the first set.
pub(super) fn table_for(source: &str, sets: &Sets) -> Result<u32, Failure> {
    let table = sets.first.len().next_power_of_two().try_into().unwrap_or(u32::MAX).max(*TABLES.start());
    if table > *TABLES.end() {
        let message = format!("{source}: {} spheres; the largest table holds {}", sets.first.len(), TABLES.end());
        return Err(Failure::new(Kind::Usage, message));
    }
    Ok(table)
}

/// What a model predicts for these sets, for each number of lanes and deciders, in the arithmetic and with the table of
/// `base`, over a link; with its fields too, if they are more than the hit.
pub(super) fn predictions(source: &str, sets: &Sets, base: &Config, link: Option<&str>) -> Result<String, Failure> {
    let name = link.unwrap_or("harp1");
    let link = &super::link::read(name, base.clock_mhz)?;
    let config = |lanes, deciders, contact, scpus| {
        let search = config::Search { lanes, deciders, ..base.search };
        let base = Config { input: Input::Spheres, results: Results::Hits, shell: Shell::Line, ..base.clone() };
        Config { contact, scpus, interval: 1, search, ..base }
    };
    let failure = |error: PredictError| Failure::new(Kind::Usage, error.to_string());
    let model = SearchModel::new(&config(16, 1, Fields::HIT, 1), sets).map_err(failure)?;
    let count = sets.count().max(1) as f64;
    let mut rows = Vec::new();
    for (lanes, deciders) in PLANNED {
        let predicted = |contact, scpus| {
            let config = config(lanes, deciders, contact, scpus);
            config.check()?;
            let predicted = model.predict(&config, link).map_err(failure)?;
            let ns = format!("{:.1}", predicted.cycles as f64 / count * config.cycle_ns());
            Ok::<_, Failure>((predicted, ns))
        };
        let (numbers, ns) = predicted(Fields::HIT, 1)?;
        let mut row = vec![lanes.to_string(), deciders.to_string(), grouped(numbers.cycles)];
        row.extend([format!("{:.2}", numbers.cycles as f64 / count), ns, numbers.slowest().to_owned()]);
        if base.contact != Fields::HIT {
            for scpus in PLANNED_SCPUS {
                row.push(predicted(base.contact, scpus)?.1);
            }
        }
        rows.push(row);
    }
    let mut head = vec!["lanes", "deciders", "cycles", "per sphere", "ns per sphere", "slowest stage"];
    if base.contact != Fields::HIT {
        head.extend(["contacts: ns, 1 SCPU", "2 SCPUs"]);
    }
    let of_table = grouped(base.search.table.into());
    let title = format!("{source}: predicted, table of {of_table}, {} MHz, link {name}", base.clock_mhz);
    Ok(format!("{title}\n{}", table(&head, rows)))
}

fn write(options: &Spheres, out: &Path, sets: &Sets) -> Result<(), Failure> {
    let files = match (&sets.second, &options.out_against) {
        (None, None) => vec![(out, &sets.first)],
        (Some(second), Some(file)) => vec![(out, &sets.first), (file, second)],
        (Some(_), None) => {
            let error = format!("{}: it is two sets; write the second one with --out-against FILE", options.source);
            return Err(Failure::new(Kind::Usage, error));
        }
        (None, Some(_)) => {
            let error = format!("{}: it has no second set; leave out --out-against", options.source);
            return Err(Failure::new(Kind::Usage, error));
        }
    };
    files.iter().try_for_each(|(file, _)| check_name(file))?;
    for (file, spheres) in files {
        spheres::write_spheres(file, spheres)?;
        output::show(&format!("{}: {}", file.display(), counted(spheres.len() as u64, "sphere")), false)?;
    }
    Ok(())
}

fn search(options: &Spheres, sets: &Sets) -> Result<(), Failure> {
    if let Some(file) = &options.hits {
        check_name(file)?;
    }
    let (first, second) = (&sets.first, sets.second.as_deref());
    let search = Search::new(options.profile.arithmetic(), options.box_bits)?;
    let mut reference = options.profile.reference(options.contact);
    let found = search.find(&mut reference, first, second).map_err(|error| Failure::new(Kind::Other, error))?;
    let Found { hits, counts } = found;
    if let Some(file) = &options.hits {
        spheres::write_hits(file, &hits)?;
    }
    let Counts { group_tests, row_tests, sphere_tests, column_tests, candidates, invalid } = counts;
    if let Some(json) = &options.json {
        let report = Report {
            schema: "contact-afu/spheres/1",
            source: &options.source,
            seed: options.seed,
            profile: options.profile.to_string(),
            box_bits: options.box_bits,
            spheres: first.len(),
            against: second.map(<[_]>::len),
            invalid,
            group_tests,
            row_tests,
            sphere_tests,
            column_tests,
            candidates,
            contacts: hits.len(),
        };
        output::json(json, &report)?;
    }
    let mut rows = vec![("spheres", first.len() as u64)];
    rows.extend(second.map(|second| ("against", second.len() as u64)));
    rows.extend([
        ("invalid spheres", invalid),
        ("a row with 16 rows", group_tests),
        ("a row with a row", row_tests),
        ("a sphere with a row", sphere_tests),
        ("a sphere with 16 spheres", column_tests),
        ("candidates: boxes that meet", candidates),
        ("contacts", hits.len() as u64),
    ]);
    let rows: Vec<_> = rows.into_iter().map(|(name, count)| vec![name.to_owned(), grouped(count)]).collect();
    let title = format!("{}: {} arithmetic, boxes of {} bits", options.source, options.profile, options.box_bits);
    let text = format!("{title}\n{}", table(&["", "count"], rows));
    output::show(&text, options.json.as_deref().is_some_and(output::is_stdout))
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        match error {
            LoadError::Set(error) => error.into(),
            LoadError::File(error) => error.into(),
        }
    }
}

impl From<SphereSetError> for Failure {
    fn from(error: SphereSetError) -> Self {
        Self::caused(Kind::Usage, error)
    }
}

impl From<RefusedArithmetic> for Failure {
    fn from(error: RefusedArithmetic) -> Self {
        Self::caused(Kind::Usage, error)
    }
}
