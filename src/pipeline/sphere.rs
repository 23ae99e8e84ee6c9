//! The contact of two spheres as a pipeline.

use std::sync::Arc;

use nalgebra::Vector3;

use super::trace::{Ports, trace};
use super::wire::Wire;
use crate::hdl::{BuildErrors, DelayModel, Module};
use crate::kernel::{Arithmetic, Fields, Filtered, PAIR_FIELDS, Pair, contact, exact};
use crate::number::{Format, Number};

/// What decides the sphere kernel's bits and stages.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The kernel, and what it computes in.
    pub arithmetic: Arithmetic,
    /// The format of the pair's and the contact's words.
    pub record: Format,
    /// The outputs asked for.
    pub fields: Fields,
    /// The one radius of all spheres, if they have one: there are then no inputs for radii.
    pub radius: Option<f32>,
    /// The clock that operators are cut for, in MHz.
    pub clock_mhz: f64,
    /// Cycles from one pair to the next: 1, or more with fewer operators.
    pub interval: u32,
    /// Whether `valid` comes a cycle after the pair, from logic that has to look at all of it. Not at an interval above
    /// 1.
    pub valid_is_late: bool,
    /// How long the target takes for each operation.
    pub model: DelayModel,
}

/// The module `sphere_kernel`: a pair on inputs `x1 y1 z1 r1 x2 y2 z2 r2` with `valid`; `hit`, `grazing` and the
/// fields asked for (`pos_x pos_y pos_z`, `normal_x normal_y normal_z`, `depth`), [`Module::latency`] cycles later.
///
/// `valid` is a Boolean of the kernel like any other, and not reset; where [`Settings::valid_is_late`] it comes a
/// cycle after the pair. It may be set only if the pair's words are
/// finite and its radii not below zero. Without it, or without a hit, all outputs are zero. The kernel of exact squares
/// has an output `unsettled` too, which may be set without a hit.
///
/// At an interval above 1 it is [`Kernel::pipeline_every`](super::Kernel::pipeline_every): `take` announces the inputs,
/// which stay for the interval; and the output `invalid_pair` is the complement of `valid`.
///
/// # Errors
/// What a graph recorded, or a clock no operator can be cut for.
pub fn sphere_kernel(settings: &Settings) -> Result<Arc<Module>, BuildErrors> {
    let kernel = trace("sphere_kernel", |ports| read(ports, settings))?;
    match settings.interval {
        0 | 1 => kernel.pipeline(&settings.model, settings.clock_mhz),
        interval => kernel.pipeline_every(&settings.model, settings.clock_mhz, interval),
    }
}

/// Whether the values of the kernel never come near the ends of the exponent range, so that its operators are those of
/// [`crate::operator::Values::Normal`].
///
/// # Errors
/// What a graph recorded.
pub fn is_normal(arithmetic: Arithmetic, fields: Fields) -> Result<bool, BuildErrors> {
    let settings = Settings {
        arithmetic,
        record: arithmetic.record(Format::BINARY32),
        fields,
        radius: None,
        clock_mhz: 100.0,
        interval: 1,
        valid_is_late: false,
        model: DelayModel::default(),
    };
    Ok(trace("sphere_kernel", |ports| read(ports, &settings))?.not_normal().is_none())
}

fn read(ports: &Ports, settings: &Settings) {
    let Settings { arithmetic, record, fields, radius, .. } = *settings;
    ports.about(format!("contact of two spheres: {fields}"));
    let computed_in = match arithmetic {
        Arithmetic::Rounded(format) => format!("{format}"),
        Arithmetic::Exact => format!("{} and exact squares, then {}", Format::DIFFERENCE, Format::TAIL),
    };
    ports.about(format!("computed in {computed_in}, words in {record}"));
    let sphere = |names: &[&'static str]| {
        let centre = Vector3::new(names[0], names[1], names[2]).map(|name| ports.input(name, record));
        let own = || ports.input(names[3], record);
        (centre, radius.map_or_else(own, |radius| centre.x.constant(radius.into())))
    };
    let ((p1, r1), (p2, r2)) = (sphere(&PAIR_FIELDS[..4]), sphere(&PAIR_FIELDS[4..]));
    let valid = match settings.valid_is_late {
        true => ports.input_bit_after("valid", 1),
        false => ports.input_bit("valid"),
    };
    ports.promise_finite(valid, &[p1.x, p1.y, p1.z, p2.x, p2.y, p2.z], false);
    match radius {
        Some(radius) => ports.about(format!("every sphere's radius is {radius}")),
        None => ports.promise_finite(valid, &[r1, r2], true),
    }
    let pair = Pair { p1, r1, p2, r2 };
    let contact = match arithmetic {
        Arithmetic::Rounded(format) => contact(pair, valid, format, record, fields),
        Arithmetic::Exact => {
            let Filtered { contact, unsettled } = exact(pair, valid, record, fields);
            ports.output_bit("unsettled", unsettled);
            contact
        }
    };

    if settings.interval > 1 {
        ports.output_bit("invalid_pair", !valid);
    }
    ports.output_bit("hit", contact.hit);
    ports.output_bit("grazing", contact.coincident);
    let vector = |asked: bool, names: [&str; 3], value: Vector3<Wire>| {
        if asked {
            names.iter().zip(value.iter()).for_each(|(name, component)| ports.output(name, *component));
        }
    };
    vector(fields.position, ["pos_x", "pos_y", "pos_z"], contact.position);
    vector(fields.normal, ["normal_x", "normal_y", "normal_z"], contact.normal);
    if fields.depth {
        ports.output("depth", contact.depth);
    }
}
