//! The number of cycles that each part of an AFU takes, from the constants with which its hardware is generated.

use crate::record::Capability;

use super::{Afu, collector, control, credits, dispatcher, feeder, packer, slot};

/// The cycles that a line takes in each part without waiting. The link's cycles are not included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Cycles after a reset before which no job begins, because the delay lines beside the SCPUs are being filled.
    pub fill: u32,
    /// Control: from `start` to the parts running.
    pub start: u32,
    /// Collector: to the first read request.
    pub request: u32,
    /// Collector: from its response to a line in order.
    pub collect: u32,
    /// Feeder: to pairs on their way to the slots.
    pub feed: u32,
    /// Slot: the SCPU, and the registers before it.
    pub scpu: u32,
    /// The chain of slots: a register each, before the SCPU or behind it.
    pub chain: u32,
    /// Packer: to a full line.
    pub pack: u32,
    /// Packer: additional cycles for a last line that is not full.
    pub flush: u32,
    /// Packer: until it is known that a job has no pairs.
    pub nothing: u32,
    /// Dispatcher: to its write request.
    pub dispatch: u32,
    /// Dispatcher: from the last acknowledgement until it is counted.
    pub acknowledge: u32,
    /// Control: to `done`.
    pub done: u32,
}

impl Afu {
    /// The AFU's capability word, which [`Capability`] decodes.
    pub fn capability(&self) -> u64 {
        Capability::new(&self.spec().config, self.latency_cycles()).bits()
    }

    /// Cycles from a pair to its contact in an SCPU; with deciders, in both.
    pub fn latency_cycles(&self) -> u32 {
        self.kernel().latency + self.decision().map_or(0, |kernel| kernel.latency)
    }

    /// The cycles of each part.
    pub fn timing(&self) -> Timing {
        let chain = self.spec().scpus_in_turn(self.spec().config.interval);
        // With `--decide`, the slots are those of deciders.
        let fill = match (self.spec().deciding(), self.decision()) {
            (Some(of_slots), Some(kernel)) => {
                credits::cycles_to_fill(slot::latency(&of_slots, kernel.latency), of_slots.config.scpus)
            }
            _ => credits::cycles_to_fill(slot::latency(self.spec(), self.kernel().latency), chain),
        };
        Timing {
            fill: fill + control::CYCLES_TO_HEAR,
            start: control::CYCLES_TO_RUN,
            request: collector::CYCLES_TO_REQUEST,
            collect: collector::CYCLES_TO_LINE,
            feed: feeder::CYCLES_TO_ISSUE,
            scpu: slot::latency(self.spec(), self.kernel().latency),
            chain,
            pack: packer::cycles_to_line(self.spec()),
            flush: packer::cycles_to_flush(self.spec()),
            nothing: packer::CYCLES_TO_NOTHING,
            dispatch: dispatcher::CYCLES_TO_REQUEST,
            acknowledge: dispatcher::CYCLES_TO_IDLE,
            done: control::CYCLES_TO_DONE,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Spec;
    use super::*;
    use crate::config::{Config, Profile, Results, Shell};
    use crate::hdl::Evaluator;
    use crate::record::AROUND_CYCLES;

    /// The cycle of the first read request if a job is started in cycle `start` after a reset.
    fn first_request(afu: &Afu, start: u32) -> u32 {
        let mut unit = Evaluator::new(afu.top(), &[]).expect("an evaluator");
        unit.reset();
        for (port, value) in [("count", 1), ("rd_req_ready", 1)] {
            unit.set(port, value);
        }
        for cycle in 0..1000 {
            unit.set("start", (cycle == start).into());
            if unit.get("rd_req_valid") == 1 {
                return cycle;
            }
            unit.step();
        }
        panic!("no request in 1000 cycles");
    }

    #[test]
    fn a_job_begins_once_the_delay_lines_are_filled() {
        let profile: Profile = "e8f3z".parse().expect("a profile");
        for (scpus, interval, decide) in [(1, 1, 0), (7, 1, 0), (7, 3, 0), (1, 1, 1), (1, 3, 2)] {
            let results = if decide > 0 { Results::Hits } else { Results::All };
            let profile = profile.clone();
            let config = Config { scpus, interval, decide, results, profile, shell: Shell::Line, ..Config::default() };
            let afu = Afu::generate(Spec::from(config)).expect("an AFU");
            let t = afu.timing();
            let soonest = t.start + t.request;
            let requests = [0, t.fill - 1, t.fill, t.fill + 1].map(|start| first_request(&afu, start) - soonest);
            assert_eq!(requests, [t.fill, t.fill, t.fill, t.fill + 1], "{scpus} SCPUs, {interval}, {decide} deciders");
        }
    }

    #[test]
    fn the_word_says_what_a_host_plans_with() {
        for record in ["f32", "f16"] {
            let (profile, record) = ("e8f3z".parse().expect("a profile"), record.parse().expect("a format"));
            let afu = Afu::generate(Spec::from(Config { scpus: 7, interval: 3, record, profile, ..Config::default() }));
            let afu = afu.expect("an AFU");
            let said = Capability::from_bits(afu.capability());
            assert_eq!((said.scpus, said.scpu_cycles), (7, afu.kernel().latency));
            let t = afu.timing();
            let around = t.start + t.request + t.collect + t.feed + t.chain + t.pack + t.flush + t.dispatch + t.done;
            let around = around + t.acknowledge + t.scpu - said.scpu_cycles;
            assert!(2 * u64::from(around) < AROUND_CYCLES, "{around}: hits pass a sieve and a backlog besides");
        }
    }
}
