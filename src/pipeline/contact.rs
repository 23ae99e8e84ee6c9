//! The contact of a pair as a pipeline.

use std::sync::Arc;

use super::trace::{Ports, trace};
use super::wire::Wire;
use crate::hdl::{BuildErrors, DelayModel, Module};
use crate::kernel::{Arithmetic, Filtered, contact, exact};
use crate::number::{Format, Number};
use crate::query::{Fields, Flow, GROUPS, Query, Rule};

/// The parameters that affect a kernel's bits and stages.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The query.
    pub query: Query,
    /// The kernel and its arithmetic.
    pub arithmetic: Arithmetic,
    /// The format of the pair's and the contact's words.
    pub record: Format,
    /// The requested outputs.
    pub fields: Fields,
    /// The radius of all spheres, if they have the same. Then there are no inputs for radii.
    pub radius: Option<f32>,
    /// The clock that operators are cut for, in MHz.
    pub clock_mhz: f64,
    /// Cycles from one pair to the next: 1, or more with fewer operators.
    pub interval: u32,
    /// True if `valid` arrives one cycle after the pair, because its logic examines the whole pair. Not at an interval
    /// above 1.
    pub valid_is_late: bool,
    /// True if every pair that matters touches, because another kernel decided it. Then nothing is decided here: there
    /// is no `valid`, `hit` or `invalid_pair`, and what comes out for another pair is undefined.
    pub touching: bool,
    /// The target's delay model.
    pub model: DelayModel,
}

/// The module of a query's kernel. The inputs are the words of a pair, by their names, and `valid`. The outputs are
/// `hit`, `grazing` (if centres can coincide) and the requested fields, by the names of their words in
/// [`GROUPS`](crate::query::GROUPS), [`Module::latency`] cycles later.
///
/// `valid` is a Boolean of the kernel like any other, and is not reset. With [`Settings::valid_is_late`] it arrives one
/// cycle after the pair. It may be set only if the pair's words keep their rules. Without it, or without a hit, all
/// outputs are zero. The kernel of exact squares also has an output `unsettled`, which may be set without a hit.
///
/// At an interval above 1, the module is [`Kernel::pipeline_every`](super::Kernel::pipeline_every). `take` announces
/// the inputs, which stay for the interval. The output `invalid_pair` is the complement of `valid`.
///
/// # Errors
/// Returns the first error that a graph recorded, or an error if an operator cannot be cut for the clock.
pub fn contact_kernel(settings: &Settings) -> Result<Arc<Module>, BuildErrors> {
    let kernel = trace(settings.query.shape().kernel, |ports| read(ports, settings))?.supposed();
    match settings.interval {
        0 | 1 => kernel.pipeline(&settings.model, settings.clock_mhz),
        interval => kernel.pipeline_every(&settings.model, settings.clock_mhz, interval),
    }
}

/// True if the values of the kernel never come near the ends of the exponent range, so that its operators are those of
/// [`crate::operator::Values::Normal`].
///
/// # Errors
/// Returns the first error that a graph recorded.
pub fn is_normal(query: Query, arithmetic: Arithmetic, fields: Fields) -> Result<bool, BuildErrors> {
    let settings = Settings {
        query,
        arithmetic,
        record: arithmetic.record(Format::BINARY32),
        fields,
        radius: None,
        clock_mhz: 100.0,
        interval: 1,
        valid_is_late: false,
        touching: false,
        model: DelayModel::default(),
    };
    Ok(trace(query.shape().kernel, |ports| read(ports, &settings))?.not_normal().is_none())
}

fn read(ports: &Ports, settings: &Settings) {
    let Settings { query, arithmetic, record, fields, radius, .. } = *settings;
    let shape = query.shape();
    ports.about(format!("contact of {}: {fields}", shape.bodies));
    let computed_in = match arithmetic {
        Arithmetic::Rounded(format) => format!("{format}"),
        Arithmetic::Exact => format!("{} and exact squares, then {}", Format::DIFFERENCE, Format::TAIL),
    };
    ports.about(format!("computed in {computed_in}, words in {record}"));
    let mut words: Vec<Wire> = Vec::with_capacity(shape.inputs.len());
    for input in shape.inputs {
        let of_all = radius.filter(|_| input.is_radius).zip(words.first());
        words.push(
            of_all.map_or_else(|| ports.input(input.name, record), |(radius, word)| word.constant(radius.into())),
        );
    }
    let valid = match (settings.touching, settings.valid_is_late) {
        (true, _) => ports.always(),
        (_, true) => ports.input_bit_after("valid", 1),
        (_, false) => ports.input_bit("valid"),
    };
    let inputs = || shape.inputs.iter().zip(&words).filter(|(input, _)| radius.is_none() || !input.is_radius);
    for not_negative in [false, true] {
        let ruled = inputs().filter(|(input, _)| (input.rule == Rule::NotNegative) == not_negative);
        ports.promise_finite(valid, &ruled.map(|(_, word)| *word).collect::<Vec<_>>(), not_negative);
    }
    if let Some(radius) = radius {
        ports.about(format!("every sphere's radius is {radius}"));
    }
    let word = |i: usize| words[i];
    let contact = match arithmetic {
        Arithmetic::Rounded(format) => contact(query, word, valid, format, record, fields),
        Arithmetic::Exact => {
            let Filtered { contact, unsettled } = exact(word, valid, record, fields);
            ports.output_bit("unsettled", unsettled);
            contact
        }
    };

    if settings.touching {
        ports.suppose(contact.hit);
    } else {
        if settings.interval > 1 {
            ports.output_bit("invalid_pair", !valid);
        }
        ports.output_bit("hit", contact.hit);
    }
    if shape.flows.contains(&Flow::Coincident) {
        ports.output_bit("grazing", contact.coincident);
    }
    let numbers = contact.numbers();
    let named = GROUPS.iter().flat_map(|group| group.words.iter().map(|name| ((group.is_asked)(fields), *name)));
    for ((asked, name), number) in named.zip(numbers) {
        if asked {
            ports.output(name, number);
        }
    }
}
