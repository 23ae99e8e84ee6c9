//! Chooses the stage of each operation.
//!
//! First as soon as possible, which gives the fewest stages there can be. Then operations move within their slack,
//! one at a time, where that saves register bits: a sweep from the outputs moves them later, one from the inputs
//! earlier, until neither gains. In a sweep from the outputs only what lies behind an operation has moved when it is
//! looked at, so the arrival times of its operands are still right, and the time behind it is known; the sweep from
//! the inputs is its mirror image.

use std::collections::BTreeSet;

use crate::hdl::delay_model::DelayModel;
use crate::hdl::module::{Module, NodeId, Op};

/// Sweeps to save registers; each one gains less than the one before, and few modules take more than six.
const MOST_SWEEPS: u32 = 24;

/// Sums of the same delays in another order may differ by this much, in ns.
const ROUNDING: f64 = 1e-9;

/// Stages of a module's operations. All lists are indexed by node.
pub(super) struct Plan<'a> {
    module: &'a Module,
    budget: f64,
    /// From logic into the first rank of an operation with ranks.
    entry: f64,
    delay: Vec<f64>,
    /// Register ranks inside an operation: it takes its operands that many stages before the one it stands in.
    pub ranks: Vec<u32>,
    /// The users of a value, each once.
    users: Vec<Vec<NodeId>>,
    /// True if a value drives an output.
    is_output: Vec<bool>,
    /// Bits that a register of the value takes: constant parts of it need none.
    bits: Vec<u64>,
    /// The delay from the beginning of the stage to the result.
    arrival: Vec<f64>,
    /// The delay from the result to the end of the stage.
    tail: Vec<f64>,
    /// True if only constants and parameters are used: the value is valid in any stage.
    pub invariant: Vec<bool>,
    pub stage: Vec<u32>,
    /// The number of stages.
    pub stages: u32,
}

/// The longest path between two register ranks.
pub(super) struct Slowest {
    pub logic: f64,
    pub stage: u32,
    pub path: Vec<NodeId>,
}

#[derive(Clone, Copy, PartialEq)]
enum Sweep {
    Later,
    Earlier,
}

impl<'a> Plan<'a> {
    /// `budget` is the time for logic between two registers, in ns.
    pub(super) fn as_soon_as_possible(module: &'a Module, model: &DelayModel, budget: f64) -> Self {
        let count = module.nodes.len();
        let mut plan = Self {
            module,
            budget: budget + ROUNDING,
            entry: model.multiplier_input,
            delay: model.delays(module),
            ranks: module.nodes.iter().map(|node| model.ranks(module, node)).collect(),
            users: vec![Vec::new(); count],
            is_output: vec![false; count],
            bits: Vec::with_capacity(count),
            arrival: vec![0.0; count],
            tail: vec![0.0; count],
            invariant: vec![false; count],
            stage: vec![0; count],
            stages: 1,
        };
        for id in module.ids() {
            let node = module.node(id);
            let index = id.index();
            plan.invariant[index] = match node.op {
                Op::Input => false,
                _ => node.operands.iter().all(|operand| plan.invariant[operand.index()]),
            };
            let is_constant = |operand: &&NodeId| plan.invariant[operand.index()];
            let constant: u32 = match node.op {
                Op::Concat => node.operands.iter().filter(is_constant).map(|id| module.node(*id).width).sum(),
                _ => 0,
            };
            plan.bits.push(u64::from(node.width - constant));
            if plan.invariant[index] {
                continue;
            }
            for operand in &node.operands {
                if plan.users[operand.index()].last() != Some(&id) {
                    plan.users[operand.index()].push(id);
                }
            }
            let stage = plan.earliest(id);
            let fits = plan.fits(plan.arrival_at(id, stage), plan.delay[index], 0.0);
            plan.stage[index] = if fits { stage } else { stage + 1 };
            plan.arrival[index] = plan.arrival_at(id, plan.stage[index]) + plan.delay[index];
            plan.stages = plan.stages.max(plan.stage[index] + 1);
        }
        for port in module.ports.iter().filter(|port| port.output) {
            if let Some(id) = port.node {
                plan.is_output[id.index()] = true;
            }
        }
        plan
    }

    /// True if a path of this delay may stand in one stage. An operation that is slower alone may only share a stage
    /// with wiring.
    fn fits(&self, before: f64, delay: f64, behind: f64) -> bool {
        before + delay + behind <= self.budget.max(before).max(delay).max(behind)
    }

    /// Operands that may need a register.
    fn operands(&self, id: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        self.module.node(id).operands.iter().copied().filter(|operand| !self.invariant[operand.index()])
    }

    /// The stage in which an operation takes its operands.
    pub fn begin(&self, id: NodeId) -> u32 {
        self.stage[id.index()].saturating_sub(self.ranks[id.index()])
    }

    /// The first stage in which it can stand, of all operands.
    fn earliest(&self, id: NodeId) -> u32 {
        let ranks = self.ranks[id.index()];
        let is_late = |arrival: f64| ranks > 0 && arrival > 0.0 && arrival + self.entry > self.budget;
        let there = |operand: NodeId| self.stage[operand.index()] + u32::from(is_late(self.arrival[operand.index()]));
        self.operands(id).map(there).max().unwrap_or(0) + ranks
    }

    /// The last stage that still serves every user.
    fn latest(&self, id: NodeId) -> u32 {
        let users = self.users[id.index()].iter().map(|user| self.begin(*user));
        users.min().unwrap_or(self.stages - 1)
    }

    /// When the operands have come, if the operation stands in `stage`: at its beginning from registers, those inside
    /// an operation among them.
    fn arrival_at(&self, id: NodeId, stage: u32) -> f64 {
        if self.ranks[id.index()] > 0 {
            return 0.0;
        }
        let here = self.operands(id).filter(|operand| self.stage[operand.index()] == stage);
        here.map(|operand| self.arrival[operand.index()]).fold(0.0, f64::max)
    }

    /// The delay that follows in the same stage, if the operation stands in `stage`.
    fn tail_at(&self, id: NodeId, stage: u32) -> f64 {
        let behind = |user: &NodeId| match self.ranks[user.index()] {
            0 if self.stage[user.index()] == stage => self.delay[user.index()] + self.tail[user.index()],
            // Wiring from a register alone has the time it takes.
            1.. if self.begin(*user) == stage && self.arrival_at(id, stage) + self.delay[id.index()] > 0.0 => {
                self.entry
            }
            _ => 0.0,
        };
        self.users[id.index()].iter().map(behind).fold(0.0, f64::max)
    }

    /// The last stage whose beginning must still have the value, not counting one user.
    fn needed_until(&self, id: NodeId, but_for: Option<NodeId>) -> u32 {
        if self.is_output[id.index()] {
            return self.stages;
        }
        let users = self.users[id.index()].iter().filter(|user| Some(**user) != but_for);
        users.map(|user| self.begin(*user)).max().unwrap_or(0)
    }

    /// Bits of registers between stages.
    pub(super) fn register_bits(&self) -> u64 {
        let held = |id: NodeId| {
            let cycles = self.needed_until(id, None).saturating_sub(self.stage[id.index()]);
            if self.invariant[id.index()] { 0 } else { self.bits[id.index()] * u64::from(cycles) }
        };
        self.module.ids().map(held).sum()
    }

    /// Moves operations within their slack where it saves register bits.
    pub(super) fn save_registers(&mut self) {
        let mut best = (self.register_bits(), self.stage.clone());
        let mut idle = 0;
        for sweep in [Sweep::Later, Sweep::Earlier].into_iter().cycle().take(MOST_SWEEPS as usize) {
            self.sweep(sweep);
            let bits = self.register_bits();
            idle = if bits < best.0 { 0 } else { idle + 1 };
            // Among equals the later stage: fields and extensions then stand beside their use, and whole values wait.
            if bits < best.0 || bits == best.0 && sweep == Sweep::Later {
                best = (bits, self.stage.clone());
            }
            if idle == 3 {
                break;
            }
        }
        self.stage = best.1;
        self.time_arrivals();
    }

    fn time_arrivals(&mut self) {
        self.module.ids().for_each(|id| self.arrive(id));
    }

    fn time_tails(&mut self) {
        (0..self.module.nodes.len() as u32).rev().for_each(|id| self.follow(NodeId(id)));
    }

    fn arrive(&mut self, id: NodeId) {
        self.arrival[id.index()] = self.arrival_at(id, self.stage[id.index()]) + self.delay[id.index()];
    }

    fn follow(&mut self, id: NodeId) {
        self.tail[id.index()] = self.tail_at(id, self.stage[id.index()]);
    }

    fn sweep(&mut self, sweep: Sweep) {
        let count = self.module.nodes.len() as u32;
        match sweep {
            Sweep::Later => {
                self.time_arrivals();
                for id in (0..count).rev().map(NodeId) {
                    self.gather_fields(id);
                    self.improve(id, sweep);
                    self.follow(id);
                }
            }
            Sweep::Earlier => {
                self.time_tails();
                for id in (0..count).map(NodeId) {
                    self.improve(id, sweep);
                    self.arrive(id);
                }
            }
        }
    }

    /// Moves one operation to the cheapest stage in the direction of the sweep; of equals to the farthest.
    fn improve(&mut self, id: NodeId, sweep: Sweep) {
        let index = id.index();
        if self.invariant[index] || self.module.node(id).op == Op::Input {
            return;
        }
        let now = self.stage[index];
        let range = match sweep {
            Sweep::Later => now..=self.latest(id).max(now),
            Sweep::Earlier => self.earliest(id).min(now)..=now,
        };
        if range.start() == range.end() {
            return;
        }
        let until = self.needed_until(id, None);
        let mut sources: Vec<NodeId> = self.operands(id).collect();
        sources.sort();
        sources.dedup();
        let others: Vec<(u64, u32)> = sources
            .into_iter()
            .map(|source| (self.bits[source.index()], self.needed_until(source, Some(id))))
            .collect();
        let bits = |stage: u32| -> u64 {
            let held = self.bits[index] * u64::from(until.saturating_sub(stage));
            let begin = stage - self.ranks[index];
            held + others.iter().map(|&(bits, other)| bits * u64::from(other.max(begin))).sum::<u64>()
        };
        let possible = |stage: &u32| {
            let (before, behind) = (self.arrival_at(id, *stage), self.tail_at(id, *stage));
            *stage == now || self.fits(before, self.delay[index], behind)
        };
        let chosen = match sweep {
            Sweep::Later => range.rev().filter(possible).min_by_key(|stage| bits(*stage)),
            Sweep::Earlier => range.filter(possible).min_by_key(|stage| bits(*stage)),
        };
        self.stage[index] = chosen.unwrap_or(now);
    }

    /// Moves all fields taken from one value later together, where holding the value is cheaper than holding them
    /// apart: one at a time none would begin. Part of the sweep to later stages.
    fn gather_fields(&mut self, id: NodeId) {
        let is_field = |user: &&NodeId| matches!(self.module.node(**user).op, Op::Slice { .. });
        let users = &self.users[id.index()];
        let fields: Vec<NodeId> = users.iter().filter(is_field).copied().collect();
        if fields.len() < 2 || self.invariant[id.index()] {
            return;
        }
        let own = self.stage[id.index()];
        let whole = users.iter().filter(|user| !is_field(user)).map(|user| self.begin(*user)).max().unwrap_or(own);
        let whole = if self.is_output[id.index()] { self.stages } else { whole };
        // Where a field goes if the value is held until stage `until`.
        let target = |field: NodeId, until: u32| {
            let stage = self.latest(field).min(until).max(self.stage[field.index()]);
            let before = if stage == own { self.arrival[id.index()] } else { 0.0 };
            let fits = self.fits(before, self.delay[field.index()], self.tail_at(field, stage));
            if fits { stage } else { self.stage[field.index()] }
        };
        let bits = |placed: &[u32]| -> u64 {
            let held = placed.iter().copied().max().unwrap_or(own).max(whole) - own;
            let apart = fields.iter().zip(placed).map(|(field, &stage)| {
                self.bits[field.index()] * u64::from(self.needed_until(*field, None).saturating_sub(stage))
            });
            self.bits[id.index()] * u64::from(held) + apart.sum::<u64>()
        };
        let now: Vec<u32> = fields.iter().map(|field| self.stage[field.index()]).collect();
        let until: BTreeSet<u32> = fields.iter().map(|field| self.latest(*field)).collect();
        let placements = until.into_iter().map(|until| fields.iter().map(|field| target(*field, until)).collect());
        let best = std::iter::once(now).chain(placements).min_by_key(|placed| bits(placed));
        for (field, stage) in fields.iter().zip(best.unwrap_or_default()) {
            self.stage[field.index()] = stage;
            self.follow(*field);
        }
    }

    /// The longest path of all stages. Arrivals are up to date.
    pub(super) fn slowest(&self) -> Slowest {
        let mut slowest = Slowest { logic: 0.0, stage: 0, path: Vec::new() };
        let mut end = None;
        for id in self.module.ids().filter(|id| !self.invariant[id.index()]) {
            if self.arrival[id.index()] > slowest.logic {
                slowest.logic = self.arrival[id.index()];
                slowest.stage = self.stage[id.index()];
                end = Some(id);
            }
        }
        while let Some(id) = end {
            let node = self.module.node(id);
            if self.delay[id.index()] > 0.0 || node.name.is_some() && node.op != Op::Input {
                slowest.path.push(id);
            }
            let latest = self
                .operands(id)
                .filter(|operand| self.ranks[id.index()] == 0 && self.stage[operand.index()] == slowest.stage);
            end = latest.max_by(|a, b| self.arrival[a.index()].total_cmp(&self.arrival[b.index()]));
        }
        slowest.path.reverse();
        slowest
    }
}
