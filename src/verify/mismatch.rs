//! A record that differs from the reference, with what a person needs to find the cause.

use std::fmt;

use crate::query::{ContactRecord, Flow, PairRecord, Query};

/// A record that differs from the expected one. Its text is a paragraph with the pair and the words that differ, in hex
/// and as values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// The query of the pair.
    pub query: Query,
    /// The pair's number in its job, from 0.
    pub number: usize,
    /// The cycle of the job in which its line was last written; `None` if never.
    pub cycle: Option<u64>,
    /// The pair.
    pub pair: PairRecord,
    /// The record of the reference kernel.
    pub expected: ContactRecord,
    /// The record in destination memory; `None` if nothing was written. If only contacts come back, a pair without one
    /// is expected to have zero words.
    pub got: Option<ContactRecord>,
}

impl Mismatch {
    /// The words that differ: the place in a contact record, the expected word, and the word found, if any.
    pub fn differences(&self) -> impl Iterator<Item = (usize, u32, Option<u32>)> {
        let Self { expected, got, .. } = *self;
        let words = expected.0.into_iter().enumerate();
        let words = words.map(move |(word, expected)| (word, expected, got.map(|got| got.0[word])));
        words.filter(|&(_, expected, got)| got != Some(expected))
    }
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { query, number, cycle, pair, .. } = self;
        write!(f, "pair {number}, ")?;
        match cycle {
            Some(cycle) => write!(f, "written in cycle {cycle}")?,
            None => f.write_str("never written")?,
        }
        let word = |bits: u32| format!("{bits:08x} ({:?})", f32::from_bits(bits));
        for (name, bits) in query.shape().names().zip(pair.0) {
            write!(f, "\n  {name:<9} {}", word(bits))?;
        }
        let told = |name: &str, bits: u32| match name {
            "flags" => format!("{bits:08x} ({})", ContactRecord::of_flags(bits).flow().map_or("no flow", Flow::name)),
            _ => word(bits),
        };
        for (index, expected, got) in self.differences() {
            let name = ContactRecord::NAMES[index];
            write!(f, "\n  {name:<9} expected {}", told(name, expected))?;
            if let Some(got) = got {
                write!(f, ", got {}", told(name, got))?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use expect_test::expect;

    #[test]
    fn only_differing_words_are_told() {
        let pair = PairRecord::from_spheres([0.0, 0.0, 0.0, 0.5], [1.0, 0.0, -0.0, 0.5]);
        let expected = ContactRecord([0x3f00_0000, 0, 0, 0xbf80_0000, 0, 0, 0, 7]);
        let mut got = expected;
        got.0[6] = 1;
        got.0[7] = 2;
        let mismatch =
            Mismatch { query: Query::SphereSphere, number: 3, cycle: Some(99), pair, expected, got: Some(got) };
        expect![[r#"
            pair 3, written in cycle 99
              x1        00000000 (0.0)
              y1        00000000 (0.0)
              z1        00000000 (0.0)
              r1        3f000000 (0.5)
              x2        3f800000 (1.0)
              y2        00000000 (0.0)
              z2        80000000 (-0.0)
              r2        3f000000 (0.5)
              depth     expected 00000000 (0.0), got 00000001 (1e-45)
              flags     expected 00000007 (real), got 00000002 (fake)"#]]
        .assert_eq(&mismatch.to_string());
    }
}
