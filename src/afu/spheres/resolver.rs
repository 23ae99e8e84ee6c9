//! The resolver: SCPUs that compute the contacts of the spheres that touch, with all spheres that are in the table or
//! searched. Each has a cycle of its own; a contact leaves in the order of its hit.

use std::sync::Arc;

use super::bounds::SPHERE_BITS;
use super::store::{CYCLES_TO_WORD, Store};
use super::walk::later;
use super::{KEPT_ROWS, NUMBER_BITS, ROW_BITS, Sizes};
use crate::afu::slot::{self, slot};
use crate::afu::{SCPU_BITS, Spec};
use crate::hdl::{BuildErrors, Graph, Module};

/// SCPUs that resolve: as many as take one contact per cycle, at most. The others are not built.
fn units(spec: &Spec) -> u32 {
    spec.scpus_in_turn(spec.config.interval)
}

/// Cycles from the numbers of two spheres to their contact, for SCPUs of that latency.
pub(super) fn latency(spec: &Spec, scpu: &Module) -> u32 {
    CYCLES_TO_WORD + slot::latency(scpu.latency) + units(spec)
}

/// Builds the module `contact_afu_resolver`. The numbers of a hit come a cycle after `carries`, which is `from_step`
/// cycles after its step in the stage before. `may_come` says a cycle ahead whether there may be such a step.
pub(super) fn resolver(
    spec: &Spec,
    sizes: &Sizes,
    scpu: &Arc<Module>,
    from_step: u32,
) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_resolver");
    graph.about("computes the contacts of the spheres that touch");
    let units = units(spec);
    let start = graph.input("start", 1);
    let carries = graph.input("carries", 1);
    let numbers = graph.input("numbers", 2 * NUMBER_BITS);

    // The two spheres: the first is in the table, the second in a row that is searched.
    let names = sizes.of_loaded("write_sphere");
    let spheres: Vec<_> = names.iter().map(|name| graph.input(name, SPHERE_BITS)).collect();
    let column = graph.input("write_column", sizes.loaded_bits());
    let mut both = Vec::new();
    for (name, number, row_bits) in
        [("table", numbers.low(NUMBER_BITS), sizes.row_bits), ("kept", numbers.high(NUMBER_BITS), KEPT_ROWS.ilog2())]
    {
        let write = graph.input(&format!("write_{name}"), 1);
        let write_place = graph.input(&format!("write_{name}_row"), row_bits).concat(column);
        let row = number.slice(ROW_BITS, row_bits).named(&format!("row_in_{name}"));
        let place = number.low(ROW_BITS).named(&format!("column_in_{name}"));
        let store = Store::new(spec, row_bits + sizes.loaded_bits());
        both.push(store.sides(&graph, &format!("{name}_spheres"), (write, write_place), &spheres, (row, place))?);
    }
    let pair = both[1].concat(both[0]).named("pair");

    // An SCPU that shares operators takes pairs a whole number of intervals apart, so the cycle says which one it is.
    let interval = spec.config.interval.max(1);
    let comes = later(start, carries, CYCLES_TO_WORD, "pair_comes");
    let counter = |name: &str, first: u32| {
        let phase = graph.register(name, SCPU_BITS, u128::from(first % interval));
        phase.next(phase.is((interval - 1).into()).select(phase.same(0), phase.plus(1)));
        phase.value()
    };
    let phase = counter("phase", 0);
    // The phase in which a hit would reach its SCPU that leaves the stage before in the next cycle.
    let may_come = if units == interval {
        graph.constant(1, 1)
    } else {
        let reached = counter("phase_reached", from_step + 1 + CYCLES_TO_WORD);
        reached.less_than(reached.same(units.into()))
    };
    graph.output("may_come", may_come);
    // A pair fills a line of its own here, so one lane goes through the chain of SCPUs.
    let line_bits = spec.layout().pair_bits();
    let slot = slot(&Spec { line_bits, ..spec.clone() }, scpu)?;
    let result_bits = spec.layout().result_bits();
    let zero = |bits: u32| graph.constant(bits, 0);
    let mut passes = vec![
        ("carries", comes),
        ("targets", phase),
        ("pairs", pair),
        ("leaves", zero(1)),
        ("record_0", zero(result_bits)),
        ("contact_0", zero(1)),
        ("invalid_0", zero(1)),
    ];
    for unit in 0..units {
        let names: Vec<_> = passes.iter().map(|(name, _)| format!("{name}_in")).collect();
        let mut inputs: Vec<_> =
            names.iter().map(String::as_str).zip(passes.iter().map(|(_, signal)| *signal)).collect();
        inputs.push(("index", graph.constant(SCPU_BITS, unit.into())));
        inputs.push(("scpus", graph.constant(SCPU_BITS, units.into())));
        let slot = graph.instance(&format!("scpu_{unit}"), &slot, &inputs);
        for (name, signal) in &mut passes {
            *signal = slot.output(&format!("{name}_out"));
        }
    }
    let latency = latency(spec, scpu);
    let contact = passes.iter().find(|(name, _)| *name == "record_0").map_or(numbers, |(_, record)| *record);
    let record = contact.concat(numbers.delay(latency).named("numbers_then")).extend(spec.layout().contact_bits());
    // What was inside when a job was stopped does not come out in the next one.
    graph.output("put", later(start, carries, latency + 1, "resolving"));
    graph.output("record", record);
    graph.finish()
}
