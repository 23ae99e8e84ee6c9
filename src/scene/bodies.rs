//! Groups of bodies as spheres, one by one.

use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::SceneError;
use super::file::{Group, LARGEST, Scene, Shape};
use crate::pairs::octahedron;

/// A sphere of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its centre.
    pub centre: [f64; 3],
    /// Its radius, a length.
    pub radius: f64,
    /// Its mass.
    pub mass: f64,
    /// Its velocity, length / time.
    pub velocity: [f64; 3],
    /// Its angular velocity, radians / time.
    pub turning: [f64; 3],
    /// The number of its group, from 0.
    pub group: usize,
}

/// The spheres of groups, in their order.
///
/// # Errors
/// Returns an error if a file of bodies cannot be read, or has an invalid sphere.
pub fn balls(scene: &Scene, groups: &[Group]) -> Result<Vec<Ball>, SceneError> {
    let mut all = Vec::new();
    for (number, group) in groups.iter().enumerate() {
        let radius = group.radius.value;
        let pitch = 2.0 * radius + group.gap;
        let lattice = |points: Vec<[f64; 3]>| points.into_iter().map(|p| (p.map(|v| v * pitch), radius)).collect();
        let centres: Vec<([f64; 3], f64)> = match &group.shape {
            Shape::Diamond { layers } => {
                lattice(octahedron(*layers as i32 - 1).map(|point| point.map(f64::from)).collect())
            }
            Shape::Lattice { count } => lattice(grid(*count)),
            Shape::Stack { count } => lattice((0..*count).map(|i| [0.0, 0.0, i as f64]).collect()),
            Shape::Random { count, corners, seed } => {
                random(*count, *corners, *seed).into_iter().map(|centre| (centre, radius)).collect()
            }
            Shape::List { centres } => centres.iter().map(|&centre| (centre, radius)).collect(),
            Shape::File { path } => file(scene, group, path, radius)?,
        };
        all.extend(centres.into_iter().map(|(centre, radius)| Ball {
            centre: std::array::from_fn(|axis| centre[axis] + group.at[axis]),
            radius,
            mass: group.mass,
            velocity: group.velocity.as_ref().map_or([0.0; 3], |given| given.value),
            turning: group.turning.as_ref().map_or([0.0; 3], |given| given.value),
            group: number,
        }));
    }
    Ok(all)
}

/// A lattice about its centre.
fn grid([x, y, z]: [u64; 3]) -> Vec<[f64; 3]> {
    let place = |i: u64, count: u64| i as f64 - (count - 1) as f64 / 2.0;
    let points =
        (0..x).flat_map(|i| (0..y).flat_map(move |j| (0..z).map(move |k| [place(i, x), place(j, y), place(k, z)])));
    points.collect()
}

fn random(count: u64, [low, high]: [[f64; 3]; 2], seed: u64) -> Vec<[f64; 3]> {
    let mut source = Xoshiro256PlusPlus::seed_from_u64(seed);
    // 53 bits, so that every machine makes the same numbers.
    let mut unit = || (source.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    (0..count).map(|_| std::array::from_fn(|axis| low[axis] + (high[axis] - low[axis]) * unit())).collect()
}

/// The most spheres in a file.
const MOST: usize = 1_000_000;

/// A CSV of x,y,z or x,y,z,r with a header, or a PLY file's vertices (ASCII).
fn file(scene: &Scene, group: &Group, path: &Path, radius: f64) -> Result<Vec<([f64; 3], f64)>, SceneError> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|error| SceneError::Read { file: name.clone(), error })?;
    let wrong = |line: usize, why: String| SceneError::Form { file: name.clone(), line, why };
    let (columns, first, rows) =
        if text.starts_with("ply") { ply(&text, &wrong)? } else { csv_columns(&text, &wrong)? };
    let find = |key: &str| columns.iter().position(|column| column == key);
    let [Some(x), Some(y), Some(z)] = ["x", "y", "z"].map(find) else {
        return Err(wrong(1, format!("no columns x, y, z: there are {}", columns.join(", "))));
    };
    let r = find("r").or_else(|| find("radius"));
    let mut spheres = Vec::new();
    for (index, line) in text.lines().enumerate().skip(first).filter(|(_, line)| !line.trim().is_empty()).take(rows) {
        if spheres.len() == MOST {
            return Err(wrong(index + 1, format!("more than {MOST} spheres")));
        }
        let cells: Vec<&str> =
            line.split(|c: char| c == ',' || c.is_whitespace()).filter(|cell| !cell.is_empty()).collect();
        let number = |column: usize| -> Result<f64, SceneError> {
            let cell = cells.get(column).ok_or_else(|| wrong(index + 1, format!("{} is missing", columns[column])))?;
            let value: f64 =
                cell.parse().map_err(|_| wrong(index + 1, format!("{} is `{cell}`: not a number", columns[column])))?;
            if value.abs() <= LARGEST {
                return Ok(value);
            }
            Err(wrong(index + 1, format!("{} is {value}: beyond ±2^27", columns[column])))
        };
        let own = r.map(number).transpose()?.unwrap_or(radius);
        if own <= 0.0 {
            return Err(wrong(index + 1, format!("radius {own}: give one above 0")));
        }
        spheres.push(([number(x)?, number(y)?, number(z)?], own));
    }
    if spheres.is_empty() {
        let line = group.lines.first().copied().unwrap_or(1);
        let why = format!("{name} has no sphere");
        return Err(SceneError::Value { file: scene.file.clone(), line, key: "file".to_owned(), why });
    }
    Ok(spheres)
}

/// Names of columns, lines before the first row, and the maximum number of rows.
type Columns = (Vec<String>, usize, usize);

fn csv_columns(text: &str, wrong: &dyn Fn(usize, String) -> SceneError) -> Result<Columns, SceneError> {
    let header = text.lines().next().ok_or_else(|| wrong(1, "an empty file".to_owned()))?;
    Ok((header.split(',').map(|name| name.trim().to_owned()).collect(), 1, usize::MAX))
}

/// The header of an ASCII PLY whose first element are the vertices.
fn ply(text: &str, wrong: &dyn Fn(usize, String) -> SceneError) -> Result<Columns, SceneError> {
    let (mut columns, mut rows, mut of_vertices) = (Vec::new(), None, false);
    for (index, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["format", "ascii", _] => {}
            ["format", other, _] => {
                return Err(wrong(index + 1, format!("format {other}: write the points as ASCII PLY, or as CSV")));
            }
            ["element", name, count] => {
                of_vertices = name == "vertex" && rows.is_none();
                if !of_vertices && rows.is_none() {
                    return Err(wrong(
                        index + 1,
                        format!("element {name} before the vertices: put the vertices first"),
                    ));
                }
                if of_vertices {
                    rows = Some(count.parse().map_err(|_| wrong(index + 1, format!("`{count}` is no count")))?);
                }
            }
            ["property", _, name] if of_vertices => columns.push(name.to_owned()),
            ["end_header"] => {
                let rows = rows.ok_or_else(|| wrong(index + 1, "no element vertex".to_owned()))?;
                return Ok((columns, index + 1, rows));
            }
            _ => {}
        }
    }
    Err(wrong(1, "a PLY file without end_header".to_owned()))
}
