//! Statistics of the errors of many answers.

use super::Judgement;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Statistics of errors. Infinite ones are not included, because they are counted as gross failures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// The number of errors, including zeros: one per contact that was found.
    pub count: u64,
    /// The mean.
    pub mean: f64,
    /// The 99.9th percentile, from above and to 3 %. For several sets together, the largest of theirs.
    pub p999: f64,
    /// The largest.
    pub largest: f64,
}

impl Spread {
    /// The statistics of both together. The percentile is the larger one.
    #[must_use]
    pub fn plus(self, other: &Self) -> Self {
        let count = self.count.saturating_add(other.count);
        let sum = self.mean * self.count as f64 + other.mean * other.count as f64;
        Self {
            count,
            mean: if count > 0 { sum / count as f64 } else { 0.0 },
            p999: self.p999.max(other.p999),
            largest: self.largest.max(other.largest),
        }
    }
}

/// Errors of contacts' numbers, in units in the last place of binary32 and relative, as in [`Judgement`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ErrorStatistics {
    /// Errors of the depth, in ulps of the depth.
    pub depth_ulps: Spread,
    /// Errors of the normal, in ulps of 1.
    pub normal_ulps: Spread,
    /// Errors of the position, in ulps of the largest number that it is computed from.
    pub position_ulps: Spread,
    /// Errors of the depth, relative to the sizes that it is computed from.
    pub depth: Spread,
    /// Errors of the normal, relative to 1.
    pub normal: Spread,
    /// Errors of the position, relative to the largest number that it is computed from.
    pub position: Spread,
    /// The largest of the three relative errors of a contact.
    pub contact: Spread,
}

impl ErrorStatistics {
    /// The statistics of both together.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let [a, b] = [self.spreads(), other.spreads()];
        Self::of(std::array::from_fn(|i| a[i].plus(&b[i])))
    }

    fn spreads(&self) -> [Spread; FIGURES] {
        let Self { depth_ulps, normal_ulps, position_ulps, depth, normal, position, contact } = *self;
        [depth_ulps, normal_ulps, position_ulps, depth, normal, position, contact]
    }

    fn of(spreads: [Spread; FIGURES]) -> Self {
        let [depth_ulps, normal_ulps, position_ulps, depth, normal, position, contact] = spreads;
        Self { depth_ulps, normal_ulps, position_ulps, depth, normal, position, contact }
    }
}

const FIGURES: usize = 7;

/// Errors that are being gathered.
#[derive(Clone, Debug, Default)]
pub(super) struct Gathered([Gathering; FIGURES]);

impl Gathered {
    /// Adds the errors of one more contact that was found.
    pub fn add(&mut self, found: &Judgement) {
        let contact = found.relative.iter().copied().fold(0.0, f64::max);
        let errors = found.ulps.into_iter().chain(found.relative).chain([contact]);
        self.0.iter_mut().zip(errors).for_each(|(gathering, error)| gathering.add(error));
    }

    /// Adds the errors of another collection.
    pub fn extend(&mut self, other: Self) {
        self.0.iter_mut().zip(other.0).for_each(|(mine, other)| mine.extend(other));
    }

    /// The statistics of all errors so far.
    pub fn errors(&self) -> ErrorStatistics {
        ErrorStatistics::of(self.0.each_ref().map(Gathering::spread))
    }
}

#[derive(Clone, Debug, Default)]
struct Gathering {
    count: u64,
    sum: f64,
    largest: f64,
    /// The number of errors with these leading bits: sign, exponent and five bits of the fraction.
    leading: BTreeMap<u64, u64>,
}

/// Bits of a binary64 number below its leading ones.
const BELOW: u32 = 52 - 5;

impl Gathering {
    fn add(&mut self, error: f64) {
        if !error.is_finite() {
            return;
        }
        self.count += 1;
        self.sum += error;
        self.largest = self.largest.max(error);
        *self.leading.entry(error.abs().to_bits() >> BELOW).or_default() += 1;
    }

    fn extend(&mut self, other: Self) {
        self.count += other.count;
        self.sum += other.sum;
        self.largest = self.largest.max(other.largest);
        other.leading.into_iter().for_each(|(bits, count)| *self.leading.entry(bits).or_default() += count);
    }

    fn spread(&self) -> Spread {
        let Some(mean) = (self.count > 0).then(|| self.sum / self.count as f64) else { return Spread::default() };
        let mut above = self.count / 1000;
        let mut p999 = 0.0;
        for (&bits, &count) in self.leading.iter().rev() {
            if count > above {
                // The bound of exact zero is zero.
                p999 = if bits == 0 { 0.0 } else { f64::from_bits((bits + 1) << BELOW) };
                break;
            }
            above -= count;
        }
        Spread { count: self.count, mean, p999: p999.min(self.largest), largest: self.largest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_is_that_of_its_errors() {
        let mut gathered = Gathering::default();
        (1..=10_000).for_each(|i| gathered.add(f64::from(i)));
        gathered.add(f64::NAN);
        gathered.add(f64::INFINITY);
        let spread = gathered.spread();
        assert_eq!((spread.count, spread.mean, spread.largest), (10_000, 5_000.5, 10_000.0));
        assert!((9_990.0..9_990.0 * 1.032).contains(&spread.p999), "{spread:?}");
        assert_eq!(Gathering::default().spread(), Spread::default());
        let mut zeros = Gathering::default();
        (0..5_000).for_each(|_| zeros.add(0.0));
        zeros.add(1.0);
        assert_eq!((zeros.spread().p999, zeros.spread().largest), (0.0, 1.0));
    }

    #[test]
    fn parts_add_up() {
        let mut parts = [Gathering::default(), Gathering::default()];
        let mut whole = Gathering::default();
        for i in 0..3_000 {
            parts[i % 2].add(i as f64);
            whole.add(i as f64);
        }
        let [a, b] = parts;
        let apart = a.spread().plus(&b.spread());
        let mut together = a;
        together.extend(b);
        assert_eq!(together.spread(), whole.spread());
        assert!((apart.mean - whole.spread().mean).abs() < 1e-9 && apart.largest == whole.largest);
    }
}
