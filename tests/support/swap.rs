//! The bound on the difference of positions if the spheres are swapped.

use contact_afu::kernel::ulp;
use contact_afu::query::{ContactRecord, PairRecord};

/// The unit in the last place of the largest number that contributes to either position's component.
pub fn unit(pair: &PairRecord, axis: usize, p: f32, q: f32) -> f64 {
    let values = pair.values();
    ulp([values[axis], values[axis + 4], values[3], values[7], p, q].into_iter().map(f32::abs).fold(0.0, f32::max))
}

/// The maximum difference of two components computed with 24-bit significands.
///
/// Let u = 2^-24 and a = r2 − r1. From both sides the distance d is the same, and the normal n and a differ only in
/// sign. From each side k = ½(±a − d), so the exact positions differ by (p1 − p2) − n·d. Rounding adds these errors:
/// - n·d has three more roundings than p1 − p2 (difference, 1/d, product): 3u|n|d;
/// - each ±a − d is rounded, together 2u·½·2·max(|a|, d) halved: u|n|max(|a|, d);
/// - each product n·k is rounded: the same again;
/// - each last sum is rounded.
pub fn most(pair: &PairRecord, contact: ContactRecord, axis: usize, p: f32, q: f32) -> f64 {
    let u = 2.0_f64.powi(-24);
    let [.., r1, _, _, _, r2] = pair.values().map(f64::from);
    let step = [0, 1, 2].map(|i| f64::from(pair.values()[i]) - f64::from(pair.values()[i + 4]));
    let d = step.iter().map(|v| v * v).sum::<f64>().sqrt();
    let n = f64::from(contact.normal()[axis]).abs();
    // A subnormal result was rounded to 24 bits before.
    let last = |v: f32| 0.5 * ulp(v) + if v.abs() < f32::MIN_POSITIVE { u * f64::from(v).abs() } else { 0.0 };
    let inner = u * n * (3.0 * d + 2.0 * (r2 - r1).abs().max(d));
    // Second-order terms, and a component of the normal that underflows in binary32.
    let small = d.max(r1.max(r2)) * 2.0_f64.powi(-149);
    inner * (1.0 + 2.0_f64.powi(-20)) + last(p) + last(q) + small
}
