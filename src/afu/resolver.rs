//! The resolver: SCPUs that compute the contacts of pairs that are known to touch. Each has a cycle of its own; a
//! contact leaves in the order of its hit. A hit enters only if the dispatcher has room for all that are inside.
//!
//! With `--decide`, pairs wait in its memory while other SCPUs decide them. With spheres as input, it has the spheres
//! ([`super::spheres`]).

use std::sync::Arc;

use super::banks::{Turn, rotate, row};
use super::counter::{later, up_down};
use super::lines::{Access, CYCLES_TO_WORD, line_memory};
use super::slot::{self, slot};
use super::{COUNT_BITS, SCPU_BITS, Spec, packer, status, wide};
use crate::hdl::{BuildErrors, Graph, Instantiated, Module, Signal, delay_block};

/// Words of a block memory.
const MEMORY_DEPTH: u32 = 512;
/// Cycles from a backlog that is told that a hit may leave to `carries`.
const BACKLOG_TO_CARRIES: u32 = 1;
/// The same, to the hit's number.
pub(super) const BACKLOG_TO_NUMBER: u32 = BACKLOG_TO_CARRIES + 1;

/// The SCPUs of a resolver: as many as take one contact per cycle, at most. The others are not built.
pub(super) fn units(spec: &Spec) -> u32 {
    spec.scpus_in_turn(spec.config.interval) / lanes(spec)
}

/// Resolvers side by side, each with its SCPUs.
pub(super) fn lanes(spec: &Spec) -> u32 {
    spec.contact_lanes(spec.config.interval)
}

/// Cycles from the numbers of a hit to its contact, for SCPUs of that latency.
pub(super) fn latency(spec: &Spec, scpu: &Module) -> u32 {
    CYCLES_TO_WORD + slot::latency(spec, scpu.latency) + units(spec)
}

/// Builds the module `contact_afu_resolver` for pairs, `places` of which it keeps while they are decided.
pub(super) fn of_pairs(spec: &Spec, scpu: &Arc<Module>, places: u32) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_resolver");
    graph.about("keeps pairs that are being decided, computes the contacts of those that touch");
    let (lanes, pair_bits, place_bits) = (spec.lanes(), spec.layout().pair_bits(), places.ilog2());
    let start = graph.input("start", 1);
    let carries = graph.input("carries", 1);
    let number = graph.input("number", COUNT_BITS);

    // Pairs stand in the order in which they enter. Which lanes carry one is known a cycle before.
    let enters = graph.input("enters", lanes);
    let pairs = graph.input("pairs", lanes * pair_bits);
    let tail = graph.register("tail", place_bits, 0);
    tail.next(start.select(tail.same(0), tail.value() + status::number(&graph, enters).extend(place_bits)));
    let lane_bits = lanes.ilog2();
    let turns: Vec<_> =
        (0..lane_bits).map(|bit| wide::steering(tail.bit(bit), &format!("turns_by_{}", 1 << bit), pair_bits)).collect();
    let mut turned: Vec<_> = (0..lanes).map(|lane| pairs.slice(lane * pair_bits, pair_bits)).collect();
    for (turn, step) in turns.iter().zip((0..lane_bits).map(|bit| 1_usize << bit)) {
        let from = |lane: usize| turned[(lane + turned.len() - step) % turned.len()];
        turned = (0..turned.len()).map(|lane| wide::select(turn, from(lane), turned[lane])).collect();
    }
    let writes = rotate((0..lanes).map(|lane| enters.bit(lane)).collect(), tail.value(), Turn::Up);
    let place = number.low(place_bits);
    let always = graph.constant(1, 1);
    let mut banks = Vec::new();
    for (bank, (pair, writes)) in (0..lanes).zip(turned.into_iter().zip(writes)) {
        let access = Access {
            write: &[writes.delay(2).named(&format!("writes_bank_{bank}"))],
            write_index: row(tail.value(), bank, lanes).delay(2).named(&format!("row_of_bank_{bank}")),
            line: pair.delay(1).named(&format!("pair_for_bank_{bank}")),
            read: &[always],
            read_index: place.drop_low(lane_bits),
            advance: &[always],
        };
        banks.push(line_memory(&graph, spec, &format!("bank_{bank}"), places / lanes, &access)?);
    }
    let bank_is = |bank: u32| {
        let is = place.low(lane_bits).is(bank.into()).delay(CYCLES_TO_WORD - 1).named(&format!("bank_{bank}_soon"));
        wide::steering(is, &format!("bank_is_{bank}"), pair_bits)
    };
    let pair = (1..lanes).fold(banks[0], |pair, bank| wide::select(&bank_is(bank), banks[bank as usize], pair));
    resolve(&graph, spec, scpu, [start, carries, number, pair.named("pair")], BACKLOG_TO_CARRIES)?;

    // The oldest pair that is needed: the one behind the last hit that left or, if none waits, behind the last that is
    // decided. The places of those before it are free.
    let (decided, none_waits) = (graph.input("decided", COUNT_BITS), graph.input("none_waits", 1));
    let left = later(start, carries, 1, "hit_left");
    let count_bits = place_bits + 1;
    let needed = graph.register("oldest_needed", count_bits, 0);
    let without = none_waits.select(decided.low(count_bits), needed.value());
    let next = left.select(number.low(count_bits).plus(1), without).named("next_needed");
    needed.next(next.gate(!start));
    graph.output("freed", (next - needed.value()).gate(!start).registered("freed"));
    graph.finish()
}

/// The places of pairs that are decided or wait for it to be computed: at least as many, and whole block memories.
pub(super) fn places(spec: &Spec, at_least: u32) -> u32 {
    at_least.next_power_of_two().max(spec.lanes() * MEMORY_DEPTH)
}

/// The SCPUs, with the outputs `may_come`, `comes` and `record`. The number of a hit comes a cycle after `carries`,
/// which is `from_step` cycles after its step in the stage before, and its pair [`CYCLES_TO_WORD`] cycles after that.
/// `may_come` says a cycle ahead whether there may be such a step.
pub(super) fn resolve<'g>(
    graph: &'g Graph,
    spec: &Spec,
    scpu: &Arc<Module>,
    [start, carries, number, pair]: [Signal<'g>; 4],
    from_step: u32,
) -> Result<(), BuildErrors> {
    // An SCPU that shares operators takes pairs a whole number of intervals apart, so the cycle says which one it is.
    let (units, interval) = (units(spec), spec.config.interval.max(1));
    let comes = later(start, carries, CYCLES_TO_WORD, "pair_comes");
    let counter = |name: &str, first: u32| {
        let phase = graph.register(name, SCPU_BITS, u128::from(first % interval));
        phase.next(phase.is((interval - 1).into()).select(phase.same(0), phase.plus(1)));
        phase.value()
    };
    // The phase in which a hit would reach its SCPU that leaves the stage before in the next cycle.
    let may_come = if units == interval {
        graph.constant(1, 1)
    } else {
        let reached = counter("phase_reached", from_step + 1 + CYCLES_TO_WORD);
        reached.less_than(reached.same(units.into()))
    };
    graph.output("may_come", may_come);
    let latency = latency(spec, scpu);
    let contact = if units == 1 {
        // The pair stays for the interval. The SCPU gets its valid bit one cycle ahead.
        let unit = if interval > 1 {
            let takes = comes.registered("takes");
            let waits = graph.data_register("pair_in_scpu", pair.width());
            waits.next_if(takes, pair);
            graph.instance("scpu_0", scpu, &[("take", takes), ("pair", waits.value())])
        } else {
            graph.instance("scpu_0", scpu, &[("pair", pair.delay(slot::ranks_before(spec)).named("pair_in_scpu"))])
        };
        unit.output("record").delay(1).named("contact")
    } else {
        // A pair fills a line of its own here, so one lane goes through the chain of SCPUs.
        let alone = Spec { line_bits: spec.layout().pair_bits(), ..spec.clone() };
        let slot = slot(&alone, "scpu_slot", scpu)?;
        let zero = |bits: u32| graph.constant(bits, 0);
        let phase = counter("phase", 0);
        let passing = vec![
            ("carries".to_owned(), comes),
            ("targets".to_owned(), phase),
            ("names".to_owned(), phase.is(0)),
            ("pairs".to_owned(), pair),
            ("leaves".to_owned(), zero(1)),
            ("record_0".to_owned(), zero(spec.layout().result_bits())),
            ("contact_0".to_owned(), zero(1)),
            ("invalid_0".to_owned(), zero(1)),
        ];
        let passed = slot::row(graph, "scpu", &slot, units, passing);
        passed.into_iter().find(|(name, _)| name == "record_0").map_or(pair, |(_, record)| record)
    };
    // Each hit's number waits beside its SCPU: in a block memory, if the target has them.
    let number_then = match delay_block(latency, number.width(), &spec.delays)? {
        Some(block) => graph.instance("number_waits", &block, &[("value", number)]).output("delayed"),
        None => number.delay(latency),
    };
    let record = contact.concat(number_then.named("number_then")).extend(spec.layout().contact_bits());
    // What was inside when a job was stopped does not come out in the next one.
    graph.output("comes", later(start, carries, latency, "resolving"));
    graph.output("record", record);
    Ok(())
}

/// The most cycles whose records are still in flight when the dispatcher has no room left. The stage before stops two
/// cycles later. From its step to the number of a hit are `to_number` cycles, and then come those to the dispatcher.
fn on_the_way(spec: &Spec, scpu: &Module, to_number: u32) -> u32 {
    2 + to_number + latency(spec, scpu) + packer::cycles_to_line(spec) + packer::cycles_to_flush(spec)
}

/// Lines of the dispatcher behind a resolver (a power of two): half of them hold all that is on its way.
pub(super) fn lines(spec: &Spec, scpu: &Module, to_number: u32) -> u32 {
    let records = lanes(spec) * on_the_way(spec, scpu, to_number);
    let of_lines = records.div_ceil(spec.layout().contacts_per_line()) + 1;
    (2 * of_lines).next_power_of_two()
}

/// What resolvers give to the packer and to the stage before.
pub(super) struct Resolved<'g> {
    /// True if hits may leave for the resolvers in this cycle.
    pub(super) may_leave: Signal<'g>,
    /// The resolvers whose contact comes in the next cycle, a bit each.
    pub(super) comes: Signal<'g>,
    /// The contact of each.
    pub(super) records: Vec<Signal<'g>>,
    /// True if none is in a resolver, and `hits_out` said that no hit comes.
    pub(super) all_out: Signal<'g>,
}

/// The signals around resolvers side by side, in the top. `carries` has a bit for each that a hit enters, from the
/// first one on. They may enter as long as the dispatcher `accepts` lines. All resolvers take the same cycles.
pub(super) fn resolved<'g>(
    graph: &'g Graph,
    spec: &Spec,
    scpu: &Module,
    resolvers: &[Instantiated<'g>],
    [start, run, carries, hits_out, accepts]: [Signal<'g>; 5],
) -> Resolved<'g> {
    let may_leave = (accepts & resolvers[0].output("may_come") & run).registered("hit_may_leave");
    let comes: Vec<_> = resolvers.iter().rev().map(|resolver| resolver.output("comes")).collect();
    let comes = Signal::join(&comes);
    let inside = graph.register("contacts_inside", latency(spec, scpu).ilog2() + 1, 0);
    up_down(inside, start, carries.bit(0), comes.bit(0));
    let all_out = (hits_out & !inside.any() & !start).registered("contacts_all_out");
    let records = resolvers.iter().map(|resolver| resolver.output("record")).collect();
    Resolved { may_leave, comes, records, all_out }
}
