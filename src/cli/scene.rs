//! `afu scene`: runs a scene with only the effects that it asks for.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use contact_afu::config::{self, Config, Input, Shell};
use contact_afu::kernel::Reference;
use contact_afu::report::folder::{self, Folder};
use contact_afu::scene::{self, Cost, Detector, Part, Plan, Scene as Story, SceneError, SceneRun, Still};
use contact_afu::spheres::{Decided, Search, Spheres};

use super::failure::{Classify, Failure, Kind};
use super::{output, progress};

/// Run a scene of bodies with an AFU that computes only what the scene needs
///
/// A scene is a TOML file of bodies, effects such as gravity and friction, and the outputs you want. docs/scene.md
/// lists its keys; examples/scenes has five scenes. The AFU computes only the fields of a contact that the scene needs,
/// and only the effects of the scene run in ODE, the Open Dynamics Engine.
#[derive(Args, Clone, Debug)]
pub struct Scene {
    /// Scene to run, a TOML file
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Show what is on and off and which line of the scene needs it; run nothing
    #[arg(long)]
    plan: bool,
    /// Show how the plan and its cost change with this effect added; run nothing
    #[arg(long, value_name = "EFFECT", conflicts_with = "without")]
    with: Option<String>,
    /// Show how the plan and its cost change without this effect; run nothing
    #[arg(long, value_name = "EFFECT")]
    without: Option<String>,
    /// Engine that computes the contacts
    #[arg(long, value_name = "ENGINE", default_value = "ode")]
    engine: Who,
    /// Logic around the AFU's line port, as for `afu rtl`: spl2, axi or line
    #[arg(long, value_name = "SHELL", default_value_t = Shell::Spl2)]
    shell: Shell,
    /// Bits of the AXI4 master's data, only for --shell axi: 128, 256 or 512 [default: 512]
    #[arg(long, value_name = "BITS")]
    bus: Option<u32>,
    /// SCPUs that only decide which pairs touch, in front of one that computes a contact in eight pairs: 1, 2 or 4
    ///
    /// With --plan the cost is shown beside the one without them.
    #[arg(long, value_name = "N")]
    decide: Option<u32>,
    /// What the AFU is sent: `direct`, the pairs that could touch; or `spheres`, all of which it searches itself
    ///
    /// With --plan and spheres, a model says how long AFUs of several sizes take for the scene's start.
    #[arg(long, value_name = "INPUT", default_value_t = Input::Direct)]
    input: Input,
    /// Spheres that the AFU's table holds, for --input spheres [default: enough for all bodies]
    #[arg(long, value_name = "N")]
    table: Option<u32>,
    /// Boxes of spheres that are compared in a cycle, for --input spheres [default: 16]
    #[arg(long, value_name = "N")]
    lanes: Option<u32>,
    /// Kernels that decide candidates, for --input spheres [default: 4]
    #[arg(long, value_name = "N")]
    deciders: Option<u32>,
    /// Folder to write: report.html, manifest.json, and the outputs of the scene as CSV
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write into the folder even if afu did not make it; other files in it stay
    #[arg(long, requires = "out")]
    force: bool,
    /// Also write the results as JSON (schema contact-afu/scene/1) to a file, or to standard output for -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write trajectories as npy (f64, steps × bodies × 3) instead of CSV
    #[arg(long)]
    npy: bool,
    /// Count LUTs with Yosys; this takes about a minute per configuration, and the counts are cached
    #[arg(long)]
    luts: bool,
    /// Do not count LUTs for --with and --without, which otherwise do if Yosys is installed
    #[arg(long, conflicts_with = "luts")]
    no_luts: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Who {
    /// The AFU, simulated with Verilator; ODE moves the bodies
    Ode,
    /// The reference kernel in software, with the same arithmetic; faster
    Reference,
}

pub fn run(options: &Scene) -> Result<(), Failure> {
    let story = Story::read(&options.file)?;
    let plan = options.plan(&story)?;
    let other = match (&options.with, &options.without) {
        (Some(effect), _) => Some(story.switched(effect, true)?),
        (_, Some(effect)) => Some(story.switched(effect, false)?),
        _ => None,
    };
    if let Some(other) = other {
        let other_plan = options.plan(&other)?;
        let mut costs = (options.compared(&plan.config)?, options.compared(&other_plan.config)?);
        (costs.0.host_step_ns, costs.1.host_step_ns) = (host_step(&story, &plan)?, host_step(&other, &other_plan)?);
        return output::show(&plan.difference(&other_plan, &costs.0, &costs.1), false);
    }
    if options.plan {
        let costs = match options.decide {
            None => options.cost(&plan.config)?.text(),
            Some(_) => {
                let without = Scene { decide: None, ..options.clone() }.plan(&story)?;
                let costs = [options.compared(&without.config)?, options.compared(&plan.config)?];
                scene::costs(&[("without deciders", &costs[0]), ("with them", &costs[1])])
            }
        };
        let predicted = match self::start(&story, &plan)? {
            Some(sets) => {
                format!("\n\n{}", super::spheres::predictions("the scene's start", &sets, &plan.config, None)?)
            }
            None => String::new(),
        };
        return output::show(&format!("{}\n\n{costs}{predicted}", plan.text()), false);
    }
    // Fails before a model is built in vain.
    #[cfg(not(feature = "ode"))]
    if Plan::moves(&story) {
        return Err(without_ode());
    }
    scene::check_start(&story, &plan)?;
    if let Some(out) = &options.out {
        folder::check(out, options.force)?;
    }
    let mut results = options.results(&story, &plan)?;
    if options.luts {
        results.cost = options.cost(&plan.config)?;
        results.everything = options.cost(&plan.everything())?;
    }
    if let Some(out) = &options.out {
        let ladder = options.ladder(&story)?;
        options.write(out, &plan, &results, &ladder)?;
    }
    let stdout_taken = options.json.as_deref().is_some_and(output::is_stdout);
    output::show(&format!("{}\n\n{}", results.text(), results.costs()), stdout_taken)?;
    match &options.json {
        Some(path) => output::json(path, &results.json()),
        None => Ok(()),
    }
}

impl Scene {
    /// The plan of a scene, for the shell of the options.
    fn plan(&self, story: &Story) -> Result<Plan, Failure> {
        let plan = Plan::of(story)?;
        let bus = self.bus.unwrap_or(plan.config.bus);
        let plan = plan.below(self.shell, bus);
        let plan = match self.decide {
            Some(deciders) => plan.decided_by(deciders),
            None => plan,
        };
        let plan = if self.input == Input::Spheres { plan.of_spheres(self.search(story)?) } else { plan };
        let sizes = [("--table", self.table), ("--lanes", self.lanes), ("--deciders", self.deciders)];
        if let (Input::Direct, Some((option, _))) = (self.input, sizes.iter().find(|(_, given)| given.is_some())) {
            return Err(Failure::new(Kind::Usage, format!("{option} is of a search: give --input spheres as well")));
        }
        plan.config.check()?;
        Ok(plan)
    }

    /// The search that is asked for, with a table for all bodies.
    fn search(&self, story: &Story) -> Result<config::Search, Failure> {
        let sets = Still::of(story)?.sets().0;
        let usual = config::Search::default();
        Ok(config::Search {
            table: self.table.map_or_else(|| super::spheres::table_for("the scene", &sets), Ok)?,
            lanes: self.lanes.unwrap_or(usual.lanes),
            deciders: self.deciders.unwrap_or(usual.deciders),
            ..usual
        })
    }

    fn cost(&self, config: &Config) -> Result<Cost, Failure> {
        let mut cost = Cost::of(config)?;
        if self.luts {
            let spinner = progress::spinner("counting LUTs with Yosys");
            let counted = cost.count(config);
            spinner.finish_and_clear();
            counted?;
        }
        Ok(cost)
    }

    /// The cost for a comparison, with LUTs if Yosys is installed.
    fn compared(&self, config: &Config) -> Result<Cost, Failure> {
        let mut cost = self.cost(config)?;
        if !self.no_luts && cost.luts.is_none() && contact_afu::tools::Program::yosys().is_ok() {
            let spinner = progress::spinner("counting LUTs with Yosys");
            let counted = cost.count(config);
            spinner.finish_and_clear();
            counted?;
        }
        Ok(cost)
    }

    /// The cost of a touching-only query, then with one effect of the scene added after another.
    fn ladder(&self, story: &Story) -> Result<Vec<(String, Cost)>, Failure> {
        let rung = |(name, story): (String, Story)| {
            let plan = self.plan(&story)?;
            let mut cost = self.cost(&plan.config)?;
            cost.host_step_ns = host_step(&story, &plan)?;
            Ok((name, cost))
        };
        scene::ladder(story)?.into_iter().map(rung).collect()
    }

    fn results(&self, story: &Story, plan: &Plan) -> Result<SceneRun, Failure> {
        match self.engine {
            Who::Reference if plan.config.input == Input::Spheres => {
                self.go(story, plan, Detector::Spheres(&mut in_software(plan)?), "the search in software")
            }
            Who::Reference => {
                let mut reference = plan.config.profile.reference(plan.config.contact);
                self.go(story, plan, Detector::Pairs(&mut reference), "the reference kernel in software")
            }
            Who::Ode => self.simulated(story, plan),
        }
    }

    #[cfg(feature = "cosim")]
    fn simulated(&self, story: &Story, plan: &Plan) -> Result<SceneRun, Failure> {
        use contact_afu::link::LinkModel;
        use contact_afu::verify::{Bench, BenchEngine, BenchFinder};
        if !plan.has(Part::Hit) {
            let mut nobody = plan.config.profile.reference(plan.config.contact);
            return self.go(story, plan, Detector::Pairs(&mut nobody), "none: the scene needs no contacts");
        }
        let spinner = progress::spinner("building the AFU's model");
        let bench = Bench::new(&plan.config);
        spinner.finish_and_clear();
        let bench = bench?;
        let name = match self.shell {
            Shell::Spl2 => "the simulated AFU".to_owned(),
            shell => format!("the simulated AFU, shell {shell}"),
        };
        let link = LinkModel::ideal();
        let (mut results, totals) = if plan.config.input == Input::Spheres {
            let mut finder = BenchFinder::new(&bench, link, 1);
            (self.go(story, plan, Detector::Spheres(&mut finder), &name)?, finder.totals())
        } else {
            let mut engine = BenchEngine::new(&bench, link, 1);
            (self.go(story, plan, Detector::Pairs(&mut engine), &name)?, engine.totals())
        };
        results.summary.cycles = Some(totals.cycles);
        Ok(results)
    }

    #[cfg(not(feature = "cosim"))]
    fn simulated(&self, _: &Story, _: &Plan) -> Result<SceneRun, Failure> {
        let message = "this program was built without simulation (feature `cosim`); use --engine reference";
        Err(Failure::new(Kind::Tool, message))
    }

    fn go(&self, story: &Story, plan: &Plan, detector: Detector<'_>, name: &str) -> Result<SceneRun, Failure> {
        if Plan::moves(story) {
            return moving(story, plan, detector, name);
        }
        Ok(scene::query(story, plan, detector, name)?)
    }

    fn write(
        &self,
        out: &std::path::Path,
        plan: &Plan,
        results: &SceneRun,
        ladder: &[(String, Cost)],
    ) -> Result<(), Failure> {
        let folder = Folder::begin(out, self.force)?;
        let mut manifest = serde_json::to_vec_pretty(&results.json()).ends(Kind::Other)?;
        manifest.push(b'\n');
        folder.write("manifest.json", &manifest)?;
        folder.write("report.html", scene::page(results, ladder).as_bytes())?;
        let texts = [
            (Part::Contacts, "contacts.csv", SceneRun::contacts_csv as fn(&SceneRun) -> String),
            (Part::Trajectories, "trajectories.csv", SceneRun::trajectories_csv),
            (Part::Energy, "energy.csv", SceneRun::energy_csv),
        ];
        for (part, name, text) in texts.into_iter().filter(|(part, ..)| plan.has(*part)) {
            if self.npy && part == Part::Trajectories {
                folder.write("trajectories.npy", &results.trajectories_npy())?;
            } else {
                folder.write(name, text(results).as_bytes())?;
            }
        }
        Ok(folder.commit()?)
    }
}

/// The search of a plan in software.
fn in_software(plan: &Plan) -> Result<Decided<Reference>, Failure> {
    let config = &plan.config;
    let search = Search::new(config.profile.arithmetic(), config.search.box_bits)
        .map_err(|error| Failure::new(Kind::Usage, error.to_string()))?;
    Ok(Decided { search, engine: config.profile.reference(config.contact) })
}

/// The spheres that a scene begins with, if they are sent.
fn start(story: &Story, plan: &Plan) -> Result<Option<Spheres>, Failure> {
    Ok(if plan.config.input == Input::Spheres { Some(Still::of(story)?.sets().0) } else { None })
}

#[cfg(feature = "ode")]
fn moving(story: &Story, plan: &Plan, detector: Detector<'_>, name: &str) -> Result<SceneRun, Failure> {
    let bar = progress::bar("running the scene:", "steps", story.steps.value);
    let results = scene::run(story, plan, detector, name, |steps| bar.set_position(steps));
    bar.finish_and_clear();
    Ok(results?)
}

/// The time of a step on this host in ns, without the engine's part: the median of the first hundred steps.
#[cfg(feature = "ode")]
fn host_step(story: &Story, plan: &Plan) -> Result<Option<f64>, Failure> {
    if !Plan::moves(story) {
        return Ok(None);
    }
    let mut story = story.clone();
    story.steps.value = story.steps.value.min(100);
    story.start.value = scene::Start::AsGiven;
    let results = if plan.config.input == Input::Spheres {
        scene::run(&story, plan, Detector::Spheres(&mut in_software(plan)?), "", |_| {})?
    } else {
        let mut reference = plan.config.profile.reference(plan.config.contact);
        scene::run(&story, plan, Detector::Pairs(&mut reference), "", |_| {})?
    };
    Ok(Some(results.summary.step_ns))
}

#[cfg(not(feature = "ode"))]
fn host_step(_: &Story, _: &Plan) -> Result<Option<f64>, Failure> {
    Ok(None)
}

#[cfg(not(feature = "ode"))]
fn moving(_: &Story, _: &Plan, _: Detector<'_>, _: &str) -> Result<SceneRun, Failure> {
    Err(without_ode())
}

#[cfg(not(feature = "ode"))]
fn without_ode() -> Failure {
    let install = contact_afu::tools::ode_install("scene FILE");
    let message = format!(
        "this program was built without the Open Dynamics Engine, which moves the bodies of this scene; to get it: \
         {install}"
    );
    Failure::new(Kind::Tool, message)
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        let kind = match error {
            SceneError::Value { .. }
            | SceneError::Form { .. }
            | SceneError::Read { .. }
            | SceneError::Effect(..)
            | SceneError::Predict(_) => Kind::Usage,
            SceneError::Afu(error) => return error.into(),
            SceneError::Synth(error) => return error.into(),
            #[cfg(feature = "ode")]
            SceneError::Ode(_) => Kind::Other,
            SceneError::Engine(_) => Kind::Failed,
        };
        Self::caused(kind, error)
    }
}
