//! The specification of an accelerator: the configuration, and options that only proofs and integrators change.

use crate::config::{Config, INTERVALS, Input, Multipliers};
use crate::count::counted;
use crate::hdl::verilog::Memories;
use crate::hdl::{DelayModel, Reset};
use crate::query::Fields;

use super::EPOCH_BITS;
use super::spheres::HIT_LANES;
use crate::record::{COUNT_BITS, LINE_BITS, Layout};

/// Everything that affects the generated Verilog.
#[derive(Clone, Debug, PartialEq)]
pub struct Spec {
    /// The user's configuration.
    pub config: Config,
    /// How registers are reset.
    pub reset: Reset,
    /// Bits of a line: 512, or fewer for proofs.
    pub line_bits: u32,
    /// Bits of a record's word: as in the configuration's records, or fewer for proofs, whose SCPUs do not contain the
    /// kernel.
    pub word_bits: u32,
    /// The most outstanding reads, and also writes: as in the configuration, or fewer for proofs.
    pub max_outstanding: u32,
    /// The most slots that pairs and results pass: as many as there can be SCPUs, or fewer for proofs.
    pub max_hops: u32,
    /// Cycles that results may wait for their write requests before pairs wait for room: 16, or fewer for proofs.
    pub dispatch_cycles: u32,
    /// The delay of each operation on the target.
    pub delays: DelayModel,
    /// The name of the FPGA family; `None` if the Verilog is for every family.
    pub target: Option<&'static str>,
    /// The kinds of memory that the target has.
    pub memories: Memories,
}

/// Why a specification was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpecError {
    /// The configuration is invalid.
    #[error(transparent)]
    Config(#[from] crate::config::Error),
    /// A line would hold no record.
    #[error("line of {0} bits: expected a power of two that holds a pair and a contact")]
    Line(u32),
    /// The kernel does not have words of this size.
    #[error("words of {0} bits: expected the records' {1}; only an SCPU of your own may have 1 to 32")]
    Word(u32, u32),
    /// There is no room beyond the content of a pipeline, or more than memories can hold.
    #[error("{0} cycles in dispatch: expected 1 to 1024")]
    Dispatch(u32),
    /// More deciders than a line has pairs.
    #[error("decide {0}: a line has {1} pairs, so at most {1} can be decided in a cycle; use --decide {1} or fewer")]
    Decide(u32, u32),
    /// Tags cannot represent this number of requests.
    #[error("{0} outstanding requests: expected a power of two from 2 to 256")]
    Outstanding(u32),
}

impl From<Config> for Spec {
    fn from(config: Config) -> Self {
        let (word_bits, max_outstanding) = (config.record.format().width(), config.outstanding);
        Self {
            config,
            reset: Reset::default(),
            line_bits: LINE_BITS,
            word_bits,
            max_outstanding,
            max_hops: super::MAX_SCPUS,
            dispatch_cycles: 16,
            delays: DelayModel::default(),
            target: None,
            memories: Memories::Any,
        }
    }
}

impl Spec {
    /// The delay model, without multiplier blocks if the configuration says so.
    pub fn model(&self) -> DelayModel {
        self.delays.clone().with_spared_multipliers(self.config.multipliers == Multipliers::Spare)
    }

    /// The record layout.
    pub fn layout(&self) -> Layout {
        Layout::of(self.line_bits, &self.config).with_words_of(self.word_bits)
    }

    /// The specification of the part that decides which pairs touch: SCPUs that compute nothing else, one pair per
    /// cycle each. `None` if the SCPUs that compute contacts decide too.
    pub(crate) fn deciding(&self) -> Option<Self> {
        let Config { decide, .. } = self.config;
        let config = Config { scpus: decide, interval: 1, contact: Fields::HIT, ..self.config.clone() };
        (decide > 0).then(|| Self { config, max_hops: decide, ..self.clone() })
    }

    /// Bits of a tag: the job's epoch and a slot.
    pub(crate) fn tag_bits(&self) -> u32 {
        EPOCH_BITS + self.max_outstanding.ilog2()
    }

    /// Pairs that can be handed to SCPUs in one cycle: those of one line; to deciders, as many as there are.
    pub fn lanes(&self) -> u32 {
        let of_line = self.layout().pairs_per_line();
        if self.config.decide > 0 { of_line.min(self.config.decide) } else { of_line }
    }

    /// The number of SCPUs that take turns at an interval: all, or as many as take a whole number of full lines per
    /// cycle. The others are not built.
    pub fn scpus_in_turn(&self, interval: u32) -> u32 {
        let whole = self.lanes() * interval;
        match self.config.scpus {
            scpus if self.config.has_deciders() => {
                let lanes = self.contact_lanes(interval);
                lanes * (scpus / lanes).min(interval.max(1))
            }
            scpus if interval > 1 && scpus > whole => scpus / whole * whole,
            scpus => scpus,
        }
    }

    /// Behind deciders, the contacts whose computation begins in the same cycle, side by side. Of pairs it is one. Of
    /// spheres it is a power of two: as many as the SCPUs take per cycle at an interval, as fit in a line, and as
    /// numbers of hits come, at most.
    pub(crate) fn contact_lanes(&self, interval: u32) -> u32 {
        if self.config.input != Input::Spheres || self.config.contact == Fields::HIT {
            return 1;
        }
        let per_cycle = (self.config.scpus / interval.max(1)).max(1);
        (1 << per_cycle.ilog2()).min(HIT_LANES).min(self.layout().contacts_per_line())
    }

    /// The number of SCPUs that takes a full line per cycle. A larger number must be a multiple of it. `None` if any
    /// number is used.
    pub fn full_rate(&self) -> Option<u32> {
        let interval = self.config.interval;
        (interval > 1).then(|| self.lanes() * interval)
    }

    /// The warning about SCPUs that are not built; `None` if all are.
    pub fn unused_scpus(&self) -> Option<String> {
        let Config { scpus, interval, .. } = self.config;
        let built = self.scpus_in_turn(interval);
        if self.config.has_deciders() {
            return (built < scpus && self.config.contact != Fields::HIT).then(|| {
                let lanes = self.contact_lanes(interval);
                let more =
                    Self { config: Config { scpus: 2 * lanes * interval, ..self.config.clone() }, ..self.clone() };
                let more = match more.contact_lanes(interval) {
                    twice if twice > lanes => format!("{built} or {}", more.config.scpus),
                    _ => format!("at most {built}"),
                };
                format!(
                    "{} at interval {interval}: {built} of them compute {} per cycle, and the rest are not built. Use \
                     {more}",
                    counted(scpus.into(), "SCPU"),
                    if lanes == 1 { "one contact".to_owned() } else { format!("{lanes} contacts") }
                )
            });
        }
        let multiple = self.full_rate().filter(|_| built < scpus)?;
        Some(format!(
            "{} at interval {interval}: {built} of them can take turns, and the rest are not built. Use at most {multiple} \
             SCPUs, or a multiple of {multiple}",
            counted(scpus.into(), "SCPU")
        ))
    }

    /// The longest interval at which the SCPUs take `pairs_a_cycle`, or the pairs of a line if that is less. 1 if they
    /// do not at any interval.
    pub fn longest_interval(&self, pairs_a_cycle: f64) -> u32 {
        let most = if self.config.has_deciders() { 1 } else { self.lanes() };
        let wanted = pairs_a_cycle.min(f64::from(most)) * (1.0 - 1e-9);
        let takes = |interval: u32| f64::from(self.scpus_in_turn(interval)) / f64::from(interval);
        INTERVALS.rev().find(|interval| takes(*interval) >= wanted).unwrap_or(1)
    }

    /// The options of `afu rtl` that give this configuration, without an interval that is the default.
    pub(super) fn flags(&self) -> Vec<String> {
        let mut flags = self.config.flags();
        if self.config.interval == self.longest_interval(f64::INFINITY)
            && let Some(at) = flags.iter().position(|flag| flag == "--interval")
        {
            flags.drain(at..at + 2);
        }
        let reset = match self.reset {
            Reset { asynchronous: false, active_low: false } => None,
            Reset { asynchronous: false, active_low: true } => Some("low"),
            Reset { asynchronous: true, active_low: false } => Some("async-high"),
            Reset { asynchronous: true, active_low: true } => Some("async-low"),
        };
        flags.extend(reset.into_iter().flat_map(|reset| ["--reset".to_owned(), reset.to_owned()]));
        flags.extend(self.target.into_iter().flat_map(|target| ["--target".to_owned(), target.to_owned()]));
        flags
    }

    /// Bits that hold a number of pairs from 0 to the number of lanes.
    pub(super) fn group_bits(&self) -> u32 {
        self.lanes().ilog2() + 1
    }

    /// The most contacts that leave for their line in one cycle, if only contacts come back.
    pub(super) fn leaving(&self) -> u32 {
        self.lanes().min(self.layout().contacts_per_line())
    }

    /// Bits that hold a number of contacts from 0 to [`Spec::leaving`].
    pub(super) fn leaving_bits(&self) -> u32 {
        self.leaving().ilog2() + 1
    }

    /// Bits of a contact with its number, without padding.
    pub(super) fn entry_bits(&self) -> u32 {
        COUNT_BITS + self.layout().result_bits()
    }

    /// # Errors
    /// Fails with the first value that is out of range.
    pub fn check(&self) -> Result<(), SpecError> {
        self.config.check()?;
        if !(1..=32).contains(&self.word_bits) {
            return Err(SpecError::Word(self.word_bits, self.config.record.format().width()));
        }
        if !(1..=1024).contains(&self.dispatch_cycles) {
            return Err(SpecError::Dispatch(self.dispatch_cycles));
        }
        let layout = self.layout();
        if !self.line_bits.is_power_of_two() || self.line_bits < layout.pair_bits().max(layout.contact_bits()) {
            return Err(SpecError::Line(self.line_bits));
        }
        if self.config.decide > layout.pairs_per_line() {
            return Err(SpecError::Decide(self.config.decide, layout.pairs_per_line()));
        }
        if !self.max_outstanding.is_power_of_two() || !(2..=256).contains(&self.max_outstanding) {
            return Err(SpecError::Outstanding(self.max_outstanding));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Results;

    #[test]
    fn the_longest_interval_takes_what_comes() {
        let of =
            |scpus, pairs_a_cycle| Spec::from(Config { scpus, ..Config::default() }).longest_interval(pairs_a_cycle);
        // Two pairs per line, and no more than one line per cycle.
        assert_eq!([1, 2, 3, 4, 10, 11, 64].map(|scpus| of(scpus, 2.0)), [1, 1, 1, 2, 5, 5, 32]);
        assert_eq!(of(10, f64::INFINITY), Config::shipped().interval);
        let at_five = |scpus| Spec::from(Config { scpus, interval: 5, ..Config::default() });
        assert_eq!([1, 10, 11, 19, 20, 64].map(|scpus| at_five(scpus).scpus_in_turn(5)), [1, 10, 10, 10, 20, 60]);
        assert_eq!([1, 10, 20, 60].map(|scpus| at_five(scpus).unused_scpus()), [const { None }; 4]);
        assert!(at_five(64).unused_scpus().is_some_and(|text| text.contains("60 of them")));
        assert_eq!([0.5, 0.3, 1.0, 1.1, 0.01].map(|rate| of(10, rate)), [20, 33, 10, 9, 64]);
    }

    #[test]
    fn contacts_of_spheres_are_computed_side_by_side() {
        let of = |contact, scpus, interval| {
            let (input, results) = (Input::Spheres, Results::Hits);
            Spec::from(Config { input, results, contact, scpus, interval, ..Config::default() })
        };
        let built = |(scpus, interval)| {
            let spec = of(Fields::ALL, scpus, interval);
            assert_eq!(spec.unused_scpus().is_none(), spec.scpus_in_turn(interval) == scpus);
            (spec.contact_lanes(interval), spec.scpus_in_turn(interval))
        };
        let cases = [(1, 1), (2, 1), (3, 1), (1, 5), (5, 5), (9, 5), (10, 5), (64, 5), (64, 64)];
        assert_eq!(cases.map(built), [(1, 1), (2, 2), (2, 2), (1, 1), (1, 5), (1, 5), (2, 10), (2, 10), (1, 64)]);
        // A line has eight contacts of depth alone, and four hits come per cycle.
        let depth: Fields = "depth".parse().expect("fields");
        assert_eq!([1, 2, 3, 4, 8].map(|scpus| of(depth, scpus, 1).contact_lanes(1)), [1, 2, 2, 4, 4]);
        let text = |spec: Spec| spec.unused_scpus().unwrap_or_default();
        assert!(text(of(depth, 3, 1)).contains("2 of them compute 2 contacts per cycle"));
        assert!(
            text(of(depth, 3, 1)).ends_with("Use 2 or 4") && text(of(Fields::ALL, 9, 1)).ends_with("Use at most 2")
        );
    }
}
