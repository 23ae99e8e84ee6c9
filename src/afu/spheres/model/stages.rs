//! The stages of the model, from the loader to the hits.

use std::collections::{HashMap, VecDeque};

use super::item::{Item, STAGES};
use super::port::Port;
use super::takers::Takers;
use crate::afu::spheres::{QUEUE, ROW, SLACK, Sizes, candidates, level, near};

/// Cycles in a queue, besides the two that an item takes here from its arrival to its first step.
const CYCLES_IN_QUEUE: u32 = 1;
/// Cycles from a line of spheres to their boxes, and from a complete row to the start of its search, together.
const CYCLES_TO_SEARCH: u64 = 21;
/// Cycles of a decision besides those of the kernel: memory, and two queues.
const CYCLES_AROUND_DECISION: u64 = 6;
/// Cycles at the end of a job, from the last hit on.
const CYCLES_TO_END: u64 = 16;

/// A stage, and the queue before it.
#[derive(Debug, Default)]
struct Stage {
    queue: VecDeque<Item>,
    in_hand: Option<(Item, usize)>,
    on_the_way: VecDeque<(u64, Item)>,
    /// There was room in the queue behind it a cycle ago, which is what its steps go by.
    had_room: bool,
    /// Cycles from a step to its arrival behind it.
    cycles: u32,
    steps: u64,
}

impl Stage {
    /// A cycle: a step, if there is room behind the stage.
    fn step(&mut self, now: u64, has_room: bool) {
        let has_room = std::mem::replace(&mut self.had_room, has_room);
        if let Some((item, place)) = &mut self.in_hand
            && has_room
        {
            self.steps += 1;
            if let Some(put) = item.steps.get_mut(*place).and_then(Option::take) {
                self.on_the_way.push_back((now + u64::from(self.cycles), put));
            }
            *place += 1;
            if *place >= item.steps.len() {
                self.in_hand = None;
            }
        }
        if self.in_hand.is_none() {
            self.in_hand = self.queue.pop_front().map(|item| (item, 0));
        }
    }

    /// What arrives at the queue behind the stage.
    fn arrived(&mut self, now: u64) -> Option<Item> {
        let is_there = self.on_the_way.front().is_some_and(|(cycle, _)| *cycle <= now);
        if is_there { self.on_the_way.pop_front().map(|(_, item)| item) } else { None }
    }
}

/// A step of the last comparison, until it is decided.
#[derive(Debug)]
struct Undecided {
    number: u64,
    asked: Vec<usize>,
    hits: u64,
    ends_row: bool,
}

/// Runs rows through all stages, behind so many rows that are loaded alone. Returns the cycles, and the name and the
/// steps of each stage.
pub(super) fn run(
    sizes: &Sizes,
    before: u64,
    rows: Vec<Item>,
    mut takers: Takers,
    port: &mut Port,
    decision: u64,
) -> (u64, Vec<(&'static str, u64)>) {
    let room = |inside: usize, depth: u32| inside < (depth - SLACK - 1) as usize;
    let (count, per_row) = (rows.len(), u64::from(ROW / sizes.loaded));
    let per_line = Port::PER_LINE / u64::from(sizes.loaded);
    let mut rows = rows.into_iter();
    let between = [level::CYCLES, level::CYCLES, near::CYCLES].map(|cycles| cycles + CYCLES_IN_QUEUE);
    let cycles = between.into_iter().chain([candidates::cycles(sizes)]);
    let mut stages: Vec<_> = cycles.map(|cycles| Stage { cycles, ..Stage::default() }).collect();
    let mut launches: VecDeque<u64> = VecDeque::new();
    let mut steps: VecDeque<Undecided> = VecDeque::new();
    let mut shares: Vec<VecDeque<(u64, u64)>> = vec![VecDeque::new(); sizes.deciders as usize];
    let mut answers: HashMap<(u64, usize), u64> = HashMap::new();
    let decision = decision + CYCLES_AROUND_DECISION;
    let (mut begun, mut loading, mut ended, mut number, mut now) = (0, 0, 0, 0, 0);
    let before = before as usize;
    let (mut leave_steps, mut decided) = (0, 0);
    let mut joined: VecDeque<(u64, bool)> = VecDeque::new();
    let mut leaving = None;
    while ended < count || !port.is_done() {
        now += 1;
        port.cycle(now);
        // The loader: a row begins only where it can be kept, and goes on as its lines come.
        let begins = loading == 0;
        let may_begin =
            begun < before || (begun < before + count && begun - before - ended < sizes.kept_rows() as usize);
        if (!begins || may_begin) && port.has_line(now) {
            begun += usize::from(begins);
            loading += 1;
            if loading % per_line == 0 {
                port.take(now);
            }
            if loading == per_row {
                loading = 0;
                if begun > before {
                    launches.push_back(now + CYCLES_TO_SEARCH);
                }
            }
        }
        while launches.front().is_some_and(|cycle| *cycle <= now) {
            launches.pop_front();
            stages[0].queue.extend(rows.next());
        }
        for place in (0..STAGES.len()).rev() {
            let has_room = match STAGES.get(place + 1) {
                Some((_, depth)) => room(stages[place + 1].queue.len(), *depth),
                None => room(steps.len(), sizes.undecided),
            };
            while let Some(item) = stages[place].arrived(now) {
                if place + 1 < STAGES.len() {
                    stages[place + 1].queue.push_back(item);
                    continue;
                }
                let (share, hits) = item.decided.unwrap_or_default();
                let asked: Vec<_> = (0..share.len()).filter(|decider| share[*decider] > 0).collect();
                asked.iter().for_each(|decider| shares[*decider].push_back((number, share[*decider])));
                steps.push_back(Undecided { number, asked, hits, ends_row: item.ends_row });
                number += 1;
            }
            stages[place].step(now, has_room);
        }
        for (decider, share) in shares.iter_mut().enumerate() {
            if let Some((step, left)) = share.front_mut() {
                *left -= 1;
                decided += 1;
                if *left == 0 {
                    answers.insert((*step, decider), now + decision);
                    share.pop_front();
                }
            }
        }
        // Hits of the step in hand leave, and a row ends with its last ones.
        ended += takers.cycle(now, port);
        if let Some((left, ends_row)) = &mut leaving
            && takers.may_come(now, port)
        {
            let hits = takers.lanes.min(*left);
            *left -= hits;
            leave_steps += 1;
            ended += takers.put(now, hits, *ends_row && *left == 0, port);
            if *left == 0 {
                leaving = None;
            }
        }
        if leaving.is_none() {
            leaving = joined.pop_front();
        }
        // The oldest step is joined when all its deciders have answered. One without hits needs no turn.
        let is_there = |step: &Undecided| {
            step.asked.iter().all(|decider| answers.get(&(step.number, *decider)).is_some_and(|cycle| *cycle <= now))
        };
        if room(joined.len(), QUEUE)
            && steps.front().is_some_and(is_there)
            && let Some(Undecided { number, asked, hits, ends_row }) = steps.pop_front()
        {
            for decider in asked {
                answers.remove(&(number, decider));
            }
            if hits > 0 || ends_row {
                joined.push_back((hits, ends_row));
            }
        }
        if ended == count {
            takers.end(now, port);
        }
    }
    let mut told: Vec<_> = STAGES.iter().zip(&stages).map(|((name, _), stage)| (*name, stage.steps)).collect();
    told.insert(0, ("loader", (before + count) as u64 * per_row));
    told.push(("deciders", decided / u64::from(sizes.deciders)));
    told.push(("hits", leave_steps));
    told.extend(takers.scpus().map(|busy| ("SCPUs", busy)));
    (now + CYCLES_TO_END, told)
}
