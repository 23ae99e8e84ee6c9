//! The formula in plain `f32`, as in physics engines.

use super::{Answer, Contender};
use crate::kernel::EngineError;
use crate::query::{PairRecord, Query};

/// ODE's formula in the machine's binary32, including its branches, written independently of the kernel. No input is
/// refused, and NaNs are not made canonical.
#[derive(Clone, Copy, Debug)]
pub struct Formula(pub Query);

impl Contender for Formula {
    fn name(&self) -> String {
        "formula f32".to_owned()
    }

    fn answers(&mut self, pairs: &[PairRecord]) -> Result<Vec<Answer>, EngineError> {
        let contact = match self.0 {
            Query::SphereSphere => spheres,
            Query::SpherePlane => plane,
        };
        Ok(pairs.iter().map(|pair| contact(pair.values())).collect())
    }
}

fn spheres([x1, y1, z1, r1, x2, y2, z2, r2]: [f32; 8]) -> Answer {
    let (dx, dy, dz) = (x1 - x2, y1 - y2, z1 - z2);
    let d = (dx * dx + dy * dy + dz * dz).sqrt();
    if d > r1 + r2 {
        return Answer::default();
    }
    let (position, normal, depth) = if d <= 0.0 {
        ([x1, y1, z1], [1.0, 0.0, 0.0], r1 + r2)
    } else {
        let inverse = 1.0 / d;
        let [nx, ny, nz] = [dx, dy, dz].map(|component| component * inverse);
        let k = 0.5 * (r2 - r1 - d);
        ([x1 + nx * k, y1 + ny * k, z1 + nz * k], [nx, ny, nz], r1 + r2 - d)
    };
    touching(position, normal, depth)
}

fn plane([x, y, z, r, nx, ny, nz, d]: [f32; 8]) -> Answer {
    let depth = d - (x * nx + y * ny + z * nz) + r;
    if depth >= 0.0 { touching([x - nx * r, y - ny * r, z - nz * r], [nx, ny, nz], depth) } else { Answer::default() }
}

fn touching(position: [f32; 3], normal: [f32; 3], depth: f32) -> Answer {
    let wide = |v: [f32; 3]| v.map(f64::from);
    Answer { hit: true, position: wide(position), normal: wide(normal), depth: depth.into(), unsettled: false }
}
