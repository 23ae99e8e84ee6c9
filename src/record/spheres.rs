//! Spheres in lines, four each: a set begins at a row of 16, which is four lines.

use super::pack::Line;
use crate::spheres::{ROW, Sphere};

/// Words of a sphere.
const WORDS: usize = 4;
/// Spheres in a line.
const PER_LINE: usize = 16 / WORDS;

/// The lines of a set. The padding of its last row is zero.
pub(crate) fn pack_spheres(spheres: &[Sphere]) -> Vec<Line> {
    let mut lines = vec![[0; 16]; spheres.len().div_ceil(ROW) * ROW / PER_LINE];
    for (place, sphere) in spheres.iter().enumerate() {
        let first = place % PER_LINE * WORDS;
        lines[place / PER_LINE][first..first + WORDS].copy_from_slice(&sphere.0);
    }
    lines
}

/// The lines of hits, each the number of the first sphere below that of the second, 16 bits each. The padding of the
/// last line is zero.
pub(crate) fn pack_numbers(hits: &[[u32; 2]]) -> Vec<Line> {
    let line = |hits: &[[u32; 2]]| {
        let mut line: Line = [0; 16];
        line.iter_mut().zip(hits).for_each(|(word, [first, second])| *word = second << 16 | first);
        line
    };
    hits.chunks(16).map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_ends_with_a_row() {
        for (spheres, lines) in [(0, 0), (1, 4), (16, 4), (17, 8)] {
            let set: Vec<_> = (0..spheres).map(|place| Sphere([place, 1, 2, 3])).collect();
            let packed = pack_spheres(&set);
            assert_eq!(packed.len(), lines);
            let words: Vec<u32> = packed.concat();
            assert!(set.iter().zip(words.chunks(4)).all(|(sphere, words)| sphere.0 == words));
            assert!(words[4 * set.len()..].iter().all(|word| *word == 0));
        }
    }

    #[test]
    fn a_hit_is_two_numbers() {
        let lines = pack_numbers(&[[7, 65_535]; 17]);
        assert_eq!((lines.len(), lines[0][15], lines[1][0], lines[1][1]), (2, 0xFFFF_0007, 0xFFFF_0007, 0));
    }
}
