//! Queries: the kinds of pairs, as data. Hardware, reference, files, checks and documentation read the same [`Shape`];
//! only the mathematics, in [`crate::kernel`], is code.

mod contact_record;
mod fields;
mod flow;
mod pair_record;
mod shape;
mod sphere_plane;
mod sphere_sphere;

pub use contact_record::{CONTACT_WORDS, ContactRecord, DEPTH, FLAGS, GROUPS, Group, NUMBERS};
pub use fields::{Fields, FieldsError};
pub use flow::Flow;
pub use pair_record::{PAIR_WORDS, PairRecord};
pub use shape::{Input, Rule, Shape};

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// The two bodies of a pair. A new query is a file beside this one with its [`Shape`], a line here, and its
/// mathematics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Query {
    /// Two spheres, as in the paper.
    #[default]
    SphereSphere,
    /// A sphere and a plane. The normal of the plane points away from its solid side.
    SpherePlane,
}

impl Query {
    /// Every query.
    pub const ALL: [Self; 2] = [Self::SphereSphere, Self::SpherePlane];

    /// The query as data.
    pub const fn shape(self) -> &'static Shape {
        match self {
            Self::SphereSphere => &sphere_sphere::SHAPE,
            Self::SpherePlane => &sphere_plane::SHAPE,
        }
    }

    /// True for the default, which files leave out.
    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl fmt::Display for Query {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.shape().name)
    }
}

/// An unknown name of a query.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown query `{0}`: use {queries}", queries = Query::ALL.map(|query| query.shape().name).join(", "))]
pub struct QueryError(String);

impl FromStr for Query {
    type Err = QueryError;

    fn from_str(text: &str) -> Result<Self, QueryError> {
        Self::ALL.into_iter().find(|query| query.shape().name == text).ok_or_else(|| QueryError(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_query_is_read_by_its_name_in_options_and_files() {
        for query in Query::ALL {
            assert_eq!(query.to_string().parse(), Ok(query));
            assert_eq!(serde_json::to_string(&query).expect("a word"), format!("\"{query}\""));
        }
        let error = "box".parse::<Query>().expect_err("no such query").to_string();
        assert_eq!(error, "unknown query `box`: use sphere-sphere, sphere-plane");
    }

    /// The capability word has four bits for the query, and each pair fits a record.
    #[test]
    fn shapes_fit_their_records() {
        for (query, code) in Query::ALL.into_iter().zip(0..) {
            let shape = query.shape();
            assert!(shape.code == code && code < 16, "{query}");
            assert!(shape.inputs.len() <= PAIR_WORDS && PAIR_WORDS <= 16, "{query}");
            let names: std::collections::HashSet<_> = shape.inputs.iter().map(|input| input.name).collect();
            assert_eq!(names.len(), shape.inputs.len(), "{query}: a name stands twice");
        }
    }
}
