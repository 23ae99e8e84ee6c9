//! The search for spheres beside its peers: times that were measured on a processor, and times of the simulated AFU.
//!
//! `benches/spheres` fills in a [`Row`] per set of spheres, and [`Times::write`] makes table, CSV, pictures and page.

mod columns;
mod figures;
mod goals;
mod output;
mod page;

pub use goals::Goal;

/// What was measured and simulated, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Times {
    /// The machine, the AFUs and the command.
    pub settings: Settings,
    /// One row per set of spheres.
    pub rows: Vec<Row>,
}

/// The machine, the AFUs and the command.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Settings {
    /// The command that gives these results.
    pub command: String,
    /// The processor on which times were measured.
    pub processor: String,
    /// The instruction set of the kernel in software.
    pub level: String,
    /// The link between the AFU and memory.
    pub link: String,
    /// The clock of the AFU, MHz.
    pub clock_mhz: f64,
    /// Spheres of the first set, at most.
    pub table: u32,
    /// Boxes of spheres that are compared in a cycle.
    pub lanes: u32,
    /// Kernels that decide candidates.
    pub deciders: u32,
    /// SCPUs of the AFU that is sent spheres and returns contacts.
    pub scpus: u32,
    /// SCPUs of the AFU that is sent pairs.
    pub pair_scpus: u32,
    /// Their interval.
    pub pair_interval: u32,
    /// The seed of the sets and of the link.
    pub seed: u64,
    /// SHA-256 of the Verilog of the AFU that returns numbers, of the one that returns contacts, and of the one that is
    /// sent pairs.
    pub rtl_sha256: [String; 3],
}

/// The times of one set.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The name of the set, as `afu cosim --spheres` takes it.
    pub set: String,
    /// Spheres, of both sets if there are two.
    pub spheres: u64,
    /// Pairs that touch.
    pub contacts: u64,
    /// Times on the processor.
    pub measured: Measured,
    /// Times of the AFU, if it was simulated.
    pub simulated: Option<Simulated>,
}

/// Times on one thread of a processor, ns per sphere. `None`: this build has no such peer, or the peer does not take
/// such spheres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Sorting along a Hilbert curve.
    pub sorting: Option<f64>,
    /// The search of this crate, for the numbers of the spheres that touch.
    pub search_numbers: Option<f64>,
    /// The same with contacts.
    pub search_contacts: Option<f64>,
    /// A SIMD cell list, for numbers.
    pub cells_numbers: Option<f64>,
    /// The same with contacts.
    pub cells_contacts: Option<f64>,
    /// ODE's hash space with `dCollide`.
    pub ode_hash: Option<f64>,
    /// ODE's sweep-and-prune space with `dCollide`.
    pub ode_sweep: Option<f64>,
    /// parry3d's trees of boxes with its contacts.
    pub parry: Option<f64>,
}

/// The jobs of the simulated AFUs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulated {
    /// Spheres in, the numbers of those that touch out.
    pub numbers: Job,
    /// Spheres in, contacts out.
    pub contacts: Job,
    /// The pairs that the cell list finds in, contacts out. The time to find them is not included.
    pub pairs: Job,
}

/// A job of a simulated AFU.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Job {
    /// Clock cycles from start to done.
    pub cycles: u64,
    /// Nanoseconds per sphere at the clock.
    pub ns: f64,
    /// Throughput as a share of the link limit, 0 to 1.
    pub link_share: f64,
}

impl Row {
    /// The faster of ODE's spaces, ns per sphere.
    pub fn ode_best(&self) -> Option<f64> {
        let spaces = [self.measured.ode_hash, self.measured.ode_sweep];
        spaces.into_iter().flatten().min_by(f64::total_cmp)
    }

    fn over(&self, job: fn(&Simulated) -> Job, peer: Option<f64>) -> Option<f64> {
        let ns = job(self.simulated.as_ref()?).ns;
        peer.filter(|&peer| peer > 0.0).map(|peer| ns / peer)
    }

    /// The AFU's time for numbers over the cell list's.
    pub fn numbers_over_cells(&self) -> Option<f64> {
        self.over(|simulated| simulated.numbers, self.measured.cells_numbers)
    }

    /// The AFU's time for contacts over the cell list's.
    pub fn contacts_over_cells(&self) -> Option<f64> {
        self.over(|simulated| simulated.contacts, self.measured.cells_contacts)
    }

    /// The AFU's time for numbers over that of ODE's best space, which computes contacts.
    pub fn numbers_over_ode(&self) -> Option<f64> {
        self.over(|simulated| simulated.numbers, self.ode_best())
    }

    /// The AFU's time for contacts over that of ODE's best space.
    pub fn contacts_over_ode(&self) -> Option<f64> {
        self.over(|simulated| simulated.contacts, self.ode_best())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(set: &str, spheres: u64, numbers_ns: f64) -> Row {
        let job = |ns: f64, link_share| Job { cycles: (ns * spheres as f64 / 5.0) as u64, ns, link_share };
        Row {
            set: set.to_owned(),
            spheres,
            contacts: 2 * spheres,
            measured: Measured {
                sorting: Some(140.0),
                search_numbers: Some(380.0),
                search_contacts: Some(390.0),
                cells_numbers: Some(80.0),
                cells_contacts: Some(120.0),
                ode_hash: Some(4000.0),
                ode_sweep: Some(2000.0),
                parry: None,
            },
            simulated: Some(Simulated {
                numbers: job(numbers_ns, 0.5),
                contacts: job(18.0, 0.9),
                pairs: job(30.0, 0.97),
            }),
        }
    }

    /// Two diamonds, a gas and a moved diamond.
    pub(super) fn example() -> Times {
        Times {
            settings: Settings {
                command: "cargo bench --bench spheres".to_owned(),
                processor: "a <processor>".to_owned(),
                level: "AVX-512".to_owned(),
                link: "harp1".to_owned(),
                clock_mhz: 200.0,
                table: 65_536,
                lanes: 64,
                deciders: 8,
                scpus: 1,
                pair_scpus: 10,
                pair_interval: 5,
                seed: 1,
                rtl_sha256: ["aa", "bb", "cc"].map(str::to_owned),
            },
            rows: vec![
                row("diamond:10", 1159, 12.0),
                row("diamond:30", 34_279, 8.0),
                row("diamond:30+1000", 34_279, 9.0),
                row("gas:32768:0.3", 32_768, 6.0),
            ],
        }
    }

    #[test]
    fn ratios_are_of_the_same_row_and_of_odes_best_space() {
        let rows = example().rows;
        assert_eq!(rows[1].numbers_over_cells(), Some(0.1));
        assert_eq!(rows[1].contacts_over_cells(), Some(0.15));
        assert_eq!(rows[1].numbers_over_ode(), Some(0.004));
        assert_eq!(rows[1].contacts_over_ode(), Some(0.009));
        let measured = Measured { ode_hash: None, ode_sweep: None, ..rows[0].measured };
        assert_eq!(Row { measured, ..rows[0].clone() }.numbers_over_ode(), None);
        assert_eq!(Row { simulated: None, ..rows[0].clone() }.numbers_over_cells(), None);
    }
}
