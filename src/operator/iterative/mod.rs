//! Roots for numbers that arrive a few cycles apart: a digit recurrence in which one rank of registers does several
//! steps, one or a few per cycle, instead of one rank per step.

mod rank;
mod recip;
mod recurrence;
mod sqrt;

use std::sync::Arc;

use recip::Reciprocal;
use recurrence::Recurrence;
use sqrt::Root;

use super::{Domain, Operator};
use crate::hdl::{BuildErrors, DelayModel, Module};
use crate::number::Roots;

/// A correctly rounded root, [`Operator::Recip`] or [`Operator::Sqrt`], for at most one number every `interval` cycles.
/// `None` for other operators.
///
/// Besides `a` and `result` it has an input `phase` of `interval` bits. Bit k is set k cycles after a number arrived,
/// and every `interval` cycles from then on. The result is available [`Module::latency`] cycles after the number, for
/// one cycle. It is the same as the [`pipelined`](super::pipelined) operator's, bit for bit. `area` decides which of
/// several variants is the smallest.
///
/// # Errors
/// Returns the first error that a graph recorded, or an error if it cannot be cut for the clock.
pub fn iterative(
    operator: Operator,
    domain: impl Into<Domain>,
    model: &DelayModel,
    clock_mhz: f64,
    interval: u32,
    area: impl Fn(&Module) -> u32,
) -> Result<Option<Arc<Module>>, BuildErrors> {
    let domain = domain.into();
    if domain.format().roots() == Roots::Faithful || interval < 2 {
        return Ok(None);
    }
    let recurrence: Box<dyn Recurrence> = match operator {
        Operator::Recip => Box::new(Reciprocal { domain }),
        Operator::Sqrt => Box::new(Root { domain }),
        _ => return Ok(None),
    };
    rank::smallest(recurrence.as_ref(), operator, model, clock_mhz, interval, area).map(Some)
}
