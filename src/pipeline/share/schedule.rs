//! Decides when each operation begins and in which instance: list scheduling, the longest path to an output first.

use std::collections::BTreeSet;

use super::kinds::Kinds;
use crate::pipeline::balance::LONGEST_GLUE;
use crate::pipeline::kernel::{Kernel, Source, ValueId};

/// One operator's instance.
#[derive(Clone, Debug)]
pub(in crate::pipeline) struct Instance {
    /// Index into [`Kinds::all`].
    pub kind: usize,
    /// By phase: the value that it begins with in that phase.
    pub places: Vec<Option<usize>>,
}

/// The time table of a pair. In cycle 0, the inputs arrive.
pub(super) struct Plan {
    pub interval: u32,
    /// The cycle in which each value's operands meet; `None` for dead code and constants.
    pub start: Vec<Option<u32>>,
    /// The first cycle in which each value is available; `None` as above.
    pub ready: Vec<Option<u32>>,
    pub instances: Vec<Instance>,
    /// Index into `instances`, by value.
    pub instance: Vec<Option<usize>>,
    /// The cycle in which all outputs are available.
    pub latency: u32,
    /// Levels of glue between the last register and the value.
    glue: Vec<u32>,
}

impl Plan {
    pub fn new(kernel: &Kernel, kinds: &Kinds, interval: u32) -> Self {
        let count = kernel.values.len();
        let live = kernel.live();
        let mut this = Self {
            interval,
            start: vec![None; count],
            ready: vec![None; count],
            instances: Vec::new(),
            instance: vec![None; count],
            latency: 0,
            glue: vec![0; count],
        };
        for (kind, of) in kinds.all.iter().enumerate() {
            let empty = Instance { kind, places: vec![None; interval as usize] };
            this.instances.extend((0..of.instances).map(|_| empty.clone()));
        }
        let height = heights(kernel, kinds);
        let mut waiting: Vec<usize> = (0..count).filter(|&index| live[index] && kinds.of[index].is_some()).collect();
        waiting.sort_by_key(|&index| (std::cmp::Reverse(height[index]), index));
        let mut cycle = 0;
        this.settle(kernel, &live, kinds);
        while !waiting.is_empty() {
            let before = waiting.len();
            waiting.retain(|&index| !this.place(kernel, kinds, index, cycle));
            if waiting.len() < before {
                this.settle(kernel, &live, kinds);
            }
            cycle += 1;
        }
        for (_, id) in &kernel.outputs {
            // Outputs are registers.
            let is_register = matches!(kernel.value(*id).source, Source::Operator(..));
            if let Some(ready) = this.ready[id.index()] {
                this.latency = this.latency.max(ready + u32::from(!is_register));
            }
        }
        this
    }

    /// Begins an operation in `cycle`, if its operands are available and an instance is free.
    fn place(&mut self, kernel: &Kernel, kinds: &Kinds, index: usize, cycle: u32) -> bool {
        let Some(kind) = kinds.of[index] else { return true };
        // Operands come directly from registers.
        let are_there = kernel.values[index].operands.iter().all(|id| {
            let is_constant = kernel.as_constant(*id).is_some();
            is_constant || self.ready[id.index()].is_some_and(|ready| ready + self.is_glue(*id) <= cycle)
        });
        let phase = (cycle % self.interval) as usize;
        let shared = kinds.all[kind].is_shared();
        let free = |instance: &Instance| match shared {
            true => instance.places[phase].is_none(),
            false => instance.places.iter().all(Option::is_none),
        };
        let load = |instance: &Instance| instance.places.iter().flatten().count();
        let candidates = self.instances.iter().enumerate().filter(|(_, of)| of.kind == kind && free(of));
        // The instance with the fewest operations, so that no selection gets deep.
        let Some((instance, _)) = candidates.min_by_key(|(_, of)| load(of)).filter(|_| are_there) else {
            return false;
        };
        self.instances[instance].places[phase] = Some(index);
        self.instance[index] = Some(instance);
        self.start[index] = Some(cycle);
        self.ready[index] = Some(cycle + kinds.all[kind].latency());
        true
    }

    fn is_glue(&self, id: ValueId) -> u32 {
        u32::from(self.glue[id.index()] > 0)
    }

    /// Sets times for inputs, and for glue whose operands have times.
    fn settle(&mut self, kernel: &Kernel, live: &[bool], kinds: &Kinds) {
        for (index, value) in kernel.values.iter().enumerate() {
            let is_open = live[index] && self.ready[index].is_none() && kinds.of[index].is_none();
            if !is_open || matches!(value.source, Source::Constant(_)) {
                continue;
            }
            let variable = || value.operands.iter().filter(|id| kernel.as_constant(**id).is_none());
            let Some(arrivals) = variable().map(|id| self.ready[id.index()]).collect::<Option<Vec<_>>>() else {
                continue;
            };
            let together = arrivals.iter().copied().max().unwrap_or(0);
            if !matches!(value.source, Source::Input(_)) {
                let deepest = variable().filter(|id| self.ready[id.index()] == Some(together));
                let deepest = deepest.map(|id| self.glue[id.index()]).max().unwrap_or(0);
                let is_long = deepest >= LONGEST_GLUE;
                self.glue[index] = if is_long { 1 } else { deepest + 1 };
                self.start[index] = Some(together + u32::from(is_long));
            } else {
                self.start[index] = Some(0);
            }
            self.ready[index] = self.start[index];
        }
    }

    /// The number of cycles for which a value is held on its own, as inputs are.
    pub fn stays(&self, kernel: &Kernel, index: usize) -> u32 {
        if matches!(kernel.values[index].source, Source::Input(_)) { self.interval } else { 1 }
    }

    /// The cycles in which each value is needed.
    pub fn wanted(&self, kernel: &Kernel) -> Vec<BTreeSet<u32>> {
        let mut wanted = vec![BTreeSet::new(); kernel.values.len()];
        for (value, start) in kernel.values.iter().zip(&self.start) {
            if let Some(start) = start {
                for id in &value.operands {
                    wanted[id.index()].insert(*start);
                }
            }
        }
        for (_, id) in &kernel.outputs {
            wanted[id.index()].insert(self.latency);
        }
        wanted
    }
}

/// The minimum number of cycles from each value's operands to the outputs.
fn heights(kernel: &Kernel, kinds: &Kinds) -> Vec<u32> {
    let mut height = vec![0; kernel.values.len()];
    for index in (0..kernel.values.len()).rev() {
        // Users have higher indices, so they are already done.
        height[index] += kinds.of[index].map_or(0, |kind| kinds.all[kind].latency());
        for id in &kernel.values[index].operands {
            height[id.index()] = height[id.index()].max(height[index]);
        }
    }
    height
}
