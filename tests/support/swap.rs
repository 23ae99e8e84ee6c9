//! What a position may differ by if the spheres are swapped.

use contact_afu::kernel::ulp;
use contact_afu::query::{ContactRecord, PairRecord};

/// The unit in the last place of the largest number that makes either position's component.
pub fn unit(pair: &PairRecord, axis: usize, p: f32, q: f32) -> f64 {
    let values = pair.values();
    ulp([values[axis], values[axis + 4], values[3], values[7], p, q].into_iter().map(f32::abs).fold(0.0, f32::max))
}

/// How far apart two components can be that arithmetic with 24-bit significands gives.
///
/// With u = 2^-24 and a = r2 − r1: distance d and normal n are the same from both sides but for n's sign, and so is a.
/// From each side k = ½(±a − d), so the two positions differ by (p1 − p2) − n·d, where n·d was rounded three times more
/// than p1 − p2 (difference, 1/d, product), 3u|n|d; by the rounding of each ±a − d, together 2u·½·2·max(|a|, d) halved,
/// u|n|max(|a|, d); by that of each product n·k, together the same again; and by that of each last sum.
pub fn most(pair: &PairRecord, contact: ContactRecord, axis: usize, p: f32, q: f32) -> f64 {
    let u = 2.0_f64.powi(-24);
    let [.., r1, _, _, _, r2] = pair.values().map(f64::from);
    let step = [0, 1, 2].map(|i| f64::from(pair.values()[i]) - f64::from(pair.values()[i + 4]));
    let d = step.iter().map(|v| v * v).sum::<f64>().sqrt();
    let n = f64::from(contact.normal()[axis]).abs();
    // A subnormal number was rounded before, to 24 bits.
    let last = |v: f32| 0.5 * ulp(v) + if v.abs() < f32::MIN_POSITIVE { u * f64::from(v).abs() } else { 0.0 };
    let inner = u * n * (3.0 * d + 2.0 * (r2 - r1).abs().max(d));
    // Terms of second order, and a component of the normal too small for binary32.
    let small = d.max(r1.max(r2)) * 2.0_f64.powi(-149);
    inner * (1.0 + 2.0_f64.powi(-20)) + last(p) + last(q) + small
}
