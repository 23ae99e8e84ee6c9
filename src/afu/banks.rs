//! Memories of places in banks side by side: place p is in bank p mod the number of banks. So the entries of a cycle,
//! which have places in a row, enter different banks and leave from different banks.

use crate::hdl::Signal;

/// The direction of a rotation.
pub(super) enum Turn {
    /// Entry j to place j + by.
    Up,
    /// Entry j + by to place j.
    Down,
}

/// Rotates a row of a power of two entries by the low bits of `by`.
pub(super) fn rotate<'g>(mut row: Vec<Signal<'g>>, by: Signal<'g>, turn: Turn) -> Vec<Signal<'g>> {
    let lanes = row.len();
    for bit in 0..lanes.ilog2() {
        let step = 1 << bit;
        let from = |lane: usize| match turn {
            Turn::Up => (lane + lanes - step) % lanes,
            Turn::Down => (lane + step) % lanes,
        };
        row = (0..lanes).map(|lane| by.bit(bit).select(row[from(lane)], row[lane])).collect();
    }
    row
}

/// The row of the first place at or after `place` that lies in this bank.
pub(super) fn row<'g>(place: Signal<'g>, bank: u32, lanes: u32) -> Signal<'g> {
    let bank_bits = lanes.ilog2();
    let row = place.drop_low(bank_bits);
    if bank + 1 == lanes {
        return row; // It is the last bank of its row whatever `place` is.
    }
    let passed = place.low(bank_bits);
    row + passed.greater_than(passed.same(u128::from(bank))).extend(row.width())
}
