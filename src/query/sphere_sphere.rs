//! Two spheres: Algorithm 1 of the paper.

use super::{Flow, Input, Rule::Finite, Shape};

const FIRST: &str = "centre of the first sphere";
const SECOND: &str = "centre of the second sphere";

pub(super) const SHAPE: Shape = Shape {
    name: "sphere-sphere",
    code: 0,
    kernel: "sphere_kernel",
    bodies: "two spheres",
    inputs: &[
        Input::new("x1", FIRST, Finite),
        Input::new("y1", FIRST, Finite),
        Input::new("z1", FIRST, Finite),
        Input::radius("r1", "radius of the first sphere"),
        Input::new("x2", SECOND, Finite),
        Input::new("y2", SECOND, Finite),
        Input::new("z2", SECOND, Finite),
        Input::radius("r2", "radius of the second sphere"),
    ],
    flows: &[Flow::Fake, Flow::Coincident, Flow::Real],
    computes: "With d the distance of the centres p1 and p2: contact if d ≤ r1 + r2; then normal n = (p1 − p2) / d, position \
               p1 + n · ((r2 − r1) − d) / 2, depth (r1 + r2) − d. If d = 0: position p1, normal (1, 0, 0), depth r1 + r2.",
    // One inside the other, overlapping, touching, far apart, coincident; and invalid pairs.
    examples: &[
        &[0.0, 0.0, 0.0, 1.0, 1.5, 0.0, 0.0, 1.0],
        &[0.0, 0.0, 0.0, 1.0, 3.0, 0.0, 0.0, 1.0],
        &[1.0, 2.0, 3.0, 0.5, 1.0, 2.0, 3.0, 0.25],
        &[0.0, 0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 1.0],
        &[0.1, 0.2, 0.3, 0.4, 0.5, -0.6, 0.7, 0.8],
        &[-3.0, 1.25, 0.75, 2.5, -1.0, 0.0, 2.0, 0.125],
        &[f32::NAN, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        &[7.0, -7.0, 7.0, 1.0, -7.0, 7.0, -7.0, 1.0],
        &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        &[0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 1.0],
        &[0.3, 0.3, 0.3, 0.1, 0.35, 0.35, 0.35, 0.1],
        &[100.0, 0.01, 0.0, 60.0, 0.0, 0.0, 0.02, 40.5],
        &[1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 1.0],
    ],
};
