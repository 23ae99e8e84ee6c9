//! A record that differs from the reference's, told so that a person can begin to search.

use std::fmt::Write;

use crate::kernel::{ContactRecord, PAIR_FIELDS, PairRecord};

/// The words of a contact record, in order.
pub const CONTACT_FIELDS: [&str; 8] = ["pos_x", "pos_y", "pos_z", "normal_x", "normal_y", "normal_z", "depth", "flags"];

/// One record that is not what it should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// The pair's number in its job, from 0.
    pub number: u64,
    /// The clock cycle in which its line was written, from the start of the job; none: it never was.
    pub cycle: Option<u64>,
    /// What went in.
    pub pair: PairRecord,
    /// What the reference kernel gives.
    pub expected: ContactRecord,
    /// What lies in destination memory.
    pub got: ContactRecord,
}

impl Mismatch {
    /// A paragraph: where, the pair, and the words that differ, in hex and value.
    pub fn text(&self, job: &str) -> String {
        let mut text = format!("mismatch: {job}, pair {}, ", self.number);
        match self.cycle {
            Some(cycle) => write!(text, "written in cycle {cycle}"),
            None => write!(text, "never written"),
        }
        .expect("a string takes all");
        let word = |bits: u32| format!("{bits:08x} ({:?})", f32::from_bits(bits));
        for (name, bits) in PAIR_FIELDS.into_iter().zip(self.pair.0) {
            write!(text, "\n    {name:<9} {}", word(bits)).expect("a string takes all");
        }
        let words = self.expected.0.into_iter().zip(self.got.0);
        for (name, (expected, got)) in CONTACT_FIELDS.into_iter().zip(words).filter(|(_, (e, g))| e != g) {
            let shown = if name == "flags" { |bits: u32| format!("{bits:08x}") } else { word };
            write!(text, "\n  {name}: expected {}, got {}", shown(expected), shown(got)).expect("a string takes all");
        }
        text
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
        let mismatch = Mismatch { number: 3, cycle: Some(99), pair, expected, got };
        expect![[r#"
            mismatch: diamond:10, pair 3, written in cycle 99
                x1        00000000 (0.0)
                y1        00000000 (0.0)
                z1        00000000 (0.0)
                r1        3f000000 (0.5)
                x2        3f800000 (1.0)
                y2        00000000 (0.0)
                z2        80000000 (-0.0)
                r2        3f000000 (0.5)
              depth: expected 00000000 (0.0), got 00000001 (1e-45)
              flags: expected 00000007, got 00000002"#]]
        .assert_eq(&mismatch.text("diamond:10"));
    }
}
