//! Scenes without motion: one step that consists only of collision detection.

use std::collections::HashMap;
use std::time::Instant;

use super::bodies::{Ball, balls};
use super::plan::Plan;
use super::results::{SceneRun, Touching};
use super::{Detector, Part, Scene, SceneError};
use crate::config::Input;
use crate::query::{ContactRecord, PairRecord};
use crate::spheres::{Hit, Sphere, Spheres, hilbert_order, reorder};

/// A scene without motion. The question is which spheres of one set, or of two, touch.
#[derive(Clone, Debug)]
pub struct Still {
    /// All spheres, those of `queries` last.
    pub balls: Vec<Ball>,
    /// The number of bodies.
    pub bodies: usize,
    /// The pairs that could touch, as numbers of spheres.
    pub candidates: Vec<[usize; 2]>,
}

impl Still {
    /// The bodies of a scene against its queries, or against each other if there are none.
    ///
    /// # Errors
    /// Returns an error if a file of bodies cannot be read.
    pub fn of(scene: &Scene) -> Result<Self, SceneError> {
        let mut all = balls(scene, &scene.bodies)?;
        let bodies = all.len();
        all.extend(balls(scene, &scene.queries)?);
        let candidates = candidates(&all, bodies);
        Ok(Self { balls: all, bodies, candidates })
    }

    /// The pairs as records: each number rounded to binary32 once.
    pub fn pairs(&self) -> Vec<PairRecord> {
        let sphere = |number: usize| {
            let Ball { centre: [x, y, z], radius, .. } = self.balls[number];
            [x, y, z, radius].map(|v| v as f32)
        };
        self.candidates.iter().map(|&[a, b]| PairRecord::from_spheres(sphere(a), sphere(b))).collect()
    }

    /// The bodies, and the queries if there are any, each in the order of a Hilbert curve, with the numbers that they
    /// have among the balls. Without queries, both numbers of a hit are of bodies.
    pub fn sets(&self) -> (Spheres, [Vec<usize>; 2]) {
        let sorted = |from: usize, balls: &[Ball]| {
            let spheres: Vec<_> = balls
                .iter()
                .map(|ball| {
                    let [x, y, z] = ball.centre;
                    Sphere::new([x, y, z, ball.radius].map(|v| v as f32))
                })
                .collect();
            let order = hilbert_order(&spheres);
            (reorder(&spheres, &order), order.into_iter().map(|place| from + place as usize).collect::<Vec<_>>())
        };
        let (bodies, queries) = self.balls.split_at(self.bodies);
        let (first, numbers) = sorted(0, bodies);
        if queries.is_empty() {
            return (Spheres { first, second: None }, [numbers.clone(), numbers]);
        }
        let (second, others) = sorted(self.bodies, queries);
        (Spheres { first, second: Some(second) }, [numbers, others])
    }

    /// The number of all pairs, whether or not they could touch.
    pub(crate) fn all_pairs(&self) -> u64 {
        let (bodies, queries) = (self.bodies as u64, (self.balls.len() - self.bodies) as u64);
        if queries > 0 { bodies * queries } else { bodies * bodies.saturating_sub(1) / 2 }
    }
}

/// The pairs whose bounding boxes meet, by a grid of cells as wide as the widest box, in order of the first's number.
///
/// A box is a little wider than its sphere, so that the roundings to binary32 lose no pair that touches in records.
fn candidates(balls: &[Ball], bodies: usize) -> Vec<[usize; 2]> {
    let slack = |ball: &Ball| {
        let size = ball.centre.iter().fold(ball.radius, |size, v| size.max(v.abs()));
        ball.radius + 4.0 * f64::from(f32::EPSILON) * size
    };
    let reach: Vec<f64> = balls.iter().map(slack).collect();
    let cell = 2.0 * reach.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let home = |ball: &Ball| ball.centre.map(|v| (v / cell).floor() as i64);
    let against_itself = bodies == balls.len();
    let others = if against_itself { 0..bodies } else { bodies..balls.len() };
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for number in others {
        cells.entry(home(&balls[number])).or_default().push(number);
    }
    let mut pairs = Vec::new();
    let mut near = Vec::new();
    for first in 0..bodies {
        let [x, y, z] = home(&balls[first]);
        near.clear();
        for (dx, dy, dz) in (-1..=1).flat_map(|dx| (-1..=1).flat_map(move |dy| (-1..=1).map(move |dz| (dx, dy, dz)))) {
            near.extend(cells.get(&[x + dx, y + dy, z + dz]).into_iter().flatten().copied());
        }
        near.retain(|&other| {
            let sum = reach[first] + reach[other];
            let meets = (0..3).all(|axis| (balls[first].centre[axis] - balls[other].centre[axis]).abs() <= sum);
            meets && (!against_itself || other > first)
        });
        near.sort_unstable();
        pairs.extend(near.iter().map(|&other| [first, other]));
    }
    pairs
}

/// Runs a scene's single query.
///
/// # Errors
/// Returns an error if bodies cannot be read, or the detector fails.
pub fn query(scene: &Scene, plan: &Plan, detector: Detector<'_>, name: &str) -> Result<SceneRun, SceneError> {
    let query = Still::of(scene)?;
    let mut results = SceneRun::begin(scene, plan, name.to_owned())?;
    let (sent, touching, spent) = match detector {
        Detector::Pairs(engine) => {
            let pairs = query.pairs();
            let begun = Instant::now();
            let contacts =
                if plan.has(Part::Hit) { engine.contacts(&pairs).map_err(SceneError::Engine)? } else { Vec::new() };
            let spent = begun.elapsed();
            let touching = query.candidates.iter().copied().zip(contacts).filter(|(_, contact)| contact.is_contact());
            (pairs.len(), touching.collect(), spent)
        }
        Detector::Spheres(finder) => {
            let (sets, numbers) = query.sets();
            let begun = Instant::now();
            let hits = if plan.has(Part::Hit) { finder.find(&sets).map_err(SceneError::Engine)? } else { Vec::new() };
            let spent = begun.elapsed();
            let number = |set: usize, place: u32| numbers[set].get(place as usize).copied().unwrap_or_default();
            let mut touching: Vec<([usize; 2], ContactRecord)> = hits
                .into_iter()
                .map(|Hit { spheres: [first, second], contact }| ([number(0, first), number(1, second)], contact))
                .collect();
            touching.sort_by_key(|(bodies, _)| *bodies);
            (query.balls.len(), touching, spent)
        }
    };
    let summary = &mut results.summary;
    summary.step_ns = spent.as_nanos() as f64;
    summary.bodies = query.balls.len();
    summary.all_pairs = query.all_pairs();
    summary.contacts = touching.len() as u64;
    summary.sent(&results.config, &results.cost, &results.everything, sent as u64);
    if results.config.input == Input::Direct {
        summary.bytes_with_everything = results.everything.bytes(summary.all_pairs, summary.all_pairs);
    }
    results.describe(&query.balls, query.bodies);
    results.places = vec![query.balls.iter().map(|ball| ball.centre).collect()];
    if plan.has(Part::Contacts) {
        let row = |(bodies, contact): ([usize; 2], ContactRecord)| Touching {
            step: 0,
            bodies,
            words: std::array::from_fn(|word| f32::from_bits(contact.0[word])),
        };
        results.contacts = touching.into_iter().map(row).collect();
    }
    Ok(results)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::query::Fields;

    #[test]
    fn no_pair_that_touches_is_left_out() {
        let text = "scene = 1\nwant = [\"touching\"]\n[[bodies]]\nshape = \"random\"\ncount = 300\ncorners = [[-9.0, -9.0, -9.0], [9.0, 9.0, 9.0]]\n";
        for queries in [
            "",
            "[[queries]]\nshape = \"random\"\ncount = 200\nradius = 0.25\nseed = 4\ncorners = [[-9.0, -9.0, -9.0], [9.0, 9.0, 9.0]]\n",
        ] {
            let scene = Scene::parse("test", &format!("{text}{queries}")).unwrap();
            let query = Still::of(&scene).unwrap();
            let mut every = Still { candidates: Vec::new(), ..query.clone() };
            let others = if queries.is_empty() { 0..300 } else { 300..500 };
            for first in 0..300 {
                every.candidates.extend(others.clone().filter(|&other| other > first).map(|other| [first, other]));
            }
            assert_eq!(every.candidates.len() as u64, query.all_pairs());
            let reference = Plan::of(&scene).unwrap().config.profile.reference(Fields::HIT);
            let touching = |query: &Still| {
                let contacts = reference.run_all(&query.pairs());
                query
                    .candidates
                    .iter()
                    .zip(contacts)
                    .filter(|(_, c)| c.is_contact())
                    .map(|(pair, _)| *pair)
                    .collect::<Vec<_>>()
            };
            let found = touching(&query);
            assert_eq!(found, touching(&every));
            assert!(!found.is_empty() && query.candidates.len() < every.candidates.len() / 4);
        }
    }
}
