//! A Sphere Collision Processing Unit: raw words in, a contact record out, one pair every cycle or every few cycles.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, Signal};
use crate::query::{ContactRecord, DEPTH, FLAGS, Fields, Flow, Rule};

use super::Spec;

/// Builds the module of this name around a kernel, with detection of invalid pairs on the raw words, flags, and record
/// packing. Its latency is the kernel's.
pub(super) fn scpu(spec: &Spec, name: &str, kernel: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new(name);
    let latency = kernel.latency;
    let every = match spec.config.interval {
        0 | 1 => "cycle".to_owned(),
        interval => format!("{interval} cycles"),
    };
    graph.about(format!(
        "one sphere collision processing unit: a pair every {every}, its record {latency} cycles later"
    ));
    let (layout, record) = (spec.layout(), spec.config.record.format());
    let bits = record.width();
    // Announces a pair that then stays for the interval.
    let take = (spec.config.interval > 1).then(|| graph.input("take", 1));
    let pair = graph.input("pair", layout.pair_bits());
    let inputs = || layout.inputs().map(|(_, input)| input);
    let words: Vec<Signal<'_>> =
        inputs().zip(0..).map(|(input, index)| pair.slice(bits * index, bits).named(input.name)).collect();

    // A NaN, an infinity or a negative radius makes a pair invalid (−0 is valid). A register separates the test of the
    // words from its effect on the pair, because the kernel uses the result one cycle later.
    let is_late = take.is_none();
    let mut invalid = graph.constant(1, 0);
    // Behind deciders, the kernel decides nothing.
    let decides = kernel.port("hit").is_some();
    for (word, input) in words.iter().zip(inputs()).filter(|_| decides) {
        let name = input.name;
        let is_special = word.slice(record.fraction_bits(), record.exponent_bits()).all();
        let mut seen = vec![is_special.named(&format!("{name}_is_special"))];
        if input.rule == Rule::NotNegative {
            seen.push((word.msb() & word.low(bits - 1).any()).named(&format!("{name}_negative")));
        }
        invalid = seen.into_iter().fold(invalid, |invalid, seen| invalid | seen.delay(u32::from(is_late)));
    }
    let invalid = if decides { invalid.named("invalid") } else { invalid };

    let mut inputs: Vec<(&str, Signal<'_>)> = inputs().map(|input| input.name).zip(words).collect();
    inputs.extend(decides.then(|| ("valid", !invalid)));
    inputs.extend(take.map(|take| ("take", take)));
    let kernel = graph.instance("kernel", kernel, &inputs);
    let (hit, invalid) = if decides {
        let invalid = match take {
            Some(_) => kernel.output("invalid_pair"),
            None => invalid.delay(latency - 1),
        };
        (kernel.output("hit").named("hit"), invalid.named("invalid_out"))
    } else {
        (graph.constant(1, 1), graph.constant(1, 0))
    };
    let record = if spec.config.contact == Fields::HIT {
        Some(hit).filter(|_| layout.result_bits() > 0)
    } else {
        let coincides = spec.config.query.shape().flows.contains(&Flow::Coincident);
        let coincident = coincides.then(|| kernel.output("grazing").named("grazing"));
        let exact = spec.config.profile.is_exact();
        let unsettled = exact.then(|| kernel.output("unsettled").named("unsettled"));
        let no_flow = unsettled.map_or(invalid, |unsettled| invalid | unsettled);
        let code = |flow: Flow| graph.constant(2, flow as u128);
        let touching = || match coincident {
            Some(coincident) => coincident.select(code(Flow::Coincident), code(Flow::Real)),
            None => code(Flow::Real),
        };
        let flow = no_flow.select(code(Flow::Invalid), hit.select(touching(), code(Flow::Fake)));
        let flags: Vec<_> = unsettled.into_iter().chain([invalid, flow.named("flow"), hit]).collect();
        let flags = Signal::join(&flags).extend(bits).named("flags");
        let number = |word: usize| kernel.output(ContactRecord::NAMES[word]);
        let of_word = |word: usize| match word {
            FLAGS => flags,
            // Without flags the depth's sign, which is otherwise 0, says which way the pair went.
            DEPTH if layout.sign_is_flow() => {
                coincident.map_or(number(word), |coincident| coincident.concat(number(word).low(bits - 1)))
            }
            _ => number(word),
        };
        let mut words: Vec<Signal<'_>> = layout.contact_words().into_iter().map(of_word).collect();
        words.reverse();
        Some(Signal::join(&words).extend(layout.result_bits()))
    };
    if let Some(record) = record {
        graph.output("record", record);
    }
    graph.output("contact", hit);
    graph.output("invalid_pair", invalid);
    let mut unit = graph.finish()?;
    if let Some(unit) = Arc::get_mut(&mut unit) {
        unit.latency = latency;
    }
    Ok(unit)
}
