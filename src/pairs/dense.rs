//! The candidate pairs of crowded scenes, as a broad phase finds them.

use super::source::{Source, UNIT};
use crate::query::PairRecord;

/// Spheres of a scene.
const SPHERES: usize = 1000;

/// `count` candidates from one scene after another. A scene has a thousand spheres, with centres anywhere in a cube of
/// side 8 around the origin and radii from ¼ to ½. A candidate is a pair whose bounding boxes touch. The first n pairs
/// are the same for every count of at least n.
pub fn pairs(count: u64, seed: u64) -> Vec<PairRecord> {
    let mut source = Source::new(seed ^ 0x64_656E_7365);
    let mut pairs = Vec::new();
    while (pairs.len() as u64) < count {
        let mut spheres: Vec<[f32; 4]> = (0..SPHERES).map(|_| source.in_a_box()).collect();
        spheres.sort_by(|a, b| (a[0] - a[3]).total_cmp(&(b[0] - b[3])));
        for (i, first) in spheres.iter().enumerate() {
            let reach = first[0] + first[3];
            let near = spheres[i + 1..].iter().take_while(|second| second[0] - second[3] <= reach);
            let boxes_touch =
                |second: &&[f32; 4]| (1..3).all(|axis| (first[axis] - second[axis]).abs() <= first[3] + second[3]);
            pairs.extend(near.filter(boxes_touch).map(|&second| PairRecord::from_spheres(*first, second)));
        }
    }
    pairs.truncate(count as usize);
    pairs
}

impl Source {
    fn in_a_box(&mut self) -> [f32; 4] {
        // 24 random bits make an exact binary32 number from 0 to 1.
        let mut unit = || (self.bits() >> 8) as f32 / (1 << 24) as f32;
        let [x, y, z] = [(); 3].map(|()| unit() * 8.0 - 4.0);
        [x, y, z, self.positive(UNIT - 2, UNIT - 2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Reference;
    use crate::number::Format;
    use crate::query::{Fields, Flow};

    #[test]
    fn a_crowd_touches_and_misses_and_stays_the_same() {
        let pairs = pairs(20_000, 1);
        assert_eq!(pairs.len(), 20_000);
        assert_eq!(pairs[..50], super::pairs(50, 1)[..]);
        assert_ne!(pairs[..50], super::pairs(50, 2)[..]);
        let contacts = Reference::new(Format::BINARY32, Fields::ALL).run_all(&pairs);
        let of = |flow| contacts.iter().filter(|contact| contact.flow() == Some(flow)).count();
        let (real, fake) = (of(Flow::Real), of(Flow::Fake));
        assert!(real > 8_000 && fake > 5_000 && real + fake == 20_000, "{real} touch, {fake} do not");
        assert!(pairs.iter().all(|pair| pair.values().iter().all(|v| v.abs() <= 4.0)));
    }
}
