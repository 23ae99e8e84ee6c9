//! The results of the experiment, as data.

use serde::{Deserialize, Serialize};

use super::{Published, Size};

/// The schema of `results.json`.
pub const SCHEMA: &str = "contact-afu/paper/1";

/// The settings, and the tools that were used.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Settings {
    /// The command that repeats the experiment.
    pub command: String,
    /// The processor on which times were measured.
    pub processor: String,
    /// Layers of the diamond: hMax.
    pub h_max: u32,
    /// Gap between spheres: dSph.
    pub d_sph: f64,
    /// Kind of collision: tCol.
    pub t_col: String,
    /// The most collisions: nColMax.
    pub n_col_max: usize,
    /// The number of executions of each collision over which ODE's time is averaged.
    pub executions: u32,
    /// The number of transactions over which the AFU's time is averaged, up to 1000 collisions. Above, it is one.
    pub transactions: u32,
    /// The number of steps from which the collisions were recorded.
    pub steps: usize,
    /// Number of steps after which the diamond is rebuilt.
    pub steps_of_a_run: usize,
    /// Time of one reading of the clock, ns; part of each measurement by the paper's rule.
    pub clock_ns: f64,
    /// Instruction set of the f32 kernel.
    pub level: String,
    /// SCPUs of the AFU.
    pub scpus: u32,
    /// The arithmetic of the AFU.
    pub profile: String,
    /// The shell of the AFU.
    pub shell: String,
    /// The assumed clock of the AFU, MHz.
    pub clock_mhz: f64,
    /// The link model.
    pub link: String,
    /// Time around each transaction, before and after together, in ns, from the link model.
    pub set_up_ns: f64,
    /// Seed of the link.
    pub seed: u64,
    /// SHA-256 of the Verilog.
    pub rtl_sha256: String,
}

/// Times for a number of collisions, measured on this machine. Each is in ns for all of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OdePoint {
    /// Number of collisions.
    pub collisions: usize,
    /// ODE by the paper's rule: each collision is executed several times, and the averages are added.
    pub rule_ns: f64,
    /// ODE's calls in a loop that is timed as a whole: the shortest pass.
    pub loop_ns: f64,
    /// The same loop: the median pass.
    pub loop_median_ns: f64,
    /// The f32 kernel in batch, in its own layout: the shortest pass.
    pub batch_ns: f64,
    /// The f32 kernel from records to records.
    pub records_ns: f64,
}

/// The result of a number of collisions through the simulated AFU.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AfuPoint {
    /// Number of collisions in the transaction.
    pub collisions: usize,
    /// Transactions simulated.
    pub transactions: u32,
    /// Cycles, averaged over the transactions.
    pub cycles: f64,
    /// The fewest cycles of a transaction.
    pub least_cycles: u64,
    /// The most cycles of a transaction.
    pub most_cycles: u64,
    /// The link limit: the minimum number of cycles.
    pub limit_cycles: f64,
    /// Contacts that the AFU counted.
    pub contacts: u64,
}

/// Measured and simulated results for one number of collisions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Joined {
    /// Number of collisions.
    pub collisions: usize,
    /// ODE by the paper's rule, measured, ns.
    pub ode_rule_ns: f64,
    /// ODE in a loop, measured, ns.
    pub ode_loop_ns: f64,
    /// ODE in a loop, the median pass, ns.
    pub ode_loop_median_ns: f64,
    /// The f32 kernel in batch, measured, ns.
    pub batch_ns: f64,
    /// The f32 kernel from records to records, measured, ns.
    pub records_ns: f64,
    /// The AFU, simulated: cycles of the RTL over the link.
    pub afu_cycles: f64,
    /// The fewest cycles of a transaction.
    pub afu_least_cycles: u64,
    /// The most cycles of a transaction.
    pub afu_most_cycles: u64,
    /// Transactions in the average.
    pub afu_transactions: u32,
    /// The time of these cycles at the clock, ns.
    pub afu_ns: f64,
    /// The same with the link's set-up and tear-down, ns.
    pub afu_total_ns: f64,
    /// The link limit, ns.
    pub link_limit_ns: f64,
    /// Contacts that the AFU found.
    pub afu_contacts: u64,
    /// The paper's ODE: its ns per collision times the number of collisions.
    pub paper_ode_ns: f64,
    /// The paper's AFU, with the set-up that its crossover implies.
    pub paper_afu_ns: f64,
}

/// All results.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// The request.
    pub settings: Settings,
    /// The numbers of collisions.
    pub size: Size,
    /// The points, in increasing order of collisions.
    pub points: Vec<Joined>,
}

/// The summary at the largest number of collisions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The number of collisions.
    pub collisions: usize,
    /// ns per collision: ODE by the paper's rule, measured.
    pub ode_rule_ns: f64,
    /// ODE in a loop, measured.
    pub ode_loop_ns: f64,
    /// The f32 kernel in batch, measured.
    pub batch_ns: f64,
    /// The f32 kernel from records to records, measured.
    pub records_ns: f64,
    /// The AFU with set-up, simulated.
    pub afu_ns: f64,
    /// Contacts that the AFU found among them. It gets numbers rounded to binary32.
    pub afu_contacts: u64,
    /// The link limit.
    pub link_limit_ns: f64,
    /// The share of the link limit that is reached, without set-up.
    pub link_share: f64,
    /// The time of ODE in a loop over the AFU's.
    pub speed_up_over_loop: f64,
    /// The time of ODE by the paper's rule over the AFU's.
    pub speed_up_over_rule: f64,
    /// The time of the f32 kernel in batch over the AFU's.
    pub speed_up_over_batch: f64,
    /// The smallest number of collisions from which the AFU is always faster than ODE in a loop; `None` if never.
    pub crossover_over_loop: Option<usize>,
    /// The same against the paper's rule.
    pub crossover_over_rule: Option<usize>,
    /// The same against the f32 kernel in batch.
    pub crossover_over_batch: Option<usize>,
}

impl Experiment {
    /// Joins measured and simulated points that have the same number of collisions.
    pub fn new(settings: Settings, size: Size, ode: &[OdePoint], afu: &[AfuPoint], paper: &Published) -> Self {
        let join = |ode: &OdePoint| {
            let afu = afu.iter().find(|afu| afu.collisions == ode.collisions)?;
            let cycle_ns = 1000.0 / settings.clock_mhz;
            let afu_ns = afu.cycles * cycle_ns;
            let n = ode.collisions as f64;
            Some(Joined {
                collisions: ode.collisions,
                ode_rule_ns: ode.rule_ns,
                ode_loop_ns: ode.loop_ns,
                ode_loop_median_ns: ode.loop_median_ns,
                batch_ns: ode.batch_ns,
                records_ns: ode.records_ns,
                afu_cycles: afu.cycles,
                afu_least_cycles: afu.least_cycles,
                afu_most_cycles: afu.most_cycles,
                afu_transactions: afu.transactions,
                afu_ns,
                afu_total_ns: afu_ns + settings.set_up_ns,
                link_limit_ns: afu.limit_cycles * cycle_ns,
                afu_contacts: afu.contacts,
                paper_ode_ns: paper.ode_total_ns(n),
                paper_afu_ns: paper.afu_total_ns(n),
            })
        };
        let points = ode.iter().filter_map(join).collect();
        Self { settings, size, points }
    }

    /// The points of Figure 6.
    pub fn figure6(&self) -> Vec<&Joined> {
        self.at(&self.size.figure6(usize::MAX))
    }

    /// The points of Figure 7.
    pub fn figure7(&self) -> Vec<&Joined> {
        self.at(&self.size.figure7(usize::MAX))
    }

    fn at(&self, counts: &[usize]) -> Vec<&Joined> {
        self.points.iter().filter(|point| counts.contains(&point.collisions)).collect()
    }

    /// The summary; `None` without points.
    pub fn summary(&self) -> Option<Summary> {
        let last = self.points.last()?;
        let each = |total: f64| total / last.collisions as f64;
        Some(Summary {
            collisions: last.collisions,
            ode_rule_ns: each(last.ode_rule_ns),
            ode_loop_ns: each(last.ode_loop_ns),
            batch_ns: each(last.batch_ns),
            records_ns: each(last.records_ns),
            afu_ns: each(last.afu_total_ns),
            afu_contacts: last.afu_contacts,
            link_limit_ns: each(last.link_limit_ns),
            link_share: last.link_limit_ns / last.afu_ns,
            speed_up_over_loop: last.ode_loop_ns / last.afu_total_ns,
            speed_up_over_rule: last.ode_rule_ns / last.afu_total_ns,
            speed_up_over_batch: last.batch_ns / last.afu_total_ns,
            crossover_over_loop: self.crossover(|point| point.ode_loop_ns),
            crossover_over_rule: self.crossover(|point| point.ode_rule_ns),
            crossover_over_batch: self.crossover(|point| point.batch_ns),
        })
    }

    /// The number of collisions from which the AFU always takes less than `other`.
    fn crossover(&self, other: impl Fn(&Joined) -> f64) -> Option<usize> {
        let wins = self.points.iter().rev().take_while(|point| point.afu_total_ns < other(point));
        wins.last().map(|point| point.collisions)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// ODE takes 50 ns per collision, the AFU 10 ns and 4 µs of set-up: equal at 100.
    pub(in crate::paper) fn example() -> Experiment {
        let settings = Settings {
            command: "afu paper --out out/paper".into(),
            processor: "a <processor>".into(),
            h_max: 3,
            d_sph: 0.0,
            t_col: "real".into(),
            n_col_max: 90_000,
            executions: 10,
            transactions: 3,
            steps: 2500,
            steps_of_a_run: 1000,
            clock_ns: 20.0,
            level: "AVX2".into(),
            scpus: 10,
            profile: "wide".into(),
            shell: "line".into(),
            clock_mhz: 200.0,
            link: "harp1".into(),
            set_up_ns: 4000.0,
            seed: 1,
            rtl_sha256: "00".into(),
        };
        let counts = Size::Quick.all(90_000);
        let ode = |&n: &usize| {
            let all = n as f64;
            let (rule_ns, loop_ns, batch_ns) = (60.0 * all, 50.0 * all, 2.0 * all);
            OdePoint { collisions: n, rule_ns, loop_ns, loop_median_ns: loop_ns, batch_ns, records_ns: 3.0 * all }
        };
        let afu = |&n: &usize| AfuPoint {
            collisions: n,
            transactions: 1,
            cycles: 2.0 * n as f64,
            least_cycles: 2 * n as u64,
            most_cycles: 2 * n as u64,
            limit_cycles: 1.9 * n as f64,
            contacts: n as u64,
        };
        let (ode, afu): (Vec<_>, Vec<_>) = counts.iter().map(|n| (ode(n), afu(n))).unzip();
        Experiment::new(settings, Size::Quick, &ode, &afu, &Published::PAPER)
    }

    #[test]
    fn the_summary_is_of_the_last_point_and_the_crossover_of_all() {
        let summary = example().summary().expect("points");
        assert_eq!((summary.collisions, summary.ode_loop_ns), (90_000, 50.0));
        assert!((summary.afu_ns - (10.0 + 4000.0 / 90_000.0)).abs() < 1e-9);
        assert!((summary.link_share - 0.95).abs() < 1e-9);
        // At 100 both are equal, which does not count as faster.
        assert_eq!((summary.crossover_over_loop, summary.crossover_over_rule), (Some(200), Some(100)));
        assert_eq!(summary.crossover_over_batch, None);
    }
}
