//! Times of the simulated AFU: the Verilog through Verilator, over a link. Every bit is compared with the software.

use std::error::Error;
use std::fs;

use contact_afu::config::{Config, Input, Results, Search, Shell};
use contact_afu::kernel::batch::Level;
use contact_afu::link::Description;
use contact_afu::outcome::Outcome;
use contact_afu::query::{Fields, PairRecord};
use contact_afu::report::spheres_times::{Job, Settings, Simulated};
use contact_afu::spheres::Spheres;
use contact_afu::{Bench, LinkModel};

use super::SEED;

const LINK: &str = "harp1";

/// The AFU that is sent spheres and returns the numbers of those that touch.
fn numbers() -> Config {
    let search = Search { table: 65_536, lanes: 64, deciders: 8, ..Search::default() };
    Config {
        input: Input::Spheres,
        search,
        results: Results::Hits,
        contact: Fields::HIT,
        scpus: 1,
        shell: Shell::Line,
        ..Config::default()
    }
}

/// The same with all fields of contacts. The link writes less than one contact per cycle, so one SCPU is enough.
fn contacts() -> Config {
    Config { contact: Fields::ALL, ..numbers() }
}

/// The AFU that is sent pairs: two per cycle, which is more than the link takes.
fn pairs() -> Config {
    Config { interval: 5, shell: Shell::Line, ..Config::default() }
}

/// The simulated AFUs and their link.
pub struct Afus {
    numbers: Bench,
    contacts: Bench,
    pairs: Bench,
    link: LinkModel,
}

impl Afus {
    pub fn new() -> Result<Self, Box<dyn Error>> {
        let [numbers, contacts, pairs] = [numbers(), contacts(), pairs()].map(|config| Bench::new(&config));
        let numbers = numbers?;
        let link = LINK.parse::<Description>()?.at(numbers.config().clock_mhz)?;
        Ok(Self { numbers, contacts: contacts?, pairs: pairs?, link })
    }

    /// The jobs of one set. `touching` are the pairs for the AFU that is sent pairs.
    pub fn run(&self, set: &str, spheres: &Spheres, touching: &[PairRecord]) -> Result<Simulated, Box<dyn Error>> {
        let count = spheres.count() as f64;
        let job = |bench: &Bench, outcome: &Outcome| Job {
            cycles: outcome.cycles,
            ns: outcome.cycles as f64 * bench.config().cycle_ns() / count,
            link_share: outcome.efficiency(),
        };
        let of_spheres = |bench: &Bench, what: &str| {
            let verdict = bench.run_spheres(spheres, &self.link, SEED, None)?;
            match verdict.is_good() {
                true => Ok(job(bench, &verdict.outcome)),
                false => Err(Box::<dyn Error>::from(format!("{set}, {what}: {}", verdict.failed_checks.join("; ")))),
            }
        };
        let numbers = of_spheres(&self.numbers, "numbers")?;
        let contacts = of_spheres(&self.contacts, "contacts")?;
        let verdict = self.pairs.run(touching, &self.link, SEED)?;
        if !verdict.is_good() {
            return Err(format!("{set}, pairs: {verdict}").into());
        }
        Ok(Simulated { numbers, contacts, pairs: job(&self.pairs, &verdict.outcome) })
    }
}

/// What these times are of; without AFUs, the Verilog has no sums.
pub fn settings(afus: Option<&Afus>, quick: bool) -> Settings {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(':'));
    let (Config { search, clock_mhz, .. }, pairs) = (numbers(), pairs());
    let features = if cfg!(feature = "parry") { "ode,parry" } else { "ode" };
    let quick = if quick { " --quick" } else { "" };
    let sums = |afus: &Afus| [&afus.numbers, &afus.contacts, &afus.pairs].map(Bench::rtl_sha256);
    Settings {
        command: format!("cargo bench --features {features} --bench spheres -- --out DIR{quick}"),
        processor: name.map_or(std::env::consts::ARCH, |(_, name)| name.trim()).to_owned(),
        level: Level::best().name().to_owned(),
        link: LINK.to_owned(),
        clock_mhz,
        table: search.table,
        lanes: search.lanes,
        deciders: search.deciders,
        scpus: contacts().scpus,
        pair_scpus: pairs.scpus,
        pair_interval: pairs.interval,
        seed: SEED,
        rtl_sha256: afus.map_or_else(Default::default, sums),
    }
}
