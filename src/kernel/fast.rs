//! The profile `wide` in software at the speed of binary32.

use super::batch::{Batch, Level};
use super::{Engine, EngineError, Reference};
use crate::number::Format;
use crate::query::{ContactRecord, Fields, PairRecord, Query};

/// The binades of numbers with which binary32 computes a contact without underflow or overflow: 2^-18 to 2^18.
///
/// With numbers that are 0 or at least 2^-E, a difference is 0 or at least 2^-(E+23), a component of the normal at
/// least 2^-(2E+25), and the offset along it 0 or at least 2^-(E+47). The smallest product is that of the last two, at
/// least 2^-(3E+72), which is a normal number for E = 18. The largest number is the sum of three squares, below 2^40.
const BINADES: u32 = 18;

/// The contacts of two spheres in the profile `wide`, bit for bit. Where binary32 neither overflows nor underflows, the
/// batch kernel computes them; the reference computes the rest.
#[derive(Clone, Copy, Debug)]
pub struct Fast {
    level: Level,
    reference: Reference,
    fields: Fields,
}

impl Fast {
    /// The engine for these fields, with the widest SIMD instructions of this processor.
    pub fn new(fields: Fields) -> Self {
        Self { level: Level::best(), reference: Reference::new(Format::WIDE, fields), fields }
    }
}

impl Engine for Fast {
    fn contacts(&mut self, pairs: &[PairRecord]) -> Result<Vec<ContactRecord>, EngineError> {
        let batch = Batch::from_pairs(pairs);
        let mut computed = Batch::zeros(pairs.len());
        self.level.run(&batch, &mut computed, self.fields);
        let mut contacts: Vec<_> = computed.contacts().collect();
        for (contact, pair) in contacts.iter_mut().zip(pairs).filter(|(_, pair)| !is_moderate(pair)) {
            *contact = self.reference.run(pair);
        }
        Ok(contacts)
    }
}

/// True if binary32 neither overflows nor underflows for this pair, or if the pair is invalid.
fn is_moderate(pair: &PairRecord) -> bool {
    let (low, high) = ((127 - BINADES) << 23, (127 + BINADES) << 23);
    let words = pair.0.iter().map(|word| word & 0x7FFF_FFFF);
    words.fold(true, |all, word| all & (word == 0 || (low..high).contains(&word)))
        || !pair.is_valid(Query::SphereSphere)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of every scale and around the ends of the range, among them invalid ones.
    #[test]
    fn it_has_the_bits_of_the_reference() {
        let mut state = 9_u64;
        let mut bits = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as u32
        };
        let mut moderate = 0;
        let pairs: Vec<_> = (0..40_000)
            .map(|i| {
                let spread = [4, 36, 38, 254][i % 4];
                let mut number = || {
                    let exponent = (127 - spread / 2 + bits() % spread) << 23;
                    let sign = bits() << 31;
                    if bits() % 9 == 0 { sign } else { sign | exponent | bits() & 0x7F_FFFF }
                };
                let mut pair = PairRecord(std::array::from_fn(|_| number()));
                if i % 5 != 0 {
                    (pair.0[3], pair.0[7]) = (pair.0[3] & 0x7FFF_FFFF, pair.0[7] & 0x7FFF_FFFF);
                }
                moderate += usize::from(is_moderate(&pair));
                pair
            })
            .collect();
        for fields in [Fields::ALL, Fields::HIT] {
            let reference = Reference::new(Format::WIDE, fields);
            let contacts = Fast::new(fields).contacts(&pairs).expect("no failure");
            for (pair, contact) in pairs.iter().zip(contacts) {
                assert_eq!(contact, reference.run(pair), "{pair:?}");
            }
        }
        assert!((20_000..39_000).contains(&moderate), "{moderate}");
        let own = PairRecord::from_spheres([1e30, 0.0, 0.0, 1e30], [0.0, 0.0, 0.0, 1e30]);
        let binary32 = Reference::new(Format::BINARY32, Fields::ALL).run(&own);
        assert_ne!(Fast::new(Fields::ALL).contacts(&[own]).expect("no failure"), [binary32], "binary32 overflows");
    }
}
