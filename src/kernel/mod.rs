//! The mathematics of every query, written once for every [`Number`]: the reference kernel, its exact twins and the
//! netlist all instantiate [`contact()`].

pub mod batch;
mod contact;
pub mod double;
mod engine;
mod exact;
mod fast;
mod memory;
mod reference;
mod settle;
mod sphere_plane;
mod sphere_sphere;
mod truth;

pub use contact::{Contact, Scale};
pub use engine::{Engine, EngineError};
pub use exact::{Filtered, exact};
pub use fast::Fast;
pub use memory::{narrow, widen};
pub use reference::{Arithmetic, Reference};
pub use settle::settle;
pub use truth::{Truth, UlpErrors, ulp};

use crate::number::{Format, Number, Precise};
use crate::query::{Fields, PairRecord, Query};

/// The only place that maps a query to the file with its mathematics.
macro_rules! of_query {
    ($query:expr, $function:ident($($argument:expr),*)) => {
        match $query {
            Query::SphereSphere => sphere_sphere::$function($($argument),*),
            Query::SpherePlane => sphere_plane::$function($($argument),*),
        }
    };
}

/// The contact of a pair that is `valid`, computed in the format `arithmetic`. Words are given by their index in the
/// record; words and results are in the format `record`. Fields that are not asked for are zero.
///
/// The order of every sum and product is part of the contract: each rounds once, and hardware, reference and other
/// engines must round alike. Touching counts as contact.
#[inline(always)]
pub fn contact<T: Number>(
    query: Query,
    word: impl Fn(usize) -> T,
    valid: T::Bool,
    arithmetic: Format,
    record: Format,
    fields: Fields,
) -> Contact<T> {
    of_query!(query, contact(word, valid, arithmetic, record, fields))
}

/// The margin of the decision about a valid pair, relative to the magnitudes that it depends on: 0 to 1.
fn margin(query: Query, word: impl Fn(usize) -> Precise) -> f64 {
    of_query!(query, margin(word))
}

/// The magnitudes relative to which the errors of a contact are judged.
fn scale(query: Query, pair: &PairRecord) -> Scale {
    of_query!(query, scale(pair))
}
