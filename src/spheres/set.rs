//! The sets of spheres that have names.

use std::fmt;
use std::str::FromStr;

use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::Sphere;
use crate::pairs::octahedron;

/// The most layers of a diamond: 1.3 million spheres.
const LAYERS: u32 = 100;
/// The most spheres of another set.
const COUNT: u32 = 10_000_000;
/// The largest part of space that a gas may fill, in thousandths.
const FILL: u32 = 740;

/// One set of spheres that may touch one another, or two sets of which each sphere of one may touch those of the other.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Spheres {
    /// The first set.
    pub first: Vec<Sphere>,
    /// The second set; `None` if the first is compared with itself.
    pub second: Option<Vec<Sphere>>,
}

impl Spheres {
    /// The number of spheres of both sets.
    pub fn count(&self) -> usize {
        self.first.len() + self.second.as_ref().map_or(0, Vec::len)
    }
}

/// A set of spheres made from a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SphereSet {
    /// The paper's diamond with this number of layers: spheres of radius ½ on the integer points of an octahedron.
    Diamond(u32),
    /// This number of spheres of radius ½ at random in a cube, of which they would fill this many thousandths if they
    /// did not overlap.
    Gas(u32, u32),
    /// This number of spheres of radius 0.01 to 0.1, small ones more often, against so many points, all at random in a
    /// cube of side 1. The points are the first set.
    Probes(u32, u32),
}

/// A text that names no set of spheres.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SphereSetError {
    /// The kind is unknown.
    #[error("unknown set of spheres `{0}`: use diamond:H, gas:N:FILL or probes:Q:M")]
    Unknown(String),
    /// A number is missing, no number, or out of range.
    #[error("set of spheres `{set}`: expected {field} from {least} to {most}, found `{found}`")]
    Number {
        /// The whole name.
        set: String,
        /// The number's name.
        field: &'static str,
        /// The smallest value.
        least: String,
        /// The largest value.
        most: String,
        /// The given text.
        found: String,
    },
}

impl SphereSet {
    /// The spheres, the same on every machine. `seed` matters to all but the diamond.
    pub fn spheres(self, seed: u64) -> Spheres {
        let mut source = Xoshiro256PlusPlus::seed_from_u64(seed ^ 0x7370_6865_7265_7300);
        // 24 random bits make an exact binary32 number from 0 to 1.
        let mut unit = || (source.next_u32() >> 8) as f32 / (1 << 24) as f32;
        match self {
            Self::Diamond(layers) => {
                let sphere = |[x, y, z]: [i32; 3]| Sphere::new([x as f32, y as f32, z as f32, 0.5]);
                Spheres { first: octahedron(layers as i32 - 1).map(sphere).collect(), second: None }
            }
            Self::Gas(count, fill) => {
                // A sphere of radius ½ has the volume π/6.
                let side = cube_root(f64::from(count) * std::f64::consts::PI / 6.0 / (f64::from(fill) / 1000.0)) as f32;
                let mut sphere = |_| Sphere::new([unit() * side, unit() * side, unit() * side, 0.5]);
                Spheres { first: (0..count).map(&mut sphere).collect(), second: None }
            }
            Self::Probes(probes, points) => {
                let mut point = |radius: f32| Sphere::new([unit(), unit(), unit(), radius]);
                let first = (0..points).map(|_| point(0.0)).collect();
                let mut probe = |_| {
                    let small = unit();
                    Sphere::new([unit(), unit(), unit(), 0.01 + 0.09 * (small * small * small)])
                };
                Spheres { first, second: Some((0..probes).map(&mut probe).collect()) }
            }
        }
    }
}

/// The cube root by Newton's method, whose operations round alike on every machine.
fn cube_root(value: f64) -> f64 {
    let mut root = value.max(1.0);
    for _ in 0..200 {
        root -= (root - value / (root * root)) / 3.0;
    }
    root
}

impl fmt::Display for SphereSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diamond(layers) => write!(f, "diamond:{layers}"),
            Self::Gas(count, fill) => write!(f, "gas:{count}:{}", f64::from(*fill) / 1000.0),
            Self::Probes(probes, points) => write!(f, "probes:{probes}:{points}"),
        }
    }
}

impl FromStr for SphereSet {
    type Err = SphereSetError;

    fn from_str(text: &str) -> Result<Self, SphereSetError> {
        let parts: Vec<&str> = text.split(':').collect();
        let number = |part: &str, field, least: u32, most: u32| {
            let value = part.bytes().all(|byte| byte.is_ascii_digit()).then(|| part.parse().ok()).flatten();
            value.filter(|value| (least..=most).contains(value)).ok_or_else(|| SphereSetError::Number {
                set: text.to_owned(),
                field,
                least: least.to_string(),
                most: most.to_string(),
                found: part.to_owned(),
            })
        };
        match parts.as_slice() {
            ["diamond", layers] => Ok(Self::Diamond(number(layers, "a number of layers", 1, LAYERS)?)),
            ["gas", count, fill] => {
                let count = number(count, "a number of spheres", 0, COUNT)?;
                let thousandths = fill.parse::<f64>().ok().map(|fill| (fill * 1000.0).round());
                let fits = |fill: &f64| (1.0..=f64::from(FILL)).contains(fill);
                let fill = thousandths.filter(fits).ok_or_else(|| SphereSetError::Number {
                    set: text.to_owned(),
                    field: "a filled part",
                    least: "0.001".to_owned(),
                    most: (f64::from(FILL) / 1000.0).to_string(),
                    found: (*fill).to_owned(),
                })?;
                Ok(Self::Gas(count, fill as u32))
            }
            ["probes", probes, points] => Ok(Self::Probes(
                number(probes, "a number of probes", 0, COUNT)?,
                number(points, "a number of points", 0, COUNT)?,
            )),
            _ => Err(SphereSetError::Unknown(text.to_owned())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back_and_others_are_refused() {
        for text in ["diamond:1", "diamond:30", "gas:4096:0.1", "gas:0:0.001", "probes:4096:10000"] {
            assert_eq!(text.parse::<SphereSet>().expect(text).to_string(), text);
        }
        for (text, error) in [
            ("cube:3", "unknown set of spheres `cube:3`: use diamond:H, gas:N:FILL or probes:Q:M"),
            ("gas:5", "unknown set of spheres `gas:5`: use diamond:H, gas:N:FILL or probes:Q:M"),
            ("diamond:0", "set of spheres `diamond:0`: expected a number of layers from 1 to 100, found `0`"),
            ("diamond:+1", "set of spheres `diamond:+1`: expected a number of layers from 1 to 100, found `+1`"),
            ("gas:5:nan", "set of spheres `gas:5:nan`: expected a filled part from 0.001 to 0.74, found `nan`"),
            ("gas:5:0.9", "set of spheres `gas:5:0.9`: expected a filled part from 0.001 to 0.74, found `0.9`"),
            ("probes:x:1", "set of spheres `probes:x:1`: expected a number of probes from 0 to 10000000, found `x`"),
        ] {
            assert_eq!(text.parse::<SphereSet>().expect_err(text).to_string(), error);
        }
    }

    #[test]
    fn sets_have_their_sizes_and_stay_the_same() {
        let diamond = SphereSet::Diamond(10).spheres(1);
        assert_eq!((diamond.first.len(), diamond.second), (1159, None));
        let gas = SphereSet::Gas(1000, 100).spheres(1).first;
        let side = gas.iter().flat_map(|sphere| sphere.values()).fold(0.0, f32::max);
        assert!(gas.len() == 1000 && (17.0..17.4).contains(&side), "{side}");
        assert_eq!(gas, SphereSet::Gas(1000, 100).spheres(1).first);
        assert_ne!(gas, SphereSet::Gas(1000, 100).spheres(2).first);
        let probes = SphereSet::Probes(50, 20).spheres(1);
        assert_eq!((probes.first.len(), probes.second.as_ref().map(Vec::len)), (20, Some(50)));
        assert!(probes.first.iter().all(|point| point.values()[3] == 0.0));
        for value in [1e-9, 1.0, 8.0, 1e9] {
            assert!((cube_root(value).powi(3) / value - 1.0).abs() < 1e-14, "{value}");
        }
    }
}
