//! parry3d, the collision detection of Rust's physics engine Rapier.

use super::{Answer, Contender};
use crate::kernel::EngineError;
use crate::query::PairRecord;
use parry3d::math::{Pose, Vector};
use parry3d::query;
use parry3d::shape::Ball;

/// parry's contact of two balls, in `f32`. Its normal points out of the first body, and each body has its own point.
/// The position here is the middle of the two.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parry;

impl Contender for Parry {
    fn name(&self) -> String {
        "parry3d f32".to_owned()
    }

    fn answers(&mut self, pairs: &[PairRecord]) -> Result<Vec<Answer>, EngineError> {
        Ok(pairs.iter().map(|pair| contact(pair.values())).collect())
    }
}

fn contact([x1, y1, z1, r1, x2, y2, z2, r2]: [f32; 8]) -> Answer {
    let [first, second] = [[x1, y1, z1], [x2, y2, z2]].map(|[x, y, z]| Pose::from_translation(Vector::new(x, y, z)));
    let [ball1, ball2] = [r1, r2].map(Ball::new);
    // The only error is for shapes without contacts, and balls have them.
    let Ok(Some(contact)) = query::contact(&first, &ball1, &second, &ball2, 0.0) else { return Answer::default() };
    let wide = |v: Vector| [v.x, v.y, v.z].map(f64::from);
    let (one, other) = (wide(contact.point1), wide(contact.point2));
    Answer {
        hit: true,
        // In `f64`, because only parry's own operations should round.
        position: [0, 1, 2].map(|axis| (one[axis] + other[axis]) / 2.0),
        normal: wide(-contact.normal1),
        depth: (-contact.dist).into(),
        unsettled: false,
    }
}
