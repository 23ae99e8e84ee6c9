//! The scenes: the paper's diamond, spheres resting on each other in pairs, and a stack.

use contact_afu::ode::{Diamond, Error, Ode, Sphere, Surface, Touch, World};

pub type Point = [f64; 3];

/// A world and its forces.
pub struct Scene {
    pub world: World,
    /// The constant force on each sphere.
    forces: Vec<Point>,
    /// The force with which spheres 2i and 2i + 1 attract each other.
    attraction: f64,
}

/// Builds a scene, whichever collider ODE uses.
pub type Build = fn(&Ode) -> Result<Scene, Error>;

const TIME_STEP: f64 = 0.01;

impl Scene {
    fn new(ode: &Ode) -> Result<Self, Error> {
        Ok(Self { world: World::new(ode)?, forces: Vec::new(), attraction: 0.0 })
    }

    fn sphere(&mut self, centre: Point, radius: f64, density: f64, force: Point) -> Result<(), Error> {
        self.world.add_sphere(centre, radius, density)?;
        self.forces.push(force);
        Ok(())
    }

    pub fn advance(&mut self, touches: &[Touch]) -> Result<(), Error> {
        for (sphere, force) in self.world.spheres().zip(&self.forces) {
            self.world.add_force(sphere, *force)?;
        }
        for (spheres, apart, distance) in self.drawn() {
            for (sphere, share) in spheres.into_iter().zip([-1.0, 1.0]) {
                self.world.add_force(sphere, apart.map(|v| share * self.attraction / distance * v))?;
            }
        }
        for touch in touches {
            self.world.join(touch, &Surface::SMOOTH)?;
        }
        self.world.step(TIME_STEP)
    }

    /// The potential energy of the forces.
    pub fn potential(&self) -> f64 {
        let places = self.world.spheres().map(|sphere| self.world.position(sphere));
        let done: f64 = places.zip(&self.forces).map(|(place, &force)| dot(place, force)).sum();
        self.drawn().iter().map(|(.., distance)| self.attraction * distance).sum::<f64>() - done
    }

    /// Pairs of spheres that attract each other, with the vector from the second to the first and its length.
    fn drawn(&self) -> Vec<([Sphere; 2], Point, f64)> {
        let spheres: Vec<Sphere> = self.world.spheres().filter(|_| self.attraction > 0.0).collect();
        let pairs = spheres.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        let drawn = pairs.map(|pair| {
            let [p1, p2] = pair.map(|sphere| self.world.position(sphere));
            let apart = [0, 1, 2].map(|axis| p1[axis] - p2[axis]);
            (pair, apart, dot(apart, apart).sqrt())
        });
        drawn.collect()
    }
}

pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The paper's diamond, as [`Diamond`] moves it: each sphere is pulled towards the initial centre.
fn diamond(ode: &Ode, layers: u32, gap: f64) -> Result<Scene, Error> {
    let paper = Diamond::new(layers, gap);
    assert_eq!((paper.force, paper.time_step, paper.iterations), (1.0, TIME_STEP, 20));
    let mut scene = Scene::new(ode)?;
    for centre in paper.build(ode)?.positions() {
        let distance = centre.iter().map(|v| v * v).sum::<f64>().sqrt();
        let force = if distance > 0.0 { centre.map(|v| -v / distance) } else { [0.0; 3] };
        scene.sphere(centre, paper.radius, paper.density, force)?;
    }
    Ok(scene)
}

pub fn small_diamond(ode: &Ode) -> Result<Scene, Error> {
    diamond(ode, 3, 0.0)
}

pub fn falling_diamond(ode: &Ode) -> Result<Scene, Error> {
    diamond(ode, 3, 0.05)
}

pub fn paper_s_diamond(ode: &Ode) -> Result<Scene, Error> {
    diamond(ode, 10, 0.0)
}

/// Multiples of the golden ratio modulo 1, which no short binary fraction represents.
fn spread(i: usize) -> f64 {
    (i as f64 * 0.618_033_988_749_894_9).fract()
}

/// Twenty-seven pairs of spheres that touch as exactly as `f64` allows, in as many directions, sizes and places.
fn pairs(ode: &Ode, attraction: f64) -> Result<Scene, Error> {
    let mut scene = Scene::new(ode)?;
    for i in 0..27 {
        let cell = [i / 9, i / 3 % 3, i % 3].map(|v| v as f64 * 5.0 - 4.9);
        let of = |k: usize| spread(7 * i + k + 1);
        let (up, turn) = (2.0 * of(0) - 1.0, std::f64::consts::TAU * of(1));
        let flat = (1.0 - up * up).sqrt();
        let direction = [flat * turn.cos(), flat * turn.sin(), up];
        let [r1, r2] = [of(2), of(3)].map(|v| 0.2 + 0.8 * v);
        let [p1, p2] = [r1, -r2].map(|far| [0, 1, 2].map(|axis| cell[axis] + far * direction[axis]));
        scene.sphere(p1, r1, 1.0, [0.0; 3])?;
        scene.sphere(p2, r2, 1.0, [0.0; 3])?;
    }
    Ok(Scene { attraction, ..scene })
}

/// Tangent spheres without forces.
pub fn resting(ode: &Ode) -> Result<Scene, Error> {
    pairs(ode, 0.0)
}

/// Tangent spheres that attract each other.
pub fn pressed(ode: &Ode) -> Result<Scene, Error> {
    pairs(ode, 0.1)
}

/// Four spheres in the hollows of nine, and one on top, each with its weight. The nine are so heavy that they do not
/// move.
pub fn stack(ode: &Ode) -> Result<Scene, Error> {
    const RADIUS: f64 = 0.5;
    let mut scene = Scene::new(ode)?;
    let height = std::f64::consts::FRAC_1_SQRT_2;
    for layer in 0..3 {
        let side = 3 - layer;
        for i in 0..side * side {
            let place = |k: usize| k as f64 - (side - 1) as f64 / 2.0 + 1.0 / 3.0;
            let centre = [place(i / side), place(i % side), layer as f64 * height];
            let (density, weight) = if layer == 0 { (1e8, 0.0) } else { (1.0, 1.0) };
            scene.sphere(centre, RADIUS, density, [0.0, 0.0, -weight])?;
        }
    }
    Ok(scene)
}
