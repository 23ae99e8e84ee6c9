//! What the rest of a study needs, by what its measured points took.

use std::collections::BTreeMap;

use super::{Point, Shard, State};
use crate::store::{Spent, Store, StoreError};

/// What a study needs that is split into shards.
#[derive(Clone, Debug, PartialEq)]
pub struct Needs {
    /// Points that are known so far.
    pub points: usize,
    /// Those of them that were measured.
    pub measured: usize,
    /// Mean seconds that one process took for a measured point; `None` if none was measured.
    pub mean_seconds: Option<f64>,
    /// Seconds of the longest measured point: no number of processes makes a study shorter.
    pub longest_seconds: f64,
    /// Seconds that the shard with the most work needs for its points that were not measured.
    pub shard_seconds: f64,
    /// The most memory that a process and one of its children held together, MiB.
    pub peak_memory_mib: u64,
}

/// What the points of a ledger need in so many shards. A point that was not measured is taken to need as long as the
/// mean of its kind, or else of all.
///
/// # Errors
/// Returns an error if the store cannot be read.
pub fn needs(store: &Store, ledger: &[(Point, State)], shards: u32) -> Result<Needs, StoreError> {
    let mut by_kind: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    let (mut all, mut peak_memory_mib): (Vec<f64>, u64) = (Vec::new(), 0);
    for (point, _) in ledger {
        if let Some(Spent { seconds, peak_memory_mib: peak }) = store.spent(&point.key)? {
            by_kind.entry(point.key.kind()).or_default().push(seconds);
            all.push(seconds);
            peak_memory_mib = peak_memory_mib.max(peak);
        }
    }
    let mean = |seconds: &Vec<f64>| seconds.iter().sum::<f64>() / seconds.len() as f64;
    let mean_seconds = (!all.is_empty()).then(|| mean(&all));
    let guess = |point: &Point| by_kind.get(point.key.kind()).map(mean).or(mean_seconds).unwrap_or_default();
    let open: Vec<&Point> = ledger.iter().filter(|(_, state)| *state != State::Made).map(|(point, _)| point).collect();
    let of_shard = |shard: Shard| open.iter().filter(|point| shard.holds(&point.part)).map(|point| guess(point)).sum();
    Ok(Needs {
        points: ledger.len(),
        measured: ledger.len() - open.len(),
        mean_seconds,
        longest_seconds: all.iter().copied().fold(0.0, f64::max),
        shard_seconds: Shard::all(shards).map(of_shard).fold(0.0, f64::max),
        peak_memory_mib,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::Key;

    #[test]
    fn what_was_measured_tells_of_the_rest() {
        let store = Store::temporary().expect("a temporary folder");
        let point = |kind: &str, of: u32| Point::new(of.to_string(), Key::new(kind, &of).expect("JSON"));
        let mut ledger: Vec<(Point, State)> = (0..40).map(|of| (point("route/1", of), State::Missing)).collect();
        let none = needs(&store, &ledger, 4).expect("read");
        assert_eq!((none.points, none.measured, none.mean_seconds, none.shard_seconds), (40, 0, None, 0.0));
        for (index, seconds, peak) in [(0, 10.0, 300), (1, 20.0, 200)] {
            store.put_spent(&ledger[index].0.key, &0, Spent { seconds, peak_memory_mib: peak }).expect("kept");
            ledger[index].1 = State::Made;
        }
        ledger.push((point("count/1", 1), State::Made));
        store.put_spent(&ledger[40].0.key, &0, Spent { seconds: 3.0, peak_memory_mib: 1 }).expect("kept");
        let whole = needs(&store, &ledger, 1).expect("read");
        assert_eq!((whole.points, whole.measured, whole.mean_seconds), (41, 3, Some(11.0)));
        assert_eq!((whole.longest_seconds, whole.shard_seconds, whole.peak_memory_mib), (20.0, 38.0 * 15.0, 300));
        let parts = needs(&store, &ledger, 4).expect("read").shard_seconds;
        assert!(parts >= whole.shard_seconds / 4.0 && parts < whole.shard_seconds, "the largest of four: {parts}");
    }
}
