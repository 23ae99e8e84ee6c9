//! What `afu paper` does: measures, simulates, writes.

use std::fs;
use std::path::Path;

use contact_afu::kernel::Flow;
use contact_afu::ode::{self, Benchmark, Collider, Diamond, Ode};
use contact_afu::paper::measure::{Measured, measure};
use contact_afu::paper::{
    Claim, Experiment, Published, SCHEMA, Settings, SimulateError, Simulated, Size, Summary, Task, claims, figure6,
    figure7, page, per_collision, simulate,
};
use contact_afu::report::folder::{self, replace_file};
use contact_afu::report::table::{grouped, table};
use contact_afu::verify::Bench;
use serde::Serialize;

use super::failure::{Classify, Failure, Kind};
use super::paper::Paper;
use super::{link, origin, output, progress};

/// Points of the simulation, from which a later run goes on.
const SIMULATED: &str = "simulated.json";

pub fn run(options: &Paper) -> Result<(), Failure> {
    let size = if options.quick { Size::Quick } else { Size::Full };
    let config = options.machine.at_full_rate(options.machine.machine.config()?, &options.link)?;
    let link = link::read(&options.link, config.clock_mhz)?;
    let set_up_ns = (link.session.set_up + link.session.tear_down) as f64 * 1000.0 / config.clock_mhz;
    folder::check(&options.out, options.force)?;

    let counts = size.all(options.n_col_max as usize);
    let measured = options.measured(&counts)?;

    let spinner = progress::spinner("building the AFU's model");
    let bench = Bench::new(&config);
    spinner.finish_and_clear();
    let bench = bench?;

    let settings = Settings {
        command: origin::command(),
        processor: origin::processor(),
        h_max: options.h_max,
        d_sph: options.d_sph,
        t_col: options.t_col.clone(),
        n_col_max: measured.recording.collisions.len(),
        executions: options.executions,
        transactions: options.transactions,
        steps: measured.recording.steps + 1,
        steps_of_a_run: Benchmark::paper(1).steps_of_a_run,
        clock_ns: measured.recording.clock_ns,
        level: measured.level.to_owned(),
        scpus: config.scpus,
        profile: config.profile.to_string(),
        shell: config.shell.to_string(),
        clock_mhz: config.clock_mhz,
        link: link.name.clone(),
        set_up_ns,
        seed: options.seed,
        rtl_sha256: bench.rtl_sha256(),
    };
    fs::create_dir_all(&options.out).ends(Kind::Other)?;
    replace_file(&options.out.join("manifest.json"), &bytes(&Manifest { schema: SCHEMA, settings: &settings })?)?;

    let pairs = measured.recording.pairs(usize::MAX);
    let task =
        Task { bench: &bench, link: &link, pairs: &pairs, seed: options.seed, transactions: options.transactions };
    let simulated = options.simulated(&task, &counts)?;
    let results = Experiment::new(settings, size, &measured.points, &simulated.points, &Published::PAPER);
    write(&options.out, &results)?;
    if let Some(summary) = results.summary() {
        output::show(&told(&summary), false)?;
    }
    output::show(&format!("{}", options.out.join("report.html").display()), false)
}

impl Paper {
    fn measured(&self, counts: &[usize]) -> Result<Measured, Failure> {
        let flow = Flow::ALL.into_iter().find(|flow| flow.name() == self.t_col).unwrap_or(Flow::Real);
        let benchmark = Benchmark {
            diamond: Diamond::new(self.h_max, self.d_sph),
            flow,
            executions: self.executions,
            ..Benchmark::paper(self.n_col_max as usize)
        };
        let ode = Ode::start(Collider::Own)?;
        let bar = progress::bar("recording collisions, timing ODE:", "points", counts.len() as u64);
        let passes = if self.quick { 3 } else { 10 };
        let measured = measure(&ode, &benchmark, counts, passes, |points| bar.set_position(points as u64));
        bar.finish_and_clear();
        Ok(measured?)
    }

    fn simulated(&self, task: &Task, counts: &[usize]) -> Result<Simulated, Failure> {
        let file = self.out.join(SIMULATED);
        // What cannot be read is of another task.
        let earlier = fs::read(&file).ok().and_then(|bytes| serde_json::from_slice::<Simulated>(&bytes).ok());
        let bar = progress::bar("simulating the AFU:", "collisions", 0);
        let simulated = simulate(task, counts, earlier, |points, done, of| {
            bar.set_length(of as u64);
            bar.set_position(done as u64);
            Ok::<_, Failure>(replace_file(&file, &bytes(points)?)?)
        });
        bar.finish_and_clear();
        simulated
    }
}

#[derive(Serialize)]
struct Manifest<'a> {
    schema: &'static str,
    settings: &'a Settings,
}

#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    version: &'static str,
    settings: &'a Settings,
    summary: Option<Summary>,
    claims: &'a [Claim],
    points: &'a [contact_afu::paper::Joined],
}

fn write(out: &Path, results: &Experiment) -> Result<(), Failure> {
    let claims = claims(&Published::PAPER);
    let (schema, version) = (SCHEMA, env!("CARGO_PKG_VERSION"));
    let (settings, summary, points) = (&results.settings, results.summary(), &results.points[..]);
    let document = Document { schema, version, settings, summary, claims: &claims, points };
    let csv = |points| Experiment::csv(points).ends(Kind::Other);
    let files = [
        ("figure6.svg", figure6(results).svg().into_bytes()),
        ("figure7.svg", figure7(results).svg().into_bytes()),
        ("per-collision.svg", per_collision(results).svg().into_bytes()),
        ("figure6.csv", csv(&results.figure6())?),
        ("figure7.csv", csv(&results.figure7())?),
        ("results.json", bytes(&document)?),
        ("report.html", page(results, &claims, &Published::PAPER).into_bytes()),
    ];
    for (name, bytes) in files {
        replace_file(&out.join(name), &bytes)?;
    }
    Ok(())
}

fn bytes(value: &impl Serialize) -> Result<Vec<u8>, Failure> {
    let mut text = serde_json::to_vec_pretty(value).ends(Kind::Other)?;
    text.push(b'\n');
    Ok(text)
}

fn told(s: &Summary) -> String {
    let from = |at: Option<usize>| at.map_or("never".to_owned(), |at| grouped(at as u64));
    let row = |who: &str, ns: f64, gain: f64, at: Option<usize>| {
        [who.to_owned(), format!("{ns:.2}"), format!("{gain:.2}"), from(at)]
    };
    let afu = ["AFU with set-up (simulated)".to_owned(), format!("{:.2}", s.afu_ns), "1.00".to_owned(), "-".to_owned()];
    let rows = [
        afu,
        row("ODE, paper's rule (measured)", s.ode_rule_ns, s.speed_up_over_rule, s.crossover_over_rule),
        row("ODE, loop of calls (measured)", s.ode_loop_ns, s.speed_up_over_loop, s.crossover_over_loop),
        row("f32 kernel in batch (measured)", s.batch_ns, s.speed_up_over_batch, s.crossover_over_batch),
    ];
    let title = format!(
        "{} collisions; the link allows {:.2} ns each, and the AFU reaches {:.1} % of that, set-up apart",
        grouped(s.collisions as u64),
        s.link_limit_ns,
        100.0 * s.link_share
    );
    format!("{title}\n{}", table(&["who", "ns a collision", "time over the AFU's", "AFU faster from"], rows))
}

impl From<ode::Error> for Failure {
    fn from(error: ode::Error) -> Self {
        use ode::Error::{Flow, Number, TooFew};
        let kind = if matches!(error, Number { .. } | TooFew { .. } | Flow(_)) { Kind::Usage } else { Kind::Other };
        Self::caused(kind, error)
    }
}

impl From<SimulateError> for Failure {
    fn from(error: SimulateError) -> Self {
        match error {
            SimulateError::Verify(error) => error.into(),
            SimulateError::Wrong { .. } => Self::caused(Kind::Failed, error),
        }
    }
}
