//! One SCPU's place in the chain: it takes the pair that names it from the lanes that pass, and puts the result on the
//! same lane as it passes behind the SCPUs.
//!
//! Pairs and results go from slot to slot, a register each. A pair that goes further in comes out nearer to the end, so
//! every pair takes the same number of cycles, and results leave in the order of their pairs.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, Signal};

use super::rounds::uses_lane;
use super::{SCPU_BITS, Spec, wide};

/// Register ranks before the SCPU: the chosen pair is registered. At interval 1 a second rank stands at the SCPU, whose
/// first stages are carry chains. At others the pair stays in the first one.
pub(super) fn ranks_before(spec: &Spec) -> u32 {
    if spec.config.interval > 1 { 1 } else { 2 }
}

/// Cycles from a pair before its slot to its result behind the SCPU, for an SCPU of that latency. The chain's
/// registers, as many as there are slots, come on top.
pub(super) fn latency(spec: &Spec, kernel_latency: u32) -> u32 {
    ranks_before(spec) + kernel_latency
}

/// Builds the module of this name.
pub(super) fn slot(spec: &Spec, name: &str, scpu: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new(name);
    graph.about("an SCPU's place in the chain: takes the pairs that name it, answers on the lane a pair came from");
    let (layout, lanes) = (spec.layout(), spec.lanes());
    let pair_bits = layout.pair_bits();

    let index = graph.input("index", SCPU_BITS);
    let scpus = graph.input("scpus", SCPU_BITS);
    // Which lanes carry a pair, and for which SCPU, arrives one cycle before the pairs. The slot before has compared
    // whether that is this one.
    let carries = graph.input("carries_in", lanes);
    let targets = graph.input("targets_in", lanes * SCPU_BITS);
    let names = graph.input("names_in", lanes);
    let pairs = graph.input("pairs_in", lanes * pair_bits);

    let is_used = |lane: u32| uses_lane(spec, scpus, lane);
    let mine: Vec<_> = (0..lanes).map(|lane| carries.bit(lane) & names.bit(lane) & is_used(lane)).collect();
    let taken: Vec<_> =
        mine.iter().zip(0..).map(|(mine, lane)| mine.registered(&format!("takes_lane_{lane}"))).collect();
    // At most one lane names this SCPU. Whether it carries a pair need not be known to choose it.
    let chosen = (1..lanes).fold(pairs.low(pair_bits), |chosen, lane| {
        let takes = wide::steering(names.bit(lane) & is_used(lane), &format!("chooses_lane_{lane}"), pair_bits);
        wide::select(&takes, pairs.slice(lane * pair_bits, pair_bits), chosen)
    });
    let unit = if spec.config.interval > 1 {
        // The pair stays until the next one. The SCPU gets its valid bit one cycle ahead.
        let takes = mine.iter().fold(graph.constant(1, 0), |any, mine| any | *mine).registered("takes");
        let pair = graph.data_register("pair", pair_bits);
        pair.next_if(takes, chosen);
        graph.instance("unit", scpu, &[("take", takes), ("pair", pair.value())])
    } else {
        graph.instance("unit", scpu, &[("pair", chosen.delay(1).named("chosen").delay(1).named("pair"))])
    };
    graph.output("carries_out", carries.registered("carries"));
    graph.output("targets_out", targets.delay(1).named("targets"));
    let next = index.plus(1).named("next_index");
    let names_next = (0..lanes).rev().map(|lane| targets.slice(lane * SCPU_BITS, SCPU_BITS).equals(next));
    graph.output("names_out", Signal::join(&names_next.collect::<Vec<_>>()).delay(1).named("names"));
    graph.output("pairs_out", pairs.delay(1).named("pairs"));

    // The lanes that this SCPU answers are delayed beside it. Which lanes carry a result is known one cycle ahead of
    // the results.
    let taken = taken.into_iter().rev().reduce(Signal::concat).unwrap_or_else(|| graph.constant(1, 0));
    let taken = if lanes > 1 { taken.named("takes_lanes") } else { taken };
    let answers_next = taken.delay(latency(spec, scpu.latency) - 1).named("answers_soon");
    let leaves = graph.input("leaves_in", lanes);
    graph.output("leaves_out", (leaves | answers_next).registered("leaves"));
    for lane in 0..lanes {
        let answers = answers_next.bit(lane) & is_used(lane);
        let answers = wide::steering(answers, &format!("answers_lane_{lane}"), layout.result_bits().max(1));
        let pass = |what: &str, own: Signal<'_>| {
            let name = format!("{what}_{lane}");
            let passing = graph.input(&format!("{name}_in"), own.width());
            let answers = &answers[..answers.len().min(own.width() as usize)];
            graph.output(&format!("{name}_out"), wide::select(answers, own, passing).delay(1).named(&name));
        };
        if layout.result_bits() > 0 {
            pass("record", unit.output("record"));
        }
        pass("contact", unit.output("contact"));
        pass("invalid", unit.output("invalid_pair"));
    }
    graph.finish()
}

/// A row of so many slots, each the instance `NAME_i`, of those that pass in `passing` (each without `_in`): what
/// passes behind the last one.
pub(super) fn row<'g>(
    graph: &'g Graph,
    name: &str,
    slot: &Arc<Module>,
    units: u32,
    mut passing: Vec<(String, Signal<'g>)>,
) -> Vec<(String, Signal<'g>)> {
    for unit in 0..units {
        let names: Vec<_> = passing.iter().map(|(name, _)| format!("{name}_in")).collect();
        let mut inputs: Vec<_> =
            names.iter().map(String::as_str).zip(passing.iter().map(|(_, signal)| *signal)).collect();
        inputs.push(("index", graph.constant(SCPU_BITS, unit.into())));
        inputs.push(("scpus", graph.constant(SCPU_BITS, units.into())));
        let slot = graph.instance(&format!("{name}_{unit}"), slot, &inputs);
        for (name, signal) in &mut passing {
            *signal = slot.output(&format!("{name}_out"));
        }
    }
    passing
}

/// The same for a chain whose length is the parameter `scpus`.
pub(super) fn chain<'g>(
    graph: &'g Graph,
    name: &str,
    slot: &Arc<Module>,
    scpus: Signal<'g>,
    passing: Vec<(String, Signal<'g>)>,
) -> Vec<(String, Signal<'g>)> {
    let names: Vec<_> = passing.iter().map(|(name, _)| format!("{name}_in")).collect();
    let inputs = names.iter().map(String::as_str).zip(passing.iter().map(|(_, signal)| *signal));
    let inputs: Vec<_> = [("scpus", scpus)].into_iter().chain(inputs).collect();
    let last = graph.chain(name, slot, scpus, &inputs);
    passing.into_iter().map(|(name, _)| (name.clone(), last.output(&format!("{name}_out")))).collect()
}
