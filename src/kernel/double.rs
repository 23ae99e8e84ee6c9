//! The same formula in binary64 over many pairs at once: what software would do for more accuracy than binary32.
//!
//! Written like [`batch`](super::batch), without `zip` and `map` once per pair, for the same reason.
//!
//! For comparison only: it decides by the rounded root, its input and output are `f64`, and no hardware is compared
//! with it.

use crate::query::PairRecord;

/// Pairs per block.
const LANES: usize = 32;

/// Numbers by column: x y z r of both spheres, or position, normal, depth and 1 for a contact.
#[derive(Clone, Debug)]
#[repr(align(64))]
struct Block([[f64; LANES]; 8]);

/// Pairs in binary64 as a structure of arrays, with room for their contacts.
#[derive(Clone, Debug)]
pub struct Doubles {
    pairs: Vec<Block>,
    contacts: Vec<Block>,
    count: usize,
}

impl Doubles {
    /// These pairs, converted without rounding.
    pub fn from_pairs(pairs: &[PairRecord]) -> Self {
        let empty = vec![Block([[0.0; LANES]; 8]); pairs.len().div_ceil(LANES)];
        let mut doubles = Self { contacts: empty.clone(), pairs: empty, count: pairs.len() };
        for (i, pair) in pairs.iter().enumerate() {
            for (column, value) in doubles.pairs[i / LANES].0.iter_mut().zip(pair.values()) {
                column[i % LANES] = value.into();
            }
        }
        doubles
    }

    /// Computes all contacts with the widest SIMD instructions of this processor, and returns their name.
    pub fn run(&mut self) -> &'static str {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq") {
                // SAFETY: the processor was found to have AVX-512.
                unsafe { avx512(&self.pairs, &mut self.contacts) };
                return "AVX-512";
            }
            if is_x86_feature_detected!("avx2") {
                // SAFETY: the processor was found to have AVX2.
                unsafe { avx2(&self.pairs, &mut self.contacts) };
                return "AVX2";
            }
        }
        blocks(&self.pairs, &mut self.contacts);
        "portable"
    }

    /// The contacts: position, normal and depth, or `None` if the spheres do not touch.
    pub fn contacts(&self) -> impl Iterator<Item = Option<[f64; 7]>> + '_ {
        (0..self.count).map(|i| {
            let [x, y, z, nx, ny, nz, depth, hit] =
                self.contacts[i / LANES].0.each_ref().map(|column| column[i % LANES]);
            (hit > 0.0).then_some([x, y, z, nx, ny, nz, depth])
        })
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2(pairs: &[Block], contacts: &mut [Block]) {
    blocks(pairs, contacts);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq")]
fn avx512(pairs: &[Block], contacts: &mut [Block]) {
    blocks(pairs, contacts);
}

#[inline(always)]
fn blocks(pairs: &[Block], contacts: &mut [Block]) {
    for (pairs, contacts) in pairs.iter().zip(contacts) {
        for lane in 0..LANES {
            let contact = contact(std::array::from_fn(|word| pairs.0[word][lane]));
            for (word, column) in contacts.0.iter_mut().enumerate() {
                column[lane] = contact[word];
            }
        }
    }
}

#[inline(always)]
fn contact([x1, y1, z1, r1, x2, y2, z2, r2]: [f64; 8]) -> [f64; 8] {
    let (dx, dy, dz) = (x1 - x2, y1 - y2, z1 - z2);
    let d = ((dx * dx + dy * dy) + dz * dz).sqrt();
    let s = r1 + r2;
    let (hit, coincident) = (d <= s, d <= 0.0);
    let inverse = 1.0 / d;
    let k = 0.5 * ((r2 - r1) - d);
    let select = |normal: f64, if_coincident: f64| if coincident { if_coincident } else { normal };
    let n = [select(dx * inverse, 1.0), select(dy * inverse, 0.0), select(dz * inverse, 0.0)];
    let k = select(k, 0.0);
    let given = |value: f64| if hit { value } else { 0.0 };
    [
        given(x1 + n[0] * k),
        given(y1 + n[1] * k),
        given(z1 + n[2] * k),
        given(n[0]),
        given(n[1]),
        given(n[2]),
        given(s - d),
        given(1.0),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Truth;

    #[test]
    fn contacts_are_the_true_ones_to_binary64() {
        let sphere = |i: u32| [i as f32 * 0.3, i as f32 * 0.1, -0.7, 0.5 + i as f32 * 0.01];
        let pairs: Vec<_> = (0..100).map(|i| PairRecord::from_spheres(sphere(i % 9), sphere(i % 7))).collect();
        let mut doubles = Doubles::from_pairs(&pairs);
        assert!(!doubles.run().is_empty());
        let mut hits = 0;
        for (pair, found) in pairs.iter().zip(doubles.contacts()) {
            let truth = Truth::of(pair);
            assert_eq!(found.is_some(), truth.is_contact(), "{pair:?}");
            let Some(found) = found else { continue };
            hits += 1;
            let depth = truth.depth().expect("a contact").to_f64();
            let normal = truth.normal().expect("a contact").map(|n| n.to_f64());
            assert!((found[6] - depth).abs() < 1e-14, "{found:?}");
            assert!(found[3..6].iter().zip(normal).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?}");
        }
        assert!(hits > 50 && hits < 100, "{hits}");
        assert_eq!(doubles.contacts().count(), pairs.len());
    }
}
