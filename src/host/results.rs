//! What a transaction gave.

use super::error::HostError;
use super::report::Report;
use crate::kernel::{ContactRecord, PairRecord};

/// The names of a pair's words.
const WORDS: [&str; 8] = ["x1", "y1", "z1", "r1", "x2", "y2", "z2", "r2"];

/// The contacts of a transaction, with what the AFU said at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// One for each pair, in their order; words that the AFU does not compute are zero.
    pub contacts: Vec<ContactRecord>,
    /// Contacts among them, as the AFU counted.
    pub hits: u32,
    /// Invalid pairs, as the AFU counted.
    pub invalid: u32,
    /// The number of the first.
    pub first_invalid: Option<u32>,
    /// What it took.
    pub report: Report,
}

impl Results {
    /// Nothing, if every pair was one.
    ///
    /// # Errors
    /// [`HostError::InvalidPairs`], naming the first of `pairs` that is none, and its field.
    pub fn strict(&self, pairs: &[PairRecord]) -> Result<(), HostError> {
        let Some(first) = self.first_invalid else { return Ok(()) };
        let field = pairs.get(first as usize).and_then(bad_field).unwrap_or("word");
        Err(HostError::InvalidPairs { count: self.invalid, first, field })
    }
}

fn bad_field(pair: &PairRecord) -> Option<&'static str> {
    let is_bad = |(name, word): (&str, u32)| {
        let value = f32::from_bits(word);
        !value.is_finite() || name.starts_with('r') && value < 0.0
    };
    WORDS.into_iter().zip(pair.0).find(|&word| is_bad(word)).map(|(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bad_field_is_named() {
        let pair = |word: usize, value: f32| {
            let mut pair = PairRecord::from_spheres([0.0, 1.0, 2.0, -0.0], [3.0, 4.0, 5.0, 1e-45]);
            pair.0[word] = value.to_bits();
            pair
        };
        assert_eq!(bad_field(&pair(0, 0.0)), None);
        assert_eq!(bad_field(&pair(1, -5.0)), None);
        assert_eq!(bad_field(&pair(3, -5.0)), Some("r1"));
        assert_eq!(bad_field(&pair(6, f32::NAN)), Some("z2"));
        assert_eq!(bad_field(&pair(7, f32::INFINITY)), Some("r2"));
    }
}
