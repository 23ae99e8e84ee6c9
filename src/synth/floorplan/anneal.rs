//! Simulated annealing: sites at which blocks that belong together are close.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::sites::{Kind, Site};

/// A cell that needs a site.
pub(super) struct Block {
    /// The cell.
    pub cell: u32,
    /// Its place in the list of kinds.
    pub kind: usize,
}

/// Moves that are tried for each block.
const MOVES: u64 = 20_000;

/// Sites for all blocks, the same every time: those with the least sum of weights times squared distances that was
/// found. `None` if there are more blocks than sites.
pub(super) fn sites<'k>(blocks: &[Block], kinds: &'k [Kind], weights: &[Vec<(usize, f64)>]) -> Option<Vec<&'k Site>> {
    let mut placed = Placed::in_order(blocks, kinds, weights)?;
    let moves = MOVES * blocks.len() as u64;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let per_block = placed.energy() / blocks.len().max(1) as f64;
    for step in 0..moves {
        let left = 1.0 - step as f64 / moves as f64;
        // From half of what a block costs at random, down to nothing: slowest at the end.
        let temperature = per_block * 0.5 * left.powi(8);
        let block = random.random_range(0..blocks.len());
        let site = random.random_range(0..kinds[blocks[block].kind].sites.len());
        let cost = placed.cost_of_move(block, site);
        if cost < 0.0 || random.random::<f64>() < (-cost / temperature).exp() {
            placed.go(block, site);
        }
    }
    Some((0..blocks.len()).map(|block| placed.site(block)).collect())
}

struct Placed<'a, 'k> {
    blocks: &'a [Block],
    kinds: &'k [Kind],
    weights: &'a [Vec<(usize, f64)>],
    /// The site of each block, of its kind's.
    sites: Vec<usize>,
    /// The block at each site, by kind.
    there: Vec<Vec<Option<usize>>>,
}

impl<'k> Placed<'_, 'k> {
    fn in_order<'a>(
        blocks: &'a [Block],
        kinds: &'k [Kind],
        weights: &'a [Vec<(usize, f64)>],
    ) -> Option<Placed<'a, 'k>> {
        let mut there: Vec<Vec<Option<usize>>> = kinds.iter().map(|kind| vec![None; kind.sites.len()]).collect();
        let mut sites = Vec::new();
        for (index, block) in blocks.iter().enumerate() {
            let free = there[block.kind].iter().position(Option::is_none)?;
            there[block.kind][free] = Some(index);
            sites.push(free);
        }
        Some(Placed { blocks, kinds, weights, sites, there })
    }

    fn site(&self, block: usize) -> &'k Site {
        &self.kinds[self.blocks[block].kind].sites[self.sites[block]]
    }

    /// What a block costs at `at`, without its spring to `but`.
    fn cost_at(&self, block: usize, at: [f64; 2], but: Option<usize>) -> f64 {
        let springs = self.weights[block].iter().filter(|(other, _)| Some(*other) != but);
        let cost = |&(other, weight): &(usize, f64)| {
            let there = self.site(other).at;
            weight * ((at[0] - there[0]).powi(2) + (at[1] - there[1]).powi(2))
        };
        springs.map(cost).sum()
    }

    fn energy(&self) -> f64 {
        (0..self.blocks.len()).map(|block| self.cost_at(block, self.site(block).at, None)).sum::<f64>() / 2.0
    }

    /// What it costs more if `block` goes to a site of its kind, and what stands there to its own. Their spring is as
    /// long then as before.
    fn cost_of_move(&self, block: usize, site: usize) -> f64 {
        let kind = self.blocks[block].kind;
        let (here, there) = (self.site(block).at, self.kinds[kind].sites[site].at);
        let other = self.there[kind][site];
        let change = |block, from, to, but| self.cost_at(block, to, but) - self.cost_at(block, from, but);
        change(block, here, there, other) + other.map_or(0.0, |other| change(other, there, here, Some(block)))
    }

    fn go(&mut self, block: usize, site: usize) {
        let kind = self.blocks[block].kind;
        let before = std::mem::replace(&mut self.sites[block], site);
        let other = self.there[kind][site].replace(block);
        if before != site {
            self.there[kind][before] = other;
            if let Some(other) = other {
                self.sites[other] = before;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(cell: &'static str, sites: u32, row: u32) -> Kind {
        let site = |column| Site { at: [f64::from(column), f64::from(row)], name: format!("X{column}/Y{row}") };
        Kind { cell, sites: (0..sites).map(site).collect() }
    }

    fn chain(blocks: usize) -> Vec<Vec<(usize, f64)>> {
        let beside = |block: usize| [block.checked_sub(1), Some(block + 1).filter(|next| *next < blocks)];
        (0..blocks).map(|block| beside(block).into_iter().flatten().map(|other| (other, 1.0)).collect()).collect()
    }

    #[test]
    fn a_chain_in_any_order_becomes_a_row_without_gaps() {
        // Neighbours in the chain stand in different rows, and each row has more sites than blocks.
        let kinds = [row("a", 12, 0), row("b", 9, 1)];
        let blocks: Vec<Block> = (0..8).map(|cell| Block { cell, kind: cell as usize % 2 }).collect();
        let found = sites(&blocks, &kinds, &chain(8)).expect("enough sites");
        for (block, site) in blocks.iter().zip(&found) {
            assert_eq!(site.at[1], block.kind as f64);
        }
        let steps: Vec<f64> = found.windows(2).map(|pair| (pair[1].at[0] - pair[0].at[0]).abs()).collect();
        assert!(steps.iter().all(|step| *step <= 1.0), "{steps:?}");
        let mut names: Vec<&str> = found.iter().map(|site| site.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), 8, "no site is used twice");
    }

    #[test]
    fn a_device_that_is_too_small_has_no_plan_and_a_full_one_has() {
        let blocks: Vec<Block> = (0..3).map(|cell| Block { cell, kind: 0 }).collect();
        assert!(sites(&blocks, &[row("a", 2, 0)], &chain(3)).is_none());
        assert!(sites(&blocks, &[row("a", 3, 0)], &chain(3)).is_some());
        assert!(sites(&[], &[row("a", 3, 0)], &[]).is_some_and(|sites| sites.is_empty()));
    }
}
