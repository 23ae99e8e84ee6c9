//! The figures of the paper's text.

/// The figures in the paper's text. The paper has no table, and its plots have no values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Published {
    /// ns per collision by ODE (section VI, about Figure 7).
    pub ode_ns: f64,
    /// ns per collision by the AFU (section VI, about Figure 7).
    pub afu_ns: f64,
    /// Collisions above which the AFU is always better (section VI, about Figure 6).
    pub crossover: f64,
    /// The speed-up, in percent (abstract, sections VI and VII).
    pub speed_up_percent: f64,
    /// The "configuration time before and after each transaction", in the unit that is printed: milliseconds
    /// (section VI).
    pub set_up_ms: f64,
    /// SCPUs (section VI).
    pub scpus: f64,
    /// The link's bandwidth in GB/s (abstract, section II).
    pub link_gb_s: f64,
    /// The benchmark's hMax (section VI).
    pub h_max: u32,
}

impl Published {
    /// The figures of the paper.
    pub const PAPER: Self = Self {
        ode_ns: 102.0,
        afu_ns: 86.0,
        crossover: 250.0,
        speed_up_percent: 14.5,
        set_up_ms: 2000.0,
        scpus: 10.0,
        link_gb_s: 8.0,
        h_max: 3,
    };

    /// ns that the AFU saves on each collision.
    pub(crate) fn gain_ns(&self) -> f64 {
        self.ode_ns - self.afu_ns
    }

    /// The time around a transaction, in ns, that makes both equal at the crossover.
    pub(crate) fn set_up_ns(&self) -> f64 {
        self.crossover * self.gain_ns()
    }

    /// Time of the paper's ODE for this number of collisions, in ns.
    pub(crate) fn ode_total_ns(&self, collisions: f64) -> f64 {
        self.ode_ns * collisions
    }

    /// Time of the paper's AFU for this number of collisions, in ns, with the set-up that follows from its crossover.
    pub fn afu_total_ns(&self, collisions: f64) -> f64 {
        self.afu_ns * collisions + self.set_up_ns()
    }
}
