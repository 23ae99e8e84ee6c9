//! A model of the search that counts cycles: what moves from queue to queue, without its bits. It says how fast a
//! configuration finds what touches in given sets, without simulating the Verilog.
//!
//! Memory is as fast as the AFU here: a link that is slower than the search sets the pace by itself.

use std::collections::{HashMap, VecDeque};

use super::hits::{HIT_LANES, cycles_to_numbers};
use super::waiting::{PLACES, hits_on_the_way};
use super::{LONG_QUEUE, QUEUE, ROW, SLACK, Sizes};
use crate::afu::Spec;
use crate::afu::generate::{decision, kernel};
use crate::afu::resolver;
use crate::config::{self, Config};
use crate::hdl::BuildErrors;
use crate::kernel::EngineError;
use crate::query::Fields;
use crate::spheres::{GroupTrace, MemberTrace, RefusedArithmetic, RowTrace, Search, Spheres};

/// Cycles from a step to the queue behind it.
const CYCLES_OF_A_STAGE: u64 = 6;
/// Cycles from a sphere in memory to its box, and from a complete row to the start of its search, together.
const CYCLES_TO_SEARCH: u64 = 30;
/// Cycles of a decision besides those of the kernel: memory, and two queues.
const CYCLES_AROUND_DECISION: u64 = 6;
/// Cycles at the end of a job, from the last hit on.
const CYCLES_TO_END: u64 = 30;

/// Cycles that a search takes, and the steps of its stages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Predicted {
    /// Cycles, loading and draining counted.
    pub cycles: u64,
    /// The name of each stage, and the cycles in which it makes a step.
    pub stages: Vec<(&'static str, u64)>,
}

impl Predicted {
    /// The stage with the most steps.
    pub fn slowest(&self) -> &'static str {
        self.stages.iter().max_by_key(|(_, steps)| *steps).map_or("", |(name, _)| name)
    }
}

/// Why there is no prediction.
#[derive(Debug, thiserror::Error)]
pub enum PredictError {
    /// The arithmetic, or the bits of a box.
    #[error(transparent)]
    Refused(#[from] RefusedArithmetic),
    /// The kernel that decides could not be generated.
    #[error("the generated kernel is faulty:\n{0}")]
    Kernel(#[from] BuildErrors),
    /// The reference that decides failed.
    #[error("the reference kernel: {0}")]
    Reference(EngineError),
}

/// What waits for a stage: for each of its steps, what that puts into the queue behind it.
#[derive(Debug, Default)]
struct Item {
    steps: Vec<Option<Item>>,
    /// In the last stage, candidates of each decider, and hits.
    decided: Option<(Vec<u64>, u64)>,
    ends_row: bool,
}

/// A stage, and the queue before it.
#[derive(Debug, Default)]
struct Stage {
    queue: VecDeque<Item>,
    in_hand: Option<(Item, usize)>,
    on_the_way: VecDeque<(u64, Item)>,
    steps: u64,
}

impl Stage {
    /// A cycle: a step, if there is room behind the stage.
    fn step(&mut self, now: u64, has_room: bool) {
        if let Some((item, place)) = &mut self.in_hand
            && has_room
        {
            self.steps += 1;
            if let Some(put) = item.steps.get_mut(*place).and_then(Option::take) {
                self.on_the_way.push_back((now + CYCLES_OF_A_STAGE, put));
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

/// Hits by the number of the other row, that of the row that is searched, and the place of the sphere in this.
type Hits = HashMap<(usize, usize, usize), u64>;

/// A job of spheres, whose cycles are predicted for hardware of any size.
#[derive(Debug)]
pub struct SearchModel {
    rows: Vec<RowTrace>,
    hits: Hits,
    /// Rows of a first set, which are loaded and not searched.
    before: u64,
    box_bits: u32,
    candidates: u64,
}

impl SearchModel {
    /// The job of these sets, in the arithmetic and with the boxes of a configuration.
    ///
    /// # Errors
    /// Returns an error if the arithmetic has no boxes, or if its reference fails.
    pub fn new(config: &Config, sets: &Spheres) -> Result<Self, PredictError> {
        let box_bits = config.search.box_bits;
        let search = Search::new(config.profile.arithmetic(), box_bits)?;
        let second = sets.second.as_deref();
        let found = search.find(&mut config.profile.reference(Fields::HIT), &sets.first, second);
        let found = found.map_err(PredictError::Reference)?;
        let mut hits = Hits::new();
        let row = ROW as usize;
        for hit in found.hits {
            let [first, second] = hit.spheres.map(|number| number as usize);
            *hits.entry((first / row, second / row, second % row)).or_default() += 1;
        }
        let before = if second.is_some() { sets.first.len().div_ceil(row) as u64 } else { 0 };
        let candidates = found.counts.candidates;
        Ok(Self { rows: search.trace(&sets.first, second), hits, before, box_bits, candidates })
    }

    /// Pairs whose boxes meet.
    pub fn candidates(&self) -> u64 {
        self.candidates
    }

    /// Pairs that touch.
    pub fn contacts(&self) -> u64 {
        self.hits.values().sum()
    }

    /// The cycles that this takes in a configuration with such boxes, at the line port of a memory that is as fast
    /// as it.
    ///
    /// # Errors
    /// Returns an error if the configuration has no search.
    pub fn predict(&self, config: &Config) -> Result<Predicted, PredictError> {
        let search = config::Search { box_bits: self.box_bits, ..config.search };
        let sizes = Sizes::of(&Config { search, ..config.clone() })?;
        let spec = Spec::from(config.clone());
        let decision = decision(&spec, false)?.latency;
        let rows = self.rows.iter().enumerate().map(|(row, trace)| item(&sizes, row, trace, &self.hits)).collect();
        Ok(run(&sizes, self.before, rows, Takers::of(&spec, &sizes)?, decision.into()))
    }
}

/// What a row gives the first stage.
fn item(sizes: &Sizes, row: usize, trace: &RowTrace, hits: &Hits) -> Item {
    let members = |member: &MemberTrace| {
        let step = |near: &[(usize, u16)]| {
            let mut share = vec![0; sizes.deciders as usize];
            for (_, columns) in near {
                let columns = (0..ROW).filter(|column| columns >> column & 1 == 1);
                columns.for_each(|column| share[(column % sizes.deciders) as usize] += 1);
            }
            let found = near.iter().filter_map(|(place, _)| hits.get(&(member.number, row, *place))).sum();
            let is_asked = share.iter().any(|candidates| *candidates > 0);
            is_asked.then(|| Item { decided: Some((share, found)), ..Item::default() })
        };
        member.near.chunks(sizes.compared as usize).map(step).collect::<Vec<_>>()
    };
    let word = |word: usize| {
        let groups = trace.met.iter().filter(|group| group.number / ROW as usize == word);
        let step = |group: &GroupTrace| {
            let together = |member: &MemberTrace| member.number / sizes.near_rows as usize;
            let sides = group.met.chunk_by(|one, other| together(one) == together(other));
            let side_by_side = |rows: &[MemberTrace]| {
                let steps: Vec<_> = rows.iter().flat_map(members).collect();
                (!steps.is_empty()).then(|| Item { steps, ..Item::default() })
            };
            let steps: Vec<_> = sides.map(side_by_side).collect();
            (!steps.is_empty()).then(|| Item { steps, ..Item::default() })
        };
        let steps: Vec<_> = groups.map(step).collect();
        (!steps.is_empty()).then(|| Item { steps, ..Item::default() })
    };
    let mut item = Item { steps: (0..trace.groups.div_ceil(ROW as usize)).map(word).collect(), ..Item::default() };
    end(sizes, &mut item, 0);
    item
}

/// The last item of a row passes all stages, even if it found nothing.
fn end(sizes: &Sizes, item: &mut Item, stage: usize) {
    if stage == STAGES.len() {
        item.decided.get_or_insert_with(|| (vec![0; sizes.deciders as usize], 0));
        item.ends_row = true;
        return;
    }
    if item.steps.is_empty() {
        item.steps.push(None);
    }
    if let Some(last) = item.steps.last_mut() {
        end(sizes, last.get_or_insert_with(Item::default), stage + 1);
    }
}

/// What takes the hits: lines for numbers alone, or SCPUs.
#[derive(Debug)]
struct Takers {
    /// Hits that leave the stage before in a cycle, at most.
    lanes: u64,
    /// SCPUs side by side; none for numbers alone.
    side_by_side: u64,
    /// They take hits in the first so many cycles of each interval.
    units: u64,
    interval: u64,
    /// Cycles from a hit to its contact, and from its step to where it waits.
    latency: u64,
    to_place: u64,
    /// Hits that may wait before the stage before is stopped.
    most: u64,
    /// Hits that wait: the cycle from which they do, how many, and whether their row ends.
    waiting: VecDeque<(u64, u64, bool)>,
    /// Cycles in which SCPUs take hits.
    busy: u64,
}

impl Takers {
    fn of(spec: &Spec, sizes: &Sizes) -> Result<Self, BuildErrors> {
        let is_resolved = spec.config.contact != Fields::HIT;
        let (side_by_side, units) = if is_resolved { (resolver::lanes(spec), resolver::units(spec)) } else { (0, 1) };
        let latency = if is_resolved { kernel(spec)?.latency } else { 0 };
        Ok(Self {
            lanes: if side_by_side == 1 { 1 } else { HIT_LANES.into() },
            side_by_side: side_by_side.into(),
            units: units.into(),
            interval: if is_resolved { spec.config.interval.max(1).into() } else { 1 },
            latency: latency.into(),
            to_place: cycles_to_numbers(sizes.compared).into(),
            most: (PLACES - hits_on_the_way(sizes.compared)).into(),
            waiting: VecDeque::new(),
            busy: 0,
        })
    }

    /// Whether hits may leave the stage before.
    fn may_come(&self, now: u64) -> bool {
        let there = self.waiting.iter().filter(|(cycle, ..)| *cycle <= now);
        let has_turn = self.side_by_side > 1 || now % self.interval < self.units;
        has_turn && there.map(|(_, hits, _)| hits).sum::<u64>() < self.most
    }

    /// Some hits come. Returns the number of rows that end at once.
    fn put(&mut self, now: u64, hits: u64, ends_row: bool) -> usize {
        if self.side_by_side > 1 {
            self.waiting.push_back((now + self.to_place, hits, ends_row));
            return 0;
        }
        self.busy += u64::from(hits > 0);
        usize::from(ends_row)
    }

    /// A cycle of SCPUs side by side. Returns the number of rows that end.
    fn cycle(&mut self, now: u64) -> usize {
        let mut free = if now % self.interval < self.units { self.side_by_side } else { 0 };
        let mut rows = 0;
        let before = free;
        while let Some((cycle, hits, ends_row)) = self.waiting.front_mut() {
            let taken = free.min(*hits);
            if *cycle > now {
                break;
            }
            *hits -= taken;
            free -= taken;
            if *hits > 0 {
                break;
            }
            rows += usize::from(*ends_row);
            self.waiting.pop_front();
        }
        self.busy += u64::from(free < before);
        rows
    }
}

/// The stages before the deciders, and the queue before each.
const STAGES: [(&str, u32); 4] =
    [("groups", QUEUE), ("rows of groups", QUEUE), ("near", LONG_QUEUE), ("box by box", LONG_QUEUE)];

/// Runs rows through all stages, behind so many rows that are loaded alone.
fn run(sizes: &Sizes, before: u64, rows: Vec<Item>, mut takers: Takers, decision: u64) -> Predicted {
    let room = |inside: usize, depth: u32| inside < (depth - SLACK - 1) as usize;
    let (count, per_row) = (rows.len(), u64::from(ROW / sizes.loaded));
    let mut rows = rows.into_iter();
    let mut stages: Vec<Stage> = STAGES.iter().map(|_| Stage::default()).collect();
    let mut launches: VecDeque<u64> = VecDeque::new();
    let mut steps: VecDeque<Undecided> = VecDeque::new();
    let mut shares: Vec<VecDeque<(u64, u64)>> = vec![VecDeque::new(); sizes.deciders as usize];
    let mut answers: HashMap<(u64, usize), u64> = HashMap::new();
    let decision = decision + CYCLES_AROUND_DECISION;
    let (mut begun, mut loading, mut ended, mut number) = (0, 0, 0, 0);
    let (mut leave_steps, mut decided) = (0, 0);
    let mut joined: VecDeque<(u64, bool)> = VecDeque::new();
    let mut leaving = None;
    let mut now = before * per_row;
    while ended < count {
        now += 1;
        // The loader: a row begins only where it can be kept.
        if loading > 0 || (begun < count && begun - ended < sizes.kept_rows() as usize) {
            begun += usize::from(loading == 0);
            loading += 1;
            if loading == per_row {
                launches.push_back(now + CYCLES_TO_SEARCH);
                loading = 0;
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
        ended += takers.cycle(now);
        if let Some((left, ends_row)) = &mut leaving
            && takers.may_come(now)
        {
            let hits = takers.lanes.min(*left);
            *left -= hits;
            leave_steps += 1;
            ended += takers.put(now, hits, *ends_row && *left == 0);
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
    }
    let mut told: Vec<_> = STAGES.iter().zip(&stages).map(|((name, _), stage)| (*name, stage.steps)).collect();
    told.insert(0, ("loader", (before + count as u64) * per_row));
    told.push(("deciders", decided / u64::from(sizes.deciders)));
    told.push(("hits", leave_steps));
    if takers.side_by_side > 0 {
        told.push(("SCPUs", takers.busy));
    }
    Predicted { cycles: now + CYCLES_TO_END + takers.latency, stages: told }
}
