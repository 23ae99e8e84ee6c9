//! An order in which spheres that are close stand close to each other: their places along a Hilbert curve.

use super::Sphere;

/// Bits of a place along each axis.
const BITS: u32 = 16;

/// The order of the spheres along a Hilbert curve through the box around their centres: the numbers of the spheres, the
/// first one first. Invalid spheres come last. Equal places keep their order.
///
/// The curve is J. Skilling's (*Programming the Hilbert curve*, AIP Conference Proceedings 707, 2004).
pub fn hilbert_order(spheres: &[Sphere]) -> Vec<u32> {
    let valid = || spheres.iter().filter(|sphere| sphere.is_valid()).map(|sphere| sphere.values());
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for values in valid() {
        for axis in 0..3 {
            low[axis] = low[axis].min(values[axis]);
            high[axis] = high[axis].max(values[axis]);
        }
    }
    // One scale for all axes, so that cells are cubes. In binary64 no difference overflows.
    let extent = (0..3).map(|axis| f64::from(high[axis]) - f64::from(low[axis])).fold(0.0, f64::max);
    let scale = if extent > 0.0 { f64::from((1 << BITS) - 1) / extent } else { 0.0 };
    let place = |sphere: &Sphere| {
        if !sphere.is_valid() {
            return u64::MAX;
        }
        let values = sphere.values();
        along(std::array::from_fn(|axis| ((f64::from(values[axis]) - f64::from(low[axis])) * scale) as u32))
    };
    let mut order: Vec<(u64, u32)> = spheres.iter().map(place).zip(0..).collect();
    order.sort_unstable();
    order.into_iter().map(|(_, number)| number).collect()
}

/// The spheres in another order.
///
/// # Panics
/// If `order` names a sphere that does not exist.
pub fn reorder(spheres: &[Sphere], order: &[u32]) -> Vec<Sphere> {
    order.iter().map(|&number| spheres[number as usize]).collect()
}

/// The place of a cell along the curve.
fn along(mut cell: [u32; 3]) -> u64 {
    // From the largest cubes down, undo the turn that the curve makes in each.
    for bit in (1..BITS).rev() {
        let (is_set, below) = (1 << bit, (1 << bit) - 1);
        for axis in 0..3 {
            if cell[axis] & is_set != 0 {
                cell[0] ^= below;
            } else {
                let exchanged = (cell[0] ^ cell[axis]) & below;
                cell[0] ^= exchanged;
                cell[axis] ^= exchanged;
            }
        }
    }
    // What is left is a Gray code over the axes.
    cell[1] ^= cell[0];
    cell[2] ^= cell[1];
    let mut turned = 0;
    for bit in (1..BITS).rev() {
        if cell[2] & 1 << bit != 0 {
            turned ^= (1 << bit) - 1;
        }
    }
    let cell = cell.map(|axis| axis ^ turned);
    (0..BITS).rev().fold(0, |place, bit| cell.iter().fold(place, |place, axis| place << 1 | u64::from(axis >> bit & 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Neighbours along the curve are neighbours in space: it fills each cube whole, without a jump.
    #[test]
    fn the_curve_steps_from_a_cell_to_its_neighbour() {
        for side in [2_u32, 4, 8, 16] {
            let cells = (0..side.pow(3)).map(|i| [i / side / side, i / side % side, i % side]);
            let mut places: Vec<_> = cells.map(|cell| (along(cell), cell)).collect();
            places.sort_unstable();
            for (expected, (place, _)) in (0..).zip(&places) {
                assert_eq!(*place, expected);
            }
            for two in places.windows(2) {
                let step: u32 = (0..3).map(|axis| two[0].1[axis].abs_diff(two[1].1[axis])).sum();
                assert_eq!(step, 1, "{two:?}");
            }
        }
    }

    #[test]
    fn an_order_names_each_sphere_once_and_invalid_ones_last() {
        let mut spheres: Vec<_> =
            (0..100).map(|i| Sphere::new([(i * 37 % 100) as f32, (i * 11 % 7) as f32, 1e30, 1.0])).collect();
        spheres[3] = Sphere::new([f32::NAN; 4]);
        spheres[70] = Sphere::new([0.0, 0.0, 0.0, -1.0]);
        let order = hilbert_order(&spheres);
        assert_eq!(order[98..], [3, 70]);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..100).collect::<Vec<_>>());
        assert_eq!(reorder(&spheres, &order)[99].values()[3], -1.0);
        assert!(hilbert_order(&[]).is_empty());
        let far = [[f32::MAX; 4], [-f32::MAX, -f32::MAX, -f32::MAX, 0.0]].map(Sphere::new);
        assert_eq!(hilbert_order(&far).len(), 2);
    }
}
