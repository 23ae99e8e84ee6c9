//! A pair as words.

use super::{Input, Query, Rule};

/// The number of words in the largest pair of any query. A record has room for sixteen.
pub const PAIR_WORDS: usize = {
    let (mut most, mut i) = (0, 0);
    while i < Query::ALL.len() {
        let words = Query::ALL[i].shape().inputs.len();
        if words > most {
            most = words;
        }
        i += 1;
    }
    most
};

/// The largest word that keeps its rule, for each word of each query.
const LARGEST: [[u32; PAIR_WORDS]; Query::ALL.len()] = {
    let mut largest = [[u32::MAX; PAIR_WORDS]; Query::ALL.len()];
    let mut query = 0;
    while query < Query::ALL.len() {
        let inputs = Query::ALL[query].shape().inputs;
        let mut word = 0;
        while word < inputs.len() {
            largest[query][word] = inputs[word].rule.largest();
            word += 1;
        }
        query += 1;
    }
    largest
};

/// A pair: the words of its query's [`inputs`](super::Shape::inputs), floating-point numbers as raw binary32.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct PairRecord(pub [u32; PAIR_WORDS]);

impl PairRecord {
    /// The pair of these numbers, in order; the remaining words are zero.
    pub(crate) fn of_values(values: impl IntoIterator<Item = f32>) -> Self {
        let mut pair = Self::default();
        pair.0.iter_mut().zip(values).for_each(|(word, value)| *word = value.to_bits());
        pair
    }

    /// Two spheres, each x y z and radius.
    pub fn from_spheres(first: [f32; 4], second: [f32; 4]) -> Self {
        Self::of_values(first.into_iter().chain(second))
    }

    /// A sphere (x y z and radius), and the plane of all points p with n · p = d (the normal n, of length 1, and d).
    pub fn from_sphere_and_plane(sphere: [f32; 4], plane: [f32; 4]) -> Self {
        Self::of_values(sphere.into_iter().chain(plane))
    }

    /// True if every word keeps its [rule](super::Rule).
    #[inline(always)]
    pub fn is_valid(&self, query: Query) -> bool {
        // Without branches and of constant length, so that the batch kernel checks a whole block at a time.
        let largest = &LARGEST[query as usize];
        (0..PAIR_WORDS).fold(true, |all, word| all & Rule::holds_below(self.0[word], largest[word]))
    }

    /// The first word that breaks its rule.
    pub fn broken(&self, query: Query) -> Option<&'static Input> {
        query.shape().inputs.iter().zip(self.0).find(|(input, word)| !input.rule.holds(*word)).map(|(input, _)| input)
    }

    /// The words read as numbers.
    pub fn values(self) -> [f32; PAIR_WORDS] {
        self.0.map(f32::from_bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_break_their_rule_are_found_in_every_place() {
        for query in Query::ALL {
            let good = PairRecord([-0.0; PAIR_WORDS].map(f32::to_bits));
            assert!(good.is_valid(query) && good.broken(query).is_none());
            for (i, input) in query.shape().inputs.iter().enumerate() {
                for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1e-45, f32::MIN, f32::MAX] {
                    let mut pair = good;
                    pair.0[i] = bad.to_bits();
                    let breaks = !bad.is_finite() || input.rule == Rule::NotNegative && bad < 0.0;
                    assert_eq!(pair.is_valid(query), !breaks, "{bad} as {}", input.name);
                    assert_eq!(pair.broken(query).map(|input| input.name), breaks.then_some(input.name));
                }
            }
        }
    }
}
