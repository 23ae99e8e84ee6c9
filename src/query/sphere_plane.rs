//! A sphere and a plane, in the order of operations of ODE's `dCollideSpherePlane`.

use super::{Flow, Input, Rule::Finite, Rule::UnitLength, Shape};

const CENTRE: &str = "centre of the sphere";
const NORMAL: &str = "normal of the plane, of length 1";

pub(super) const SHAPE: Shape = Shape {
    name: "sphere-plane",
    code: 1,
    kernel: "plane_kernel",
    bodies: "a sphere and a plane",
    inputs: &[
        Input::new("x", CENTRE, Finite),
        Input::new("y", CENTRE, Finite),
        Input::new("z", CENTRE, Finite),
        Input::radius("r", "radius of the sphere"),
        Input::new("nx", NORMAL, UnitLength),
        Input::new("ny", NORMAL, UnitLength),
        Input::new("nz", NORMAL, UnitLength),
        Input::new("d", "distance of the plane from the origin, along its normal", Finite),
    ],
    flows: &[Flow::Fake, Flow::Real],
    computes: "The plane is all points p with n · p = d. With c the sphere's centre, depth = (d − n · c) + r: contact if \
               depth ≥ 0; then normal n, position c − n · r. That n has length 1 is not checked.",
    // In front of the plane, through it, touching it, behind it; a point; and invalid pairs.
    examples: &[
        &[0.0, 0.0, 3.0, 1.0, 0.0, 0.0, 1.0, 0.0],
        &[0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 1.0, 0.0],
        &[5.0, -7.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0],
        &[0.0, 0.0, -9.0, 1.0, 0.0, 0.0, 1.0, 0.0],
        &[0.1, 0.2, 0.3, 0.4, 0.6, -0.8, 0.0, -0.25],
        &[1.0, 2.0, 3.0, 0.5, 0.0, -1.0, 0.0, -2.0],
        &[1.0, f32::NAN, 3.0, 0.5, 0.0, -1.0, 0.0, -2.0],
        &[0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        &[1.0, 2.0, 3.0, -0.5, 1.0, 0.0, 0.0, 0.0],
        &[-4.0, 0.25, 0.5, 0.125, 0.48, 0.64, 0.6, -1.5],
    ],
};
