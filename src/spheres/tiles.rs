//! Sets that are larger than a table: tiles of them, a job for every two.

use super::{Hit, ROW, Spheres};

/// A job: some spheres of the first set, and those that they are compared with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    /// The spheres. Without a second set the tile is compared with itself.
    pub sets: Spheres,
    /// The number of the first sphere of each in the whole set.
    pub from: [u32; 2],
}

impl Tile {
    /// Hits of the tile, with the numbers that their spheres have in the whole sets.
    pub fn translate(&self, hits: impl IntoIterator<Item = Hit>) -> impl Iterator<Item = Hit> {
        let from = self.from;
        hits.into_iter().map(move |hit| Hit { spheres: [0, 1].map(|set| hit.spheres[set] + from[set]), ..hit })
    }
}

/// A size that no tile can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("tiles of {size} spheres: expected a multiple of {ROW} from {ROW} to {most}, the spheres of the table")]
pub struct TileSizeError {
    /// What was given.
    pub size: u32,
    /// The spheres of the table.
    pub most: u32,
}

/// Cuts sets into tiles of at most `size` spheres, for a table of `most`. Every two spheres that are compared in the
/// whole sets are compared in exactly one tile. Tiles with the same spheres in the table come one after the other.
///
/// # Errors
/// Returns an error if the size is no multiple of a row, or does not fit into the table.
pub fn tiles(sets: &Spheres, size: u32, most: u32) -> Result<impl Iterator<Item = Tile>, TileSizeError> {
    if size == 0 || !(size as usize).is_multiple_of(ROW) || size > most {
        return Err(TileSizeError { size, most });
    }
    let length = size as usize;
    // Numbers of spheres are 32-bit words: what is cut is never larger.
    let start = move |tile: usize| tile as u32 * size;
    // An empty set is a job as well.
    let count = move |spheres: &[_]| spheres.len().div_ceil(length).max(1);
    let part = move |spheres: &[super::Sphere], tile: usize| {
        spheres.chunks(length).nth(tile).map(<[_]>::to_vec).unwrap_or_default()
    };
    let firsts = count(&sets.first);
    Ok((0..firsts).flat_map(move |first| {
        let seconds = sets.second.as_deref().map_or(first..firsts, |second| 0..count(second));
        seconds.map(move |second| Tile {
            sets: Spheres {
                first: part(&sets.first, first),
                second: match &sets.second {
                    Some(others) => Some(part(others, second)),
                    None => (second > first).then(|| part(&sets.first, second)),
                },
            },
            from: [start(first), start(second)],
        })
    }))
}

/// Puts hits of all tiles in the order that they have in the whole sets: that of
/// [`Candidates::pairs`](super::Candidates::pairs).
pub fn join_tiles(hits: &mut [Hit]) {
    let row = ROW as u32;
    hits.sort_unstable_by_key(|Hit { spheres: [first, second], .. }| [second / row, first / row, *second, *first]);
}

#[cfg(test)]
mod tests {
    use super::super::{Search, SphereSet};
    use super::*;
    use crate::kernel::{Arithmetic, Reference};
    use crate::number::Format;
    use crate::query::Fields;

    /// Tiles of every size find what the whole search finds, in its order.
    #[test]
    fn tiles_find_what_the_whole_search_finds() {
        let search = Search::new(Arithmetic::Rounded(Format::WIDE), 24).expect("a search");
        let mut reference = Reference::new(Format::WIDE, Fields::ALL);
        let mut find = |sets: &Spheres| {
            search.find(&mut reference, &sets.first, sets.second.as_deref()).expect("the reference works")
        };
        let dense = SphereSet::Gas(150, 600).spheres(3);
        let two = SphereSet::Probes(100, 170).spheres(3);
        let none = Spheres { first: dense.first.clone(), second: Some(Vec::new()) };
        for (sets, tiles_of_16) in [(dense, 55), (two, 77), (none, 10), (Spheres::default(), 1)] {
            let whole = find(&sets);
            for size in [16, 48, 160] {
                let mut hits = Vec::new();
                let mut candidates = 0;
                let mut jobs = 0;
                for tile in tiles(&sets, size, 512).expect("a size") {
                    let found = find(&tile.sets);
                    candidates += found.counts.candidates;
                    hits.extend(tile.translate(found.hits));
                    jobs += 1;
                }
                join_tiles(&mut hits);
                assert_eq!(hits, whole.hits, "tiles of {size}");
                assert_eq!(candidates, whole.counts.candidates);
                assert!(size > 16 || jobs == tiles_of_16, "{jobs}");
            }
        }
    }

    #[test]
    fn a_size_that_no_tile_can_have_is_refused() {
        for size in [0, 8, 24, 1024] {
            let error = tiles(&Spheres::default(), size, 512).err().expect("refused");
            assert_eq!(error, TileSizeError { size, most: 512 });
        }
        let text = TileSizeError { size: 24, most: 512 }.to_string();
        assert_eq!(text, "tiles of 24 spheres: expected a multiple of 16 from 16 to 512, the spheres of the table");
    }
}
