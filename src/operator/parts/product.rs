//! Wide products from tiles that fit a DSP block.

use crate::hdl::Signal;

/// The widest unsigned factor of one tile: multipliers of 18 × 18 bits are common to FPGA families.
const TILE: u32 = 18;

/// The full product of two factors.
///
/// Both are cut into equal digits. Tiles of digits with the same distance lie side by side without overlap, so
/// they make one row; the rows are summed in a tree.
#[track_caller]
pub fn product<'g>(a: Signal<'g>, b: Signal<'g>) -> Signal<'g> {
    total(rows(a, b, ""), a.width() + b.width())
}

/// `begin` + (a · b >> `shift`), or less that, as wide as `begin`. If `b` is wider than one tile, the row of the tiles
/// on the diagonal is added to `begin` while the others are summed. Tiles are named after `name`.
#[track_caller]
pub fn with_product<'g>(
    begin: Signal<'g>,
    subtracts: bool,
    [a, b]: [Signal<'g>; 2],
    shift: u32,
    name: &str,
) -> Signal<'g> {
    let combine = |x: Signal<'g>, y: Signal<'g>| {
        let y = y.extend(y.width().max(x.width())).low(x.width());
        if subtracts { x - y } else { x + y }
    };
    if b.width() <= TILE {
        return combine(begin, product_of(a, b, name).drop_low(shift));
    }
    let mut rows = rows(a, b, &format!("{name}_"));
    let diagonal = rows.remove(0).bits;
    let low = diagonal.low(shift);
    // What is subtracted is cut first: so ones stand below `begin`, and nothing is borrowed from it.
    let low = if subtracts { !low } else { low };
    let near = combine(begin, diagonal.drop_low(shift)).named(&format!("{name}_near"));
    let near = near.concat(low).named(&format!("{name}_near_long"));
    let Row { offset, bits } = sum_of(rows, begin.width() + shift);
    combine(near.drop_low(offset), bits).named(&format!("{name}_far")).drop_low(shift - offset)
}

/// The rows of a product, that of the diagonal first. The names of its tiles begin with `prefix`.
#[track_caller]
fn rows<'g>(a: Signal<'g>, b: Signal<'g>, prefix: &str) -> Vec<Row<'g>> {
    let [a_digit, b_digit] = [a, b].map(|factor| digit_width(factor.width()));
    let (a, b) = (digits(a), digits(b));
    let row = |offset, first| Row { offset, bits: row(&a, &b, first, prefix) };
    let mut rows = vec![row(0, [0, 0])];
    for distance in 1..a.len().max(b.len()) {
        rows.extend((distance < a.len()).then(|| row(distance as u32 * a_digit, [distance, 0])));
        rows.extend((distance < b.len()).then(|| row(distance as u32 * b_digit, [0, distance])));
    }
    rows
}

/// The full square: as the product, with each pair of mirrored tiles computed once and doubled.
#[track_caller]
pub fn square(a: Signal<'_>) -> Signal<'_> {
    let width = a.width();
    let (a, digit) = (digits(a), digit_width(width));
    let mut rows = vec![Row { offset: 0, bits: row(&a, &a, [0, 0], "") }];
    for distance in 1..a.len() {
        rows.push(Row { offset: distance as u32 * digit + 1, bits: row(&a, &a, [distance, 0], "") });
    }
    total(rows, 2 * width)
}

/// The number of low bits of a [`product`] of factors of this width, or of a [`square`], that come from one tile. They
/// are available before the rows are summed.
pub fn settled_bits(width: u32) -> u32 {
    if width > digit_width(width) { digit_width(width) } else { 0 }
}

/// The full product of two factors of any width, the second at most as wide as one tile. Tiles are named after `name`.
#[track_caller]
pub fn product_of<'g>(a: Signal<'g>, b: Signal<'g>, name: &str) -> Signal<'g> {
    let digit = digit_width(a.width());
    let tile = |(place, a): (usize, Signal<'g>)| {
        let bits = (a * b).named(&format!("{name}_tile_{place}"));
        Row { offset: place as u32 * digit, bits }
    };
    total(digits(a).into_iter().enumerate().map(tile).collect(), a.width() + b.width()).named(name)
}

/// The low `width` bits of a product of factors of any width. The bits above are not computed. Tiles are named after
/// `name`.
#[track_caller]
pub fn product_low<'g>(a: Signal<'g>, b: Signal<'g>, width: u32, name: &str) -> Signal<'g> {
    let (a, b) = (whole_digits(a), whole_digits(b));
    let places = (0..a.len()).flat_map(|i| (0..b.len()).map(move |j| (i, j)));
    let rows = places.filter_map(|(i, j)| low_tile((i, a[i]), (j, b[j]), 0, width, name)).collect();
    total(rows, width)
}

/// The same for a square: each pair of mirrored tiles is computed once and doubled.
#[track_caller]
pub fn square_low<'g>(a: Signal<'g>, width: u32, name: &str) -> Signal<'g> {
    let a = whole_digits(a);
    let places = (0..a.len()).flat_map(|i| (0..=i).map(move |j| (i, j)));
    let rows = places.filter_map(|(i, j)| low_tile((i, a[i]), (j, a[j]), u32::from(i != j), width, name)).collect();
    total(rows, width)
}

/// Digits as wide as a tile. The last one has the rest, and the low bits need few of its tiles.
fn whole_digits(value: Signal<'_>) -> Vec<Signal<'_>> {
    let width = value.width();
    (0..width).step_by(TILE as usize).map(|low| value.slice(low, TILE.min(width - low))).collect()
}

/// The product of two digits, each with its place, as far as it is below `width`, shifted left by this number of
/// places.
fn low_tile<'g>(
    (i, a): (usize, Signal<'g>),
    (j, b): (usize, Signal<'g>),
    doubled: u32,
    width: u32,
    name: &str,
) -> Option<Row<'g>> {
    let offset = (i + j) as u32 * TILE + doubled;
    let left = width.checked_sub(offset).filter(|left| *left > 0)?;
    let factor = |digit: Signal<'g>| digit.low(digit.width().min(left));
    let tile = (factor(a) * factor(b)).named(&format!("{name}_tile_{i}_{j}"));
    Some(Row { offset, bits: tile.low(tile.width().min(left)) })
}

/// A term of the sum: bits · 2^offset.
#[derive(Clone, Copy)]
struct Row<'g> {
    offset: u32,
    bits: Signal<'g>,
}

fn digit_width(width: u32) -> u32 {
    width.div_ceil(width.div_ceil(TILE).max(1))
}

/// Least significant digit first; the last one may be narrower.
fn digits(value: Signal<'_>) -> Vec<Signal<'_>> {
    let (width, digit) = (value.width(), digit_width(value.width()));
    (0..width).step_by(digit.max(1) as usize).map(|low| value.slice(low, digit.min(width - low))).collect()
}

/// The products of digits from the `first` of each factor on, side by side, with names that begin with `prefix`.
fn row<'g>(a: &[Signal<'g>], b: &[Signal<'g>], first: [usize; 2], prefix: &str) -> Signal<'g> {
    let [i, j] = first;
    let pairs = a[i..].iter().zip(&b[j..]).enumerate();
    let tiles: Vec<_> =
        pairs.map(|(k, (&a, &b))| (a * b).named(&format!("{prefix}tile_{}_{}", i + k, j + k))).collect();
    let row: Vec<_> = tiles.into_iter().rev().collect();
    Signal::join(&row).named(&format!("{prefix}tiles_{i}_{j}"))
}

/// Sum of the rows as a word of this width.
fn total<'g>(rows: Vec<Row<'g>>, width: u32) -> Signal<'g> {
    let Row { offset, bits } = sum_of(rows, width);
    bits.append_zeros(offset).extend(width)
}

/// Sum of the rows in a tree: neighbours first, and the highest ones, which leave most bits unchanged.
fn sum_of<'g>(mut rows: Vec<Row<'g>>, width: u32) -> Row<'g> {
    rows.sort_by_key(|row| row.offset);
    while rows.len() > 1 {
        let pairs = rows.rchunks(2).rev();
        rows = pairs.map(|pair| if let [a, b] = *pair { sum(a, b, width) } else { pair[0] }).collect();
    }
    rows[0]
}

/// a + b, where b's offset is not smaller than a's. The bits of `a` below `b` bypass the adder.
fn sum<'g>(a: Row<'g>, b: Row<'g>, width: u32) -> Row<'g> {
    let skipped = b.offset - a.offset;
    let end = (a.offset + a.bits.width()).max(b.offset + b.bits.width());
    // One more bit for the carry, but never more than the full product has.
    let adder = (end + 1).min(width) - b.offset;
    let upper = if skipped < a.bits.width() { Some(a.bits.drop_low(skipped)) } else { None };
    let high = match upper {
        Some(upper) => (upper.extend(adder) + b.bits.extend(adder)).named("tiles_sum"),
        None => b.bits.extend(adder),
    };
    let bits = match skipped {
        0 => high,
        _ => high.concat(a.bits.extend(a.bits.width().max(skipped)).low(skipped)),
    };
    Row { offset: a.offset, bits }
}
