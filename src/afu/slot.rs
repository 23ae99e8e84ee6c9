//! One SCPU's place among the others: it takes a pair from the lanes when it is its turn, and puts the result on the
//! lane its pair came from. All slots see the same lanes; the results are or-ed together outside.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, Signal};

use super::{SCPU_BITS, Spec};

/// Register ranks before the SCPU: the chosen pair is registered.
const RANKS_BEFORE: u32 = 1;

/// Cycles from the lanes to the results, for an SCPU of that latency.
pub(super) fn latency(kernel_latency: u32) -> u32 {
    RANKS_BEFORE + kernel_latency
}

/// Builds the module `scpu_slot`.
pub(super) fn slot(spec: &Spec, scpu: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("scpu_slot");
    graph.about("an SCPU's place: takes a pair in its turn, answers on the lane the pair came from");
    let (layout, lanes, group_bits) = (spec.layout(), spec.lanes(), spec.group_bits());

    let index = graph.input("index", SCPU_BITS);
    let scpus = graph.input("scpus", SCPU_BITS);
    let in_turn = graph.input("in_turn", SCPU_BITS);
    let pairs = graph.input("pairs", lanes * layout.pair_bits());
    let out_group = graph.input("out_group", group_bits);
    let out_turn = graph.input("out_turn", SCPU_BITS);

    // Lane j of a group that begins with SCPU `turn` belongs to SCPU (turn + j) mod N. What an SCPU takes outside its
    // turn is not used. Size and turn arrive one cycle before the pairs, so that the selection among these is
    // registered. No lane is N or above, and the parameter says so, so that synthesis leaves out the lanes that few
    // SCPUs never use.
    let in_lane = lane(index, in_turn, scpus).named("in_lane");
    let mut chosen = pairs.low(layout.pair_bits());
    for number in 1..lanes {
        let is_used = scpus.greater_than(scpus.same(u128::from(number)));
        let here = (in_lane.is(u128::from(number)) & is_used).delay(1).named(&format!("takes_lane_{number}"));
        chosen = here.select(pairs.slice(number * layout.pair_bits(), layout.pair_bits()), chosen);
    }
    let unit = if spec.config.interval > 1 {
        // The pair stays until the next one. The SCPU gets its valid bit one cycle ahead.
        let in_group = graph.input("in_group", group_bits);
        let width = SCPU_BITS.max(group_bits);
        let takes = in_lane.extend(width).less_than(in_group.extend(width)).registered("takes");
        let pair = graph.data_register("pair", layout.pair_bits());
        pair.next_if(takes, chosen);
        graph.instance("unit", scpu, &[("take", takes), ("pair", pair.value())])
    } else {
        graph.instance("unit", scpu, &[("pair", chosen.delay(RANKS_BEFORE).named("pair"))])
    };

    // The lane of the result is known a cycle ahead, so that its gates follow a register.
    let out_lane = lane(index, out_turn, scpus).named("out_lane");
    for number in 0..lanes {
        let mine = out_lane.is(u128::from(number)) & out_group.greater_than(out_group.same(u128::from(number)));
        let mine = mine.delay(1).named(&format!("answers_lane_{number}"));
        if layout.result_bits() > 0 {
            graph.output(&format!("record_{number}"), unit.output("record").gate(mine));
        }
        graph.output(&format!("contact_{number}"), unit.output("contact") & mine);
        graph.output(&format!("invalid_{number}"), unit.output("invalid_pair") & mine);
    }
    graph.finish()
}

/// (index − turn) mod N.
fn lane<'g>(index: Signal<'g>, turn: Signal<'g>, scpus: Signal<'g>) -> Signal<'g> {
    index.less_than(turn).select(index + scpus - turn, index - turn)
}
