//! How directly data flow between blocks.
//!
//! Every wire is a spring, and every cell that is no block rests where its springs balance. Such a cell can be taken
//! out if its springs are replaced by springs between its neighbours, whose stiffness is the product of the two over
//! the sum of all. What remains are springs between blocks. A chain of n wires has an n-th of the stiffness of one, as
//! it may be n times as long at the same clock.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::Block;

/// A wire with more users than this says nothing about where they should be.
const MOST_USERS: usize = 64;
/// A spring that would be weaker than this is left out: without it, many cells would have springs to all others.
const WEAKEST: f64 = 1e-3;

/// A wire between cells.
#[derive(Default)]
pub(super) struct Wire {
    pub driver: Option<u32>,
    pub users: Vec<u32>,
}

/// The stiffness of the springs between blocks: for each one a list of others, by their places in `blocks`.
pub(super) fn weights(cells: usize, wires: &[Wire], blocks: &[Block]) -> Vec<Vec<(usize, f64)>> {
    let mut springs = Springs { of: vec![BTreeMap::new(); cells] };
    for wire in wires {
        let Some(driver) = wire.driver else { continue };
        let mut users = wire.users.clone();
        users.sort_unstable();
        users.dedup();
        if users.len() > MOST_USERS {
            continue;
        }
        // A wire to many pulls more in all, and less at each.
        let stiffness = 1.0 / (users.len() as f64).sqrt();
        for user in users.into_iter().filter(|user| *user != driver) {
            springs.join(driver, user, stiffness);
        }
    }
    let mut place = vec![None; cells];
    for (index, block) in blocks.iter().enumerate() {
        place[block.cell as usize] = Some(index);
    }
    springs.remove_all_but(|cell| place[cell as usize].is_some());
    let of_block = |block: &Block| {
        let springs = springs.of[block.cell as usize].iter();
        springs.filter_map(|(other, stiffness)| Some((place[*other as usize]?, *stiffness))).collect()
    };
    blocks.iter().map(of_block).collect()
}

struct Springs {
    /// For each cell the cells it has a spring to, with the stiffness. Ordered, so that sums are the same every time.
    of: Vec<BTreeMap<u32, f64>>,
}

impl Springs {
    fn join(&mut self, a: u32, b: u32, stiffness: f64) {
        *self.of[a as usize].entry(b).or_default() += stiffness;
        *self.of[b as usize].entry(a).or_default() += stiffness;
    }

    /// Removes all cells but these, those with the fewest springs first.
    fn remove_all_but(&mut self, stays: impl Fn(u32) -> bool) {
        let goes = (0..self.of.len() as u32).filter(|cell| !stays(*cell));
        let mut queue: BinaryHeap<_> = goes.map(|cell| Reverse((self.of[cell as usize].len(), cell))).collect();
        while let Some(Reverse((springs, cell))) = queue.pop() {
            let now = self.of[cell as usize].len();
            if now == springs {
                self.remove(cell);
            } else {
                queue.push(Reverse((now, cell)));
            }
        }
    }

    fn remove(&mut self, cell: u32) {
        let springs: Vec<(u32, f64)> = std::mem::take(&mut self.of[cell as usize]).into_iter().collect();
        let sum: f64 = springs.iter().map(|(_, stiffness)| stiffness).sum();
        for (index, &(a, of_a)) in springs.iter().enumerate() {
            self.of[a as usize].remove(&cell);
            for &(b, of_b) in &springs[index + 1..] {
                let stiffness = of_a * of_b / sum;
                if stiffness >= WEAKEST || self.of[a as usize].contains_key(&b) {
                    self.join(a, b, stiffness);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(cells: u32, wires: &[(u32, &[u32])], blocks: [u32; 2]) -> f64 {
        let wires: Vec<_> =
            wires.iter().map(|(driver, users)| Wire { driver: Some(*driver), users: users.to_vec() }).collect();
        let blocks = blocks.map(|cell| Block { cell, kind: 0 });
        weights(cells as usize, &wires, &blocks)[0].iter().map(|(_, stiffness)| stiffness).sum()
    }

    #[test]
    fn a_chain_is_as_weak_as_it_is_long() {
        assert_eq!(between(2, &[(0, &[1])], [0, 1]), 1.0);
        assert_eq!(between(3, &[(0, &[2]), (2, &[1])], [0, 1]), 0.5);
        let chain = between(5, &[(0, &[2]), (2, &[3]), (3, &[4]), (4, &[1])], [0, 1]);
        assert!((chain - 0.25).abs() < 1e-12, "{chain}");
    }

    #[test]
    fn ways_side_by_side_add_up_and_dead_ends_do_not_matter() {
        assert_eq!(between(4, &[(0, &[2]), (0, &[3]), (2, &[1]), (3, &[1])], [0, 1]), 1.0);
        assert_eq!(between(4, &[(0, &[2]), (2, &[1]), (2, &[3])], [0, 1]), 0.5);
        assert_eq!(between(3, &[(0, &[2])], [0, 1]), 0.0);
    }
}
