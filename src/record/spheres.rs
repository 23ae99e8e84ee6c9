//! Spheres in lines, four each: a set begins at a row of 16, which is four lines.

use super::Layout;
use super::pack::{Line, pack_records};
use crate::spheres::{Hit, ROW, Sphere};

/// Words of a sphere.
const WORDS: usize = 4;
/// Spheres in a line.
const PER_LINE: usize = 16 / WORDS;
/// The spheres of a second set, at most: as many as the 16 bits of a hit's number count.
const MOST_OTHERS: usize = 1 << 16;

/// A set has more spheres than a job can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SetTooLarge {
    /// The first set does not fit into the AFU's table.
    #[error("{spheres} spheres: the AFU's table holds {table}; use a larger --table, or --tile {table}")]
    First {
        /// Spheres of the first set.
        spheres: usize,
        /// Spheres that the table holds.
        table: u32,
    },
    /// A hit's number cannot represent all spheres of the second set.
    #[error("{0} spheres in the second set: expected at most 65536 in a job; cut the sets with --tile")]
    Second(usize),
}

impl SetTooLarge {
    /// Checks the numbers of spheres in the first set and in the second, for an AFU with this table.
    ///
    /// # Errors
    /// Fails with the first set that is too large.
    pub(crate) fn check(first: usize, second: usize, table: u32) -> Result<(), Self> {
        if first > table as usize {
            return Err(Self::First { spheres: first, table });
        }
        if second > MOST_OTHERS {
            return Err(Self::Second(second));
        }
        Ok(())
    }
}

/// Lines of a set of spheres.
pub(crate) fn sphere_lines(spheres: u64) -> u64 {
    spheres.div_ceil(ROW as u64) * (ROW / PER_LINE) as u64
}

/// The lines of a set. The padding of its last row is zero.
pub(crate) fn pack_spheres(spheres: &[Sphere]) -> Vec<Line> {
    let mut lines = vec![[0; 16]; sphere_lines(spheres.len() as u64) as usize];
    for (place, sphere) in spheres.iter().enumerate() {
        let first = place % PER_LINE * WORDS;
        lines[place / PER_LINE][first..first + WORDS].copy_from_slice(&sphere.0);
    }
    lines
}

/// The lines of hits: each begins with the number of the first sphere below that of the second, 16 bits each. The
/// padding of the last line is zero.
pub(crate) fn pack_hits(layout: &Layout, hits: &[Hit]) -> Vec<Line> {
    let record = |hit: &Hit| (hit.spheres[1] << 16 | hit.spheres[0], hit.contact);
    pack_records(layout, &hits.iter().map(record).collect::<Vec<_>>())
}

/// The spheres of a set of `count` spheres, from its lines.
pub(crate) fn unpack_spheres(lines: &[Line], count: usize) -> Vec<Sphere> {
    let words = lines.iter().flat_map(|line| line.as_chunks::<WORDS>().0);
    words.take(count).map(|words| Sphere(*words)).collect()
}

/// The two numbers in the word that a hit begins with.
pub(crate) fn numbers_of(word: u32) -> [u32; 2] {
    [word & 0xFFFF, word >> 16]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Config, Input, Results};
    use crate::query::{ContactRecord, Flow};
    use crate::record::Contacts;

    #[test]
    fn a_set_ends_with_a_row() {
        for (spheres, lines) in [(0, 0), (1, 4), (16, 4), (17, 8)] {
            let set: Vec<_> = (0..spheres).map(|place| Sphere([place, 1, 2, 3])).collect();
            let packed = pack_spheres(&set);
            assert_eq!(packed.len(), lines);
            let words: Vec<u32> = packed.concat();
            assert!(set.iter().zip(words.chunks(4)).all(|(sphere, words)| sphere.0 == words));
            assert!(words[4 * set.len()..].iter().all(|word| *word == 0));
            assert_eq!(unpack_spheres(&packed, set.len()), set);
        }
    }

    #[test]
    fn a_hit_begins_with_two_numbers() {
        let layout = |contact: &str| {
            let contact = contact.parse().expect("fields");
            Layout::of(512, &Config { input: Input::Spheres, results: Results::Hits, contact, ..Config::default() })
        };
        let contact = |flow: Flow| ContactRecord([1, 2, 3, 4, 5, 6, 7, flow.flags()]);
        let hit = |flow| Hit { spheres: [7, 65_535], contact: contact(flow) };
        let lines = pack_hits(&layout("hit"), &[hit(Flow::Real); 17]);
        assert_eq!((lines.len(), lines[0][15], lines[1][0], lines[1][1]), (2, 0xFFFF_0007, 0xFFFF_0007, 0));
        assert_eq!(numbers_of(lines[0][15]), [7, 65_535]);
        // All fields fit into half a line, because the depth's sign says whether the centres coincide.
        let hits = [hit(Flow::Real), hit(Flow::Coincident), hit(Flow::Real)];
        let all = layout("hit,depth,normal,position");
        let lines = pack_hits(&all, &hits);
        assert_eq!(lines[0], [0xFFFF_0007, 1, 2, 3, 4, 5, 6, 7, 0xFFFF_0007, 1, 2, 3, 4, 5, 6, 7 | 1 << 31]);
        for contact in ["hit", "depth", "normal", "position", "hit,depth,normal,position"] {
            let layout = layout(contact);
            let lines: Vec<_> = pack_hits(&layout, &hits).into_iter().map(Some).collect();
            assert_eq!(lines.len() as u64, layout.destination_lines(3), "{contact}");
            let stored = Contacts::new(&layout, &lines);
            for (place, hit) in hits.iter().enumerate() {
                assert_eq!(stored.hit(place), Some((0xFFFF_0007, stored.as_stored(hit.contact))), "{contact}");
            }
            assert!(stored.rest_is_zero(3), "{contact}");
        }
    }

    #[test]
    fn a_set_that_is_too_large_is_told_with_its_size() {
        assert_eq!(SetTooLarge::check(512, 65_536, 512), Ok(()));
        assert_eq!(SetTooLarge::check(513, 0, 512), Err(SetTooLarge::First { spheres: 513, table: 512 }));
        assert_eq!(SetTooLarge::check(0, 65_537, 512), Err(SetTooLarge::Second(65_537)));
    }
}
