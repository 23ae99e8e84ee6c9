//! The accelerator beside software that does the same: `cargo bench --features ode,parry --bench peers`.
//!
//! All take the same pairs: the candidates of the paper's diamond of ten layers (12 354 pairs; 2 934 touch), repeated
//! eight times. These 98 832 pairs are more than a second-level cache holds. Software is measured on one thread of this
//! machine: the median of many passes over data in its preferred layout. The accelerator is simulated: cycles of its
//! Verilog at an assumed 200 MHz over a link model, from the start word to the status. Broad phase, packing and copying
//! are left out for all. Prints the table of README.md and docs/paper.md.

use contact_afu::config::Config;
use contact_afu::kernel::batch::{Batch, Level};
use contact_afu::link::Description;
use contact_afu::ode::{Collider, Diamond, Ode};
use contact_afu::pairs::Set;
use contact_afu::query::{Fields, PairRecord};
use contact_afu::verify::Bench;
use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

const LAYERS: u32 = 10;
const COPIES: usize = 8;
const PASSES: usize = 41;

/// Median time in ns per pair of passes over `pairs` pairs.
fn median(pairs: usize, mut pass: impl FnMut()) -> f64 {
    pass();
    let mut times: Vec<f64> = (0..PASSES)
        .map(|_| {
            let begin = Instant::now();
            pass();
            begin.elapsed().as_secs_f64() * 1e9 / pairs as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[PASSES / 2]
}

/// The fastest kernel that this machine supports, in its own layout.
fn simd(pairs: &[PairRecord]) -> (String, f64) {
    let (batch, mut contacts, level) = (Batch::from_pairs(pairs), Batch::zeros(pairs.len()), Level::best());
    let ns = median(pairs.len(), || level.run(black_box(&batch), black_box(&mut contacts), Fields::ALL));
    (format!("this crate's `f32` kernel, {}", level.name()), ns)
}

/// ODE's collider on existing spheres.
fn ode() -> Result<(String, f64), Box<dyn Error>> {
    let ode = Ode::start(Collider::Own)?;
    let simulation = Diamond::new(LAYERS, 0.0).build(&ode)?;
    let candidates = simulation.world().candidates()?;
    let ns = median(candidates.len(), || {
        for &[first, second] in &candidates {
            black_box(simulation.world().collide(first, second)).ok();
        }
    });
    Ok(("Open Dynamics Engine, `dCollide`, `f64`".to_owned(), ns))
}

/// parry on existing balls.
#[cfg(feature = "parry")]
fn parry(pairs: &[PairRecord]) -> (String, f64) {
    use parry3d::math::{Pose, Vector};
    use parry3d::{query, shape::Ball};
    let balls: Vec<_> = pairs
        .iter()
        .map(|pair| {
            let [x1, y1, z1, r1, x2, y2, z2, r2] = pair.values();
            let at = |x, y, z| Pose::from_translation(Vector::new(x, y, z));
            (at(x1, y1, z1), Ball::new(r1), at(x2, y2, z2), Ball::new(r2))
        })
        .collect();
    let ns = median(balls.len(), || {
        for (at, ball, other_at, other) in &balls {
            black_box(query::contact(at, ball, other_at, other, 0.0)).ok();
        }
    });
    ("parry3d, `query::contact`, `f32`".to_owned(), ns)
}

/// Time of the simulated accelerator in ns per pair.
fn accelerator(config: &Config, link: &str, pairs: &[PairRecord]) -> Result<f64, Box<dyn Error>> {
    let link = link.parse::<Description>()?.at(config.clock_mhz)?;
    let verdict = Bench::new(config)?.run(pairs, &link, 1)?;
    verdict.assert_good();
    Ok(verdict.outcome.cycles as f64 * 1000.0 / config.clock_mhz / pairs.len() as f64)
}

fn main() -> Result<(), Box<dyn Error>> {
    let pairs = Set::Diamond(LAYERS).pairs(1).repeat(COPIES);
    let small = Config { results: "hits".parse()?, record: "f16".parse()?, ..Config::default() };
    let configurations = [
        ("HARP v1", accelerator(&Config::default(), "harp1", &pairs)?),
        ("HARP v2", accelerator(&Config::default(), "harp2", &pairs)?),
        ("HARP v2, 16-bit records, hits only", accelerator(&small, "harp2", &pairs)?),
    ];
    let peers = [
        simd(&pairs),
        ode()?,
        #[cfg(feature = "parry")]
        parry(&pairs),
    ];

    let columns = |cell: &dyn Fn(&(&str, f64)) -> String| configurations.iter().map(cell).collect::<String>();
    println!("| one thread of software | ns per pair |{}", columns(&|(name, _)| format!(" {name} |")));
    println!("|---|---|{}", "---|".repeat(configurations.len()));
    println!("| the accelerator, simulated | |{}", columns(&|(_, ns)| format!(" {ns:.2} ns |")));
    for (name, taken) in peers {
        println!("| {name} | {taken:.2} |{}", columns(&|(_, ns)| format!(" {:.2} × |", taken / ns)));
    }
    Ok(())
}
