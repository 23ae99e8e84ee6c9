//! Reciprocal and square root by table and a polynomial of second degree: the constants that hardware and twin share.
//!
//! The upper bits of the fraction select a piece of the argument's range. Within it, with the lower bits t,
//!
//! ```text
//! value = c0 ± (c1 − (c2 · t_high >> inner_shift)) · t >> outer_shift
//! ```
//!
//! in integers, with minus for the reciprocal and plus for the root. c0 includes half a unit in the last place, so
//! truncation rounds the value to nearest. Before that, the value is less than half a unit from the exact one. So the
//! result is less than one unit wrong, and right if the exact value is a number of the format.
//!
//! Truncated without that half, the result is a lower neighbour ([`Faithful::lower`]): the exact value is less than
//! half a unit below it, or less than one and a half units above it. The nearest number is this one or the next, and
//! the sign of a remainder at their middle decides ([`Faithful::nearest`]). So one table serves both kinds of root.
//!
//! `tests/numbers/faithful.rs` checks all of it for every significand; of fractions of more than 23 bits only when it
//! is asked to, because it takes minutes. The test here bounds the error of these.

use std::sync::OnceLock;

use super::format::FAITHFUL_FRACTION_BITS;

/// The function of a significand m in [1, 2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// 2/m, in (1, 2].
    Reciprocal,
    /// √m, or √2m if the exponent is odd: in [1, 2).
    Root,
}

/// The polynomial of one piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The value at the start of the piece, plus half a unit in the result's last place.
    pub c0: u64,
    /// The magnitude of the slope there.
    pub c1: u64,
    /// The decrease of the slope.
    pub c2: u64,
}

/// The table of a function for one fraction length, and the shifts between its terms.
#[derive(Clone, Debug)]
pub struct Faithful {
    function: Function,
    fraction_bits: u32,
    /// Upper bits of the fraction that select a piece.
    index_bits: u32,
    /// Upper bits of t that the second-degree term uses.
    high_bits: u32,
    inner_shift: u32,
    outer_shift: u32,
    pieces: Vec<Piece>,
}

/// Bits of a value below the result's last place.
const GUARD_BITS: u32 = 3;
/// Half a unit in that place, which c0 includes.
const HALF: u64 = 1 << (GUARD_BITS - 1);
/// Up to this fraction length the table holds every result.
const LONGEST_WHOLE: u32 = 6;
/// Points at which the error of a piece is sampled to choose its c0.
const SAMPLES: u64 = 512;

impl Faithful {
    /// The table for fractions of 1 to [`FAITHFUL_FRACTION_BITS`] bits; longer fractions get the table of the longest.
    pub fn of(function: Function, fraction_bits: u32) -> &'static Self {
        static TABLES: [[OnceLock<Faithful>; FAITHFUL_FRACTION_BITS as usize + 1]; 2] =
            [const { [const { OnceLock::new() }; FAITHFUL_FRACTION_BITS as usize + 1] }; 2];
        let fraction_bits = fraction_bits.min(FAITHFUL_FRACTION_BITS);
        TABLES[function as usize][fraction_bits as usize].get_or_init(|| Self::make(function, fraction_bits))
    }

    /// The function's value for a fraction, in units of the result's last place: 2^F to 2^(F+1). `odd` is 1 for the
    /// root of 2m, otherwise 0.
    #[inline]
    pub fn value(&self, odd: u32, fraction: u64) -> u64 {
        self.before_cut(odd, fraction) >> GUARD_BITS
    }

    #[inline]
    fn before_cut(&self, odd: u32, fraction: u64) -> u64 {
        let t_bits = self.t_bits();
        let piece = self.pieces[(odd << self.index_bits) as usize + (fraction >> t_bits) as usize];
        self.unrounded(piece, fraction & ((1 << t_bits) - 1))
    }

    /// The value truncated without the half: this number or the next is nearest to the exact value. At least 2^F and
    /// less than 2^(F+1).
    #[inline]
    pub fn lower(&self, odd: u32, fraction: u64) -> u64 {
        (self.before_cut(odd, fraction) - HALF) >> GUARD_BITS
    }

    /// The value rounded to nearest, from the low bits of one product, as in hardware. With the lower neighbour y, 2y +
    /// 1 is twice the middle, which is never the exact value. The remainder is small, so its sign is the top bit of the
    /// low F + 3 bits of m · (2y + 1), or follows from the low F + 5 bits of (2y + 1)².
    #[inline]
    pub fn nearest(&self, odd: u32, fraction: u64) -> u64 {
        let lower = self.lower(odd, fraction);
        let (m, twice) = (fraction | 1 << self.fraction_bits, 2 * lower + 1);
        let is_above = match self.function {
            // 2^(2F+2), which lies above these bits, minus the product.
            Function::Reciprocal => m.wrapping_mul(twice) >> (self.fraction_bits + 2) & 1 == 1,
            // 4m · 2^(F + odd) minus the square. The square is odd, so the difference borrows from the three bits
            // below.
            Function::Root => {
                let square = twice.wrapping_mul(twice) >> (self.fraction_bits + 2);
                (m << odd).wrapping_add(!square) >> 2 & 1 == 0
            }
        };
        lower + u64::from(is_above)
    }

    #[inline]
    fn unrounded(&self, piece: Piece, t: u64) -> u64 {
        let term = (self.slope(piece, t) * t) >> self.outer_shift;
        match self.function {
            Function::Reciprocal => piece.c0 - term,
            Function::Root => piece.c0 + term,
        }
    }

    #[inline]
    fn slope(&self, Piece { c1, c2, .. }: Piece, t: u64) -> u64 {
        let high = t >> (self.t_bits() - self.high_bits);
        c1 - ((c2 * high) >> self.inner_shift)
    }

    /// Bits of the fraction below those that select a piece; 0 if the table holds every result.
    pub(crate) fn t_bits(&self) -> u32 {
        self.fraction_bits - self.index_bits
    }

    /// Upper bits of t that the second-degree term uses.
    pub(crate) fn high_bits(&self) -> u32 {
        self.high_bits
    }

    /// The shift after c2 · t_high.
    pub(crate) fn inner_shift(&self) -> u32 {
        self.inner_shift
    }

    /// The shift after slope · t.
    pub(crate) fn outer_shift(&self) -> u32 {
        self.outer_shift
    }

    /// Bits of a value below the result's last place.
    pub(crate) fn guard_bits(&self) -> u32 {
        GUARD_BITS
    }

    /// Half a unit in the last place, as c0 includes it.
    pub fn half(&self) -> u64 {
        HALF
    }

    /// The pieces by the upper bits of the fraction; for the root, those of odd exponents follow the others.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    fn make(function: Function, fraction_bits: u32) -> Self {
        // In a piece of width h a parabola is wrong by h³/16 (reciprocal) or h³/360 (root): at most a quarter of a
        // unit.
        let index_bits = match function {
            _ if fraction_bits <= LONGEST_WHOLE => fraction_bits,
            // Here, what is rounded takes more than the other quarter.
            Function::Reciprocal if fraction_bits == 29 => 10,
            Function::Reciprocal => (fraction_bits - 2).div_ceil(3),
            Function::Root => (fraction_bits - 6).div_ceil(3),
        };
        let t_bits = fraction_bits - index_bits;
        let slope_bits = fraction_bits + 3 - index_bits;
        let curve_bits = fraction_bits.saturating_sub(2 * index_bits);
        // A slope and a curve have 36 bits at most, as many as a word of a block memory: 2/m is steep.
        let curve_bits = if function == Function::Reciprocal { curve_bits.min(34 - slope_bits) } else { curve_bits };
        let high_bits = t_bits.min((fraction_bits + 4).saturating_sub(2 * index_bits));
        let mut this = Self {
            function,
            fraction_bits,
            index_bits,
            high_bits,
            inner_shift: (curve_bits + index_bits + high_bits).saturating_sub(slope_bits),
            outer_shift: slope_bits - GUARD_BITS,
            pieces: Vec::new(),
        };
        let halves = if function == Function::Root { 0..2 } else { 0..1 };
        for (odd, index) in halves.flat_map(|odd| (0..1_u64 << index_bits).map(move |index| (odd, index))) {
            let piece = this.piece(odd, index, slope_bits, curve_bits);
            this.pieces.push(piece);
        }
        this
    }

    /// The exact function, up to the rounding errors of binary64.
    fn exact(&self, odd: u64, m: f64) -> f64 {
        match self.function {
            Function::Reciprocal => 2.0 / m,
            Function::Root if odd == 0 => m.sqrt(),
            Function::Root => (2.0 * m).sqrt(),
        }
    }

    fn piece(&self, odd: u64, index: u64, slope_bits: u32, curve_bits: u32) -> Piece {
        let width = power(-(self.index_bits as i32));
        let start = 1.0 + index as f64 * width;
        let f = |u: f64| self.exact(odd, start + u);
        let sign = if self.function == Function::Reciprocal { -1.0 } else { 1.0 };
        let (mut c1, mut c2) = (0, 0);
        if self.t_bits() > 0 {
            // The parabola through three Chebyshev points. The slope compensates for the rounding of the second-degree
            // term.
            let [a, b, c] = [-0.75_f64.sqrt(), 0.0, 0.75_f64.sqrt()].map(|x| 0.5 * width * (1.0 + x));
            let slope = (f(b) - f(a)) / (b - a);
            let curve = ((f(c) - f(b)) / (c - b) - slope) / (c - a);
            c2 = (-sign * curve * power(curve_bits as i32)).round() as u64;
            let lost = curve + sign * c2 as f64 * power(-(curve_bits as i32));
            let slope = slope - curve * (a + b) + lost * width;
            c1 = (sign * slope * power(slope_bits as i32)).round() as u64;
        }
        // The integer result without c0; c0 centres its error.
        let unit = power((self.fraction_bits + GUARD_BITS) as i32);
        let base = 1_u64 << 40;
        let last = (1_u64 << self.t_bits()) - 1;
        let error = |t: u64| {
            let term = self.unrounded(Piece { c0: base, c1, c2 }, t) as f64 - base as f64;
            f(t as f64 * power(-(self.fraction_bits as i32))) * unit - term
        };
        let samples = (0..=SAMPLES).map(|i| error((last * i).div_euclid(SAMPLES)));
        let (low, high) = samples.fold((f64::MAX, f64::MIN), |(low, high), e| (low.min(e), high.max(e)));
        let mut piece = Piece { c0: ((low + high) / 2.0).round() as u64 + HALF, c1, c2 };
        let [one, two] = [0, 1].map(|place| 1 << (self.fraction_bits + place + GUARD_BITS));
        // The root of the largest significand stays below 2.
        let is_last = odd == 1 && index + 1 == 1 << self.index_bits;
        while is_last && self.unrounded(piece, last) >= two {
            piece.c0 -= 1;
        }
        // The value for 1 is at least 1, and its reciprocal, 2, is approached from below: the leading bit is known.
        match self.function {
            Function::Root if (odd, index) == (0, 0) => piece.c0 = piece.c0.max(one + HALF),
            Function::Reciprocal if index == 0 => piece.c0 = piece.c0.min(two + HALF - 1),
            _ => {}
        }
        piece
    }
}

/// 2^exponent.
fn power(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest error of a value before it is cut, in units of its last place; and whether all lower neighbours have
    /// their leading one in its place. Both follow from two significands of each stretch of a piece.
    ///
    /// In a stretch the upper bits of t are the same, so the value is a line, cut to an integer. The function bends
    /// away from it by less than 2^-11 of these integers, so their distance is largest at an end. The cut takes away
    /// less than 1. binary64 is right to 2^-16.
    fn largest_error(table: &Faithful, odd: u32) -> (f64, bool) {
        let (bits, t_bits, function) = (table.fraction_bits, table.t_bits(), table.function);
        let (stretch, slack) = (1_u64 << (t_bits - table.high_bits), power(-13));
        let (mut low, mut high, mut leads) = (f64::MAX, f64::MIN, true);
        for first in (0..1_u64 << bits).step_by(stretch as usize) {
            let piece = table.pieces[(odd << table.index_bits) as usize + (first >> t_bits) as usize];
            for fraction in [first, first + stretch - 1] {
                let t = fraction & ((1 << t_bits) - 1);
                let term = (table.slope(piece, t) * t) as f64 * power(-(table.outer_shift as i32));
                let line = (piece.c0 - HALF) as f64 + if function == Function::Reciprocal { -term } else { term };
                let m = 1.0 + fraction as f64 * power(-(bits as i32));
                let away = line - table.exact(odd.into(), m) * power((bits + GUARD_BITS) as i32);
                (low, high) = (low.min(away), high.max(away));
                leads &= table.lower(odd, fraction) >> bits == 1;
            }
        }
        // A term that is cut leaves a smaller root, or a larger reciprocal.
        let (below, above) = if function == Function::Reciprocal { (0.0, 1.0) } else { (1.0, 0.0) };
        ((below - low).max(above + high) / (2 * HALF) as f64 + slack, leads)
    }

    #[test]
    fn a_longer_value_is_within_half_a_unit_before_it_is_cut() {
        let all = [(Function::Reciprocal, 0), (Function::Root, 0), (Function::Root, 1)];
        std::thread::scope(|scope| {
            for (function, odd) in all {
                scope.spawn(move || {
                    for bits in 16..=FAITHFUL_FRACTION_BITS {
                        let (error, leads) = largest_error(Faithful::of(function, bits), odd);
                        assert!(error < 0.5 && leads, "{function:?} of {bits} bits, odd {odd}: {error}");
                    }
                });
            }
        });
    }

    #[test]
    fn a_wrong_piece_is_found() {
        let mut table = Faithful::make(Function::Root, 24);
        table.pieces[17].c2 += 16;
        assert!(largest_error(&table, 0).0 > 0.5);
    }
}
