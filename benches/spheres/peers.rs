//! Other libraries that find contacts: ODE's spaces with its collider, parry3d's tree of boxes with its contacts.

use std::error::Error;

use contact_afu::ode::{BroadPhase, Collider, Ode, World};
use contact_afu::spheres::Spheres;

use super::measure::Column;

/// ODE's hash space.
pub fn hash(spheres: &Spheres) -> Result<Option<Column<'_>>, Box<dyn Error>> {
    ode("ODE's hash space", BroadPhase::Hash, spheres)
}

/// ODE's sweep-and-prune space.
pub fn sweep_and_prune(spheres: &Spheres) -> Result<Option<Column<'_>>, Box<dyn Error>> {
    ode("ODE's sweep-and-prune space", BroadPhase::SweepAndPrune, spheres)
}

/// ODE's spheres cannot be points, so there is no column of it for two sets, which are probes and points.
fn ode<'a>(name: &'static str, space: BroadPhase, spheres: &Spheres) -> Result<Option<Column<'a>>, Box<dyn Error>> {
    if spheres.second.is_some() {
        return Ok(None);
    }
    let ode = Ode::start(Collider::Own)?;
    let mut world = World::with_broad_phase(&ode, space)?;
    for sphere in &spheres.first {
        let [x, y, z, r] = sphere.values().map(f64::from);
        world.add_sphere([x, y, z], r, 1.0)?;
    }
    Ok(Some(Column::new(name, move || world.contacts().expect("ODE does not fail").len())))
}

#[cfg(not(feature = "parry"))]
pub fn parry(_: &Spheres) -> Option<Column<'_>> {
    None
}

#[cfg(feature = "parry")]
pub fn parry(spheres: &Spheres) -> Option<Column<'_>> {
    use parry3d::bounding_volume::Aabb;
    use parry3d::math::{Pose, Vector};
    use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhNode, BvhWorkspace};
    use parry3d::query;
    use parry3d::shape::Ball;

    // parry3d calls spheres apart that only just touch, as all of a diamond do. Within this distance it takes them.
    const NEAR: f32 = 1e-6;
    type Balls = Vec<(Pose, Ball)>;
    let balls = |spheres: &[contact_afu::spheres::Sphere]| -> Balls {
        let ball = |[x, y, z, r]: [f32; 4]| (Pose::from_translation(Vector::new(x, y, z)), Ball::new(r));
        spheres.iter().map(|sphere| ball(sphere.values())).collect()
    };
    let tree = |balls: &Balls| {
        let boxes: Vec<Aabb> = balls.iter().map(|(at, ball)| ball.aabb(at)).collect();
        Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
    };
    let (first, second) = (balls(&spheres.first), spheres.second.as_deref().map(balls));
    Some(Column::new("parry3d", move || {
        let of_first = tree(&first);
        let mut contacts = 0;
        let mut decide = |[i, j]: [u32; 2], others: &Balls| {
            let ((at, ball), (other_at, other)) = (&first[i as usize], &others[j as usize]);
            let contact = query::contact(at, ball, other_at, other, NEAR);
            contacts += usize::from(contact.is_ok_and(|contact| contact.is_some()));
        };
        match &second {
            None => {
                let mut workspace = BvhWorkspace::default();
                of_first.traverse_bvtt_single_tree::<false>(&mut workspace, &mut |i, j| decide([i, j], &first));
            }
            Some(others) => {
                let of_others = tree(others);
                let meets = |one: &BvhNode, other: &BvhNode| one.intersects(other);
                of_first.leaf_pairs(&of_others, meets).for_each(|(i, j)| decide([i, j], others));
            }
        }
        contacts
    }))
}
