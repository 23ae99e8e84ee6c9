//! Claims in the paper's text that are inconsistent, with the arithmetic of each.

use serde::Serialize;

use super::Published;
use crate::kernel::Reference;
use crate::number::Format;
use crate::pairs::Set;
use crate::query::Fields;

/// Clock of the AFU's port on HARP v1, in MHz. The paper does not state a clock.
const PORT_MHZ: f64 = 200.0;
/// Bytes of a pair, and also of a contact.
const RECORD_BYTES: f64 = 32.0;

/// A claim of the paper, and what follows from it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// The claim.
    pub says: String,
    /// The section of the paper.
    pub place: &'static str,
    /// The arithmetic, with its results.
    pub arithmetic: String,
    /// What follows from it.
    pub follows: String,
}

/// The claims that are inconsistent.
pub fn claims(p: &Published) -> Vec<Claim> {
    let (ode, afu, gain) = (p.ode_ns, p.afu_ns, p.gain_ns());
    let (less, faster) = (100.0 * gain / ode, 100.0 * (ode / afu - 1.0));
    let set_up = p.set_up_ns();
    let at = |n: f64| 100.0 * (1.0 - p.afu_total_ns(n) / p.ode_total_ns(n));
    let reached = set_up / (gain - ode * p.speed_up_percent / 100.0);
    let printed_ns = p.set_up_ms * 1e6;
    let cycles = afu * PORT_MHZ / 1000.0;
    let (parallel, shared) = (RECORD_BYTES / p.link_gb_s, 2.0 * RECORD_BYTES / p.link_gb_s);
    let in_step = contacts(p.h_max);
    let layers = (p.h_max..).find(|&layers| contacts(layers) as f64 >= p.crossover).unwrap_or(p.h_max);
    let zero = 0.0_f32.sqrt();
    vec![
        Claim {
            says: format!("a speed-up of {} %; {afu} ns per collision by the AFU against {ode} ns by ODE", p.speed_up_percent),
            place: "abstract, VI, VII",
            arithmetic: format!("({ode} − {afu}) / {ode} = {less:.1} % less time; {ode} / {afu} − 1 = {faster:.1} % faster"),
            follows: format!("{} % is neither", p.speed_up_percent),
        },
        Claim {
            says: format!("the AFU is better above {} collisions; up to {} % in Figure 6, which ends at 1000", p.crossover, p.speed_up_percent),
            place: "VI",
            arithmetic: format!(
                "set-up = {} × {gain} ns = {set_up:.0} ns; at 1000: 1 − ({afu} · 1000 + {set_up:.0}) / ({ode} · 1000) = {:.1} %; {} % is reached at {reached:.0}",
                p.crossover, at(1000.0), p.speed_up_percent
            ),
            follows: format!("with this crossover and these times, Figure 6 ends at {:.1} %", at(1000.0)),
        },
        Claim {
            says: format!("the configuration before and after each transaction takes {} milliseconds on average", p.set_up_ms),
            place: "VI",
            arithmetic: format!(
                "{} ms / {gain} ns = {:.0} collisions to recover it, not {}; {} × {gain} ns = {set_up:.0} ns = 2 × {:.0} ns",
                p.set_up_ms, printed_ns / gain, p.crossover, p.crossover, set_up / 2.0
            ),
            follows: format!("the unit must be nanoseconds: {:.0} before and {:.0} after", set_up / 2.0, set_up / 2.0),
        },
        Claim {
            says: format!("with N SCPUs the time of a collision becomes T/N; N = {}", p.scpus),
            place: "III.E, VI",
            arithmetic: format!(
                "{afu} ns · {PORT_MHZ} MHz = {cycles:.1} cycles per collision; × {} SCPUs = {:.0} cycles in each",
                p.scpus, cycles * p.scpus
            ),
            follows: "the SCPUs were not pipelined, or waited for one another. The text gives neither cycles nor a clock (200 MHz is the clock of HARP's port)".to_owned(),
        },
        Claim {
            says: format!("a link of {} GB/s makes fine-grained work worth while", p.link_gb_s),
            place: "I, II",
            arithmetic: format!(
                "32 B in and 32 B out at {} GB/s: {parallel} ns with parallel directions, {shared} ns with shared bandwidth; {afu} / {shared} = {:.1}, {afu} / {parallel} = {:.1}",
                p.link_gb_s, afu / shared, afu / parallel
            ),
            follows: format!("the link allows {:.0} to {:.0} times the throughput that was reached, so it was not the limit", (afu / shared).floor(), (afu / parallel).floor()),
        },
        Claim {
            says: "Flow 2, grazing, if d < 0: the bodies barely touch".to_owned(),
            place: "III.C, Algorithm 1",
            arithmetic: format!(
                "d = √(x² + y² + z²) ≥ 0; for coincident centres d = {zero}, and {zero} < 0 is {}, {zero} ≤ 0 is {}",
                zero < 0.0, zero <= 0.0
            ),
            follows: "Flow 2 as printed never runs. ODE tests d ≤ 0, which is true for coincident centres, not for a light touch".to_owned(),
        },
        Claim {
            says: format!("real collisions of the benchmark with hMax {} and dSph 0, 10 to 1000 of them", p.h_max),
            place: "VI",
            arithmetic: format!(
                "hMax {}: {in_step} real contacts in the first step; {} / {in_step} = {:.1} steps; hMax {layers} is the first with {} in one step ({})",
                p.h_max, p.crossover, p.crossover / in_step as f64, p.crossover, contacts(layers)
            ),
            follows: "a transaction above the crossover must gather several steps. A simulation in real time cannot do this, because each step needs its contacts before the next".to_owned(),
        },
    ]
}

/// Real contacts in the first step of the diamond.
fn contacts(layers: u32) -> usize {
    let reference = Reference::new(Format::BINARY32, Fields::HIT);
    Set::Diamond(layers).pairs(0).iter().filter(|pair| reference.run(pair).is_contact()).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arithmetic_is_that_of_the_facts() {
        let claims = claims(&Published::PAPER);
        for text in [
            "= 15.7 % less time",
            "= 18.6 % faster",
            "= 4000 ns",
            "= 11.8 %",
            "125000000 collisions",
            "2 × 2000 ns",
            "= 17.2 cycles",
            "= 172 cycles",
            "4 ns with parallel",
            "8 ns with shared",
            "0 < 0 is false, 0 ≤ 0 is true",
            "36 real contacts",
            "hMax 5 is the first",
        ] {
            assert!(claims.iter().any(|claim| claim.arithmetic.contains(text)), "{text}: {claims:#?}");
        }
    }
}
