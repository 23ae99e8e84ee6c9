//! Ranks of a recurrence: each holds a number for as many cycles as the interval allows, and passes it on.

use std::sync::Arc;

use super::recurrence::Recurrence;
use crate::hdl::{BuildErrors, DelayModel, Graph, Instantiated, Module, Signal, Timing, cut};
use crate::operator::Operator;

/// More steps than this in one cycle are never worth it.
const MOST_STEPS: u32 = 8;

/// The smallest by `area` of the variants with one, two or more steps per cycle, as far as the clock allows.
///
/// # Errors
/// Returns the first error that a graph recorded, or an error if it cannot be cut for the clock.
pub(super) fn smallest(
    recurrence: &dyn Recurrence,
    operator: Operator,
    model: &DelayModel,
    clock_mhz: f64,
    interval: u32,
    area: impl Fn(&Module) -> u32,
) -> Result<Arc<Module>, BuildErrors> {
    let mut best: Option<Arc<Module>> = None;
    for at_once in 1..=MOST_STEPS {
        let logic = longest(recurrence, model, at_once)?;
        if at_once > 1 && logic > model.budget(clock_mhz) {
            break;
        }
        let unit = Unit { recurrence, operator, at_once, interval };
        let module = unit.build(model, clock_mhz, model.clock(logic))?;
        if best.as_ref().is_none_or(|best| area(&module) < area(best)) {
            best = Some(module);
        }
    }
    // The variant with one step per cycle always exists.
    best.ok_or_else(|| BuildErrors(Vec::new()))
}

/// Delay of this number of steps, and of the choice after them.
fn longest(recurrence: &dyn Recurrence, model: &DelayModel, at_once: u32) -> Result<f64, BuildErrors> {
    let graph = Graph::new("steps");
    let (first, kept) = recurrence.begin(graph.input("a", recurrence.domain().width()));
    let steps = recurrence.steps();
    let widths: Vec<u32> = recurrence.fit(&first, 0, steps).iter().map(|signal| signal.width()).collect();
    let input = |name: &str, index: usize, width: u32| graph.input(&format!("{name}_{index}"), width);
    let state: Vec<_> = widths.iter().enumerate().map(|(index, width)| input("state", index, *width)).collect();
    let kept: Vec<_> = kept.iter().enumerate().map(|(index, kept)| input("kept", index, kept.width())).collect();
    let mut after = state.clone();
    for step in 0..at_once {
        after = recurrence.step(&after, &kept, step);
    }
    let load = graph.input("load", 1);
    for (index, (state, after)) in state.iter().zip(after).enumerate() {
        graph.output(&format!("next_{index}"), load.select(*state, after));
    }
    Ok(model.longest(&*graph.finish()?))
}

struct Unit<'a> {
    recurrence: &'a dyn Recurrence,
    operator: Operator,
    /// Steps per cycle.
    at_once: u32,
    interval: u32,
}

impl Unit<'_> {
    fn build(&self, model: &DelayModel, clock_mhz: f64, rank_mhz: f64) -> Result<Arc<Module>, BuildErrors> {
        let Self { recurrence, at_once, interval, .. } = *self;
        let steps = recurrence.steps();
        let ranks = steps.div_ceil(at_once).div_ceil(interval);
        let a_rank = steps.div_ceil(at_once).div_ceil(ranks) * at_once;
        let name = format!("{}_every_{interval}", self.operator.module_name(recurrence.domain()));
        let before = cut(&*self.before(&name)?, model, clock_mhz)?;
        let after = cut(&*self.after(&name)?, model, clock_mhz)?;

        let graph = Graph::new(name);
        let digits = if at_once == 1 { "a digit" } else { "digits" };
        graph.about(format!("{}, one number every {interval} cycles", self.operator.name()));
        graph.about(format!("{ranks} ranks of registers with {digits} a cycle: {at_once} of {steps}"));
        graph.about("bit k of phase: k cycles since a number came, or as many and some intervals");
        let a = graph.input("a", recurrence.domain().width());
        let phase = graph.input("phase", interval);
        let first = graph.instance("first", &before, &[("a", a)]);
        let [mut state, mut kept] = ["state", "kept"].map(|name| outputs(&before, &first, name));
        let mut word = a.delay(before.latency);
        let mut cycle = before.latency;
        for rank in 0..ranks {
            let begun = rank * a_rank;
            let end = steps.min(begun + a_rank);
            let load = phase.bit(cycle % interval).named(&format!("load_{rank}"));
            let hold = |what: String, signal: Signal<'_>| graph.data_register(&what, signal.width());
            let word_register = hold(format!("word_{rank}"), word);
            word_register.next_if(load, word);
            let keep = |(index, value): (usize, &Signal<'_>)| {
                let register = hold(format!("kept_{rank}_{index}"), *value);
                (register, index)
            };
            let registers: Vec<_> = kept.iter().enumerate().map(keep).collect();
            registers.iter().for_each(|(register, index)| register.next_if(load, kept[*index]));
            kept = registers.iter().map(|(register, _)| register.value()).collect();

            let loaded = recurrence.fit(&state, begun, end);
            let registers: Vec<_> = loaded
                .iter()
                .enumerate()
                .map(|(index, value)| graph.data_register(&format!("state_{rank}_{index}"), value.width()))
                .collect();
            // In a rank's last cycle, fewer steps may be left.
            let cycles = (end - begun).div_ceil(at_once);
            let last = end - begun - (cycles - 1) * at_once;
            let mut now: Vec<_> = registers.iter().map(|register| register.value()).collect();
            for step in 1..=at_once {
                now = recurrence.step(&now, &kept, rank * at_once + step);
                if step == last {
                    state.clone_from(&now);
                }
            }
            for ((register, loaded), next) in registers.iter().zip(loaded).zip(now) {
                register.next(load.select(loaded, next));
            }
            word = word_register.value();
            cycle += cycles;
        }
        let outcome: Vec<_> = recurrence.outcome(&state).iter().map(|signal| signal.delay(1)).collect();
        let names: Vec<_> = (0..outcome.len()).map(|index| format!("outcome_{index}")).collect();
        let mut inputs: Vec<_> = names.iter().map(String::as_str).zip(outcome).collect();
        inputs.push(("a", word.delay(1)));
        graph.output("result", graph.instance("last", &after, &inputs).output("result"));
        let mut module = graph.finish()?;
        let inner = Arc::make_mut(&mut module);
        inner.latency = cycle + 1 + after.latency;
        let parts = [&before, &after].map(|part| part.timing.as_ref().map_or(rank_mhz, |timing| timing.clock_mhz));
        let clock_mhz = parts.into_iter().fold(rank_mhz, f64::min);
        inner.timing = Some(Timing { clock_mhz, stage: 0, critical: Vec::new(), register_bits: 0 });
        Ok(module)
    }

    /// The logic before the first step.
    fn before(&self, name: &str) -> Result<Arc<Module>, BuildErrors> {
        let graph = Graph::new(format!("{name}_first"));
        graph.about(format!("what comes before the steps of {}", self.operator.name()));
        let (state, kept) = self.recurrence.begin(graph.input("a", self.recurrence.domain().width()));
        for (name, signals) in [("state", state), ("kept", kept)] {
            signals.iter().enumerate().for_each(|(index, signal)| graph.output(&format!("{name}_{index}"), *signal));
        }
        graph.finish()
    }

    /// The logic after the last step.
    fn after(&self, name: &str) -> Result<Arc<Module>, BuildErrors> {
        let recurrence = self.recurrence;
        let widths = {
            let probe = Graph::new("probe");
            let (state, _) = recurrence.begin(probe.input("a", recurrence.domain().width()));
            let state = recurrence.fit(&state, 0, recurrence.steps());
            recurrence.outcome(&state).iter().map(|signal| signal.width()).collect::<Vec<_>>()
        };
        let graph = Graph::new(format!("{name}_last"));
        graph.about(format!("what comes behind the steps of {}", self.operator.name()));
        let a = graph.input("a", recurrence.domain().width());
        let outcome: Vec<_> =
            widths.iter().enumerate().map(|(index, width)| graph.input(&format!("outcome_{index}"), *width)).collect();
        graph.output("result", recurrence.finish(a, &outcome));
        graph.finish()
    }
}

/// The outputs called `name` and a number, in order.
fn outputs<'g>(module: &Module, instance: &Instantiated<'g>, name: &str) -> Vec<Signal<'g>> {
    let names = (0..).map(|index| format!("{name}_{index}"));
    names.take_while(|name| module.port(name).is_some()).map(|name| instance.output(&name)).collect()
}
