//! A part of a study's points.

use std::fmt;
use std::str::FromStr;

/// Shard K of M. A hash decides which points are its own, so a longer list moves no point to another shard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1 to [`Shard::of`].
    index: u32,
    of: u32,
}

impl Shard {
    /// The largest number of shards.
    pub const MAX: u32 = 100_000;

    /// Shard `index` of `of`; `None` unless 1 ≤ `index` ≤ `of` ≤ [`Shard::MAX`].
    pub fn new(index: u32, of: u32) -> Option<Self> {
        (1 <= index && index <= of && of <= Self::MAX).then_some(Self { index, of })
    }

    /// True if a point with this hash, in hexadecimal, belongs to the shard.
    pub(super) fn holds(self, hash: &str) -> bool {
        // 60 bits of a SHA-256: as uniform as any, and the remainder's bias is far below one point.
        let digits = hash.get(..15).and_then(|digits| u64::from_str_radix(digits, 16).ok());
        digits.is_some_and(|number| number % u64::from(self.of) == u64::from(self.index - 1))
    }

    /// All shards of so many.
    pub(super) fn all(of: u32) -> impl Iterator<Item = Self> {
        (1..=of).map(move |index| Self { index, of })
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(k, m)| Some((k.parse().ok()?, m.parse().ok()?)));
        let shard = numbers.and_then(|(index, of)| Self::new(index, of));
        shard.ok_or_else(|| format!("expected K/M with 1 ≤ K ≤ M ≤ {}, such as 2/4", Self::MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::sha256;

    #[test]
    fn every_point_is_of_one_shard_and_shards_are_of_a_size() {
        let hashes: Vec<String> = (0..10_000_u32).map(|number| sha256(&number.to_le_bytes())).collect();
        for of in [1, 2, 7, 16] {
            let mut sizes = vec![0_usize; of as usize];
            for hash in &hashes {
                let holders: Vec<Shard> = Shard::all(of).filter(|shard| shard.holds(hash)).collect();
                assert_eq!(holders.len(), 1, "{hash}");
                sizes[holders[0].index as usize - 1] += 1;
            }
            let mean = hashes.len() / of as usize;
            assert!(sizes.iter().all(|size| size.abs_diff(mean) * 5 < mean), "{sizes:?}");
        }
    }

    #[test]
    fn a_shard_is_read_as_it_is_written() {
        for text in ["1/1", "2/4", "100000/100000"] {
            assert_eq!(text.parse::<Shard>().map(|shard| shard.to_string()), Ok(text.to_owned()));
        }
        for text in ["", "1", "0/4", "5/4", "1/0", "-1/4", "1/100001", "1/2/3", "a/b"] {
            assert!(text.parse::<Shard>().expect_err(text).contains("such as 2/4"), "{text}");
        }
    }
}
