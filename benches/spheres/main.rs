//! What a step costs in software, from the spheres to all of their contacts: `cargo bench --features ode,parry --bench
//! spheres`.
//!
//! The search of this crate (rows of boxes) beside a SIMD cell list, ODE's spaces with `dCollide`, and parry3d's broad
//! phase with its contacts. One thread; the median of several passes, which take turns; ns per sphere. Each pass begins
//! with the spheres in memory, in the order of a Hilbert curve, and finds every contact. Sorting along the curve
//! is a column of its own. Prints the table of docs/spheres.md. A set moved off the origin by 1000 of its units has
//! `+1000`.

mod cells;
mod peers;

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use cells::Cells;
use contact_afu::config::Profile;
use contact_afu::kernel::{Engine, Fast};
use contact_afu::query::Fields;
use contact_afu::spheres::{Search, Sphere, SphereSet, Spheres, hilbert_order, reorder};

const SCENES: [(&str, f32); 9] = [
    ("diamond:10", 0.0),
    ("diamond:30", 0.0),
    ("diamond:30", 1000.0),
    ("gas:4096:0.1", 0.0),
    ("gas:4096:0.1", 1000.0),
    ("gas:32768:0.3", 0.0),
    ("gas:32768:0.3", 1000.0),
    ("probes:4096:10000", 0.0),
    ("probes:4096:10000", 1000.0),
];
/// Time for the passes of a column.
const SECONDS: f64 = 0.5;

/// Contacts found, and the time of each pass in ns per sphere.
struct Column<'a> {
    name: &'static str,
    pass: Box<dyn FnMut() -> usize + 'a>,
    contacts: usize,
    times: Vec<f64>,
}

impl<'a> Column<'a> {
    fn new(name: &'static str, pass: impl FnMut() -> usize + 'a) -> Self {
        Self { name, pass: Box::new(pass), contacts: 0, times: Vec::new() }
    }

    fn run(&mut self, spheres: usize) -> f64 {
        let begin = Instant::now();
        self.contacts = black_box((self.pass)());
        let seconds = begin.elapsed().as_secs_f64();
        self.times.push(seconds * 1e9 / spheres as f64);
        seconds
    }

    fn median(&self) -> f64 {
        let mut times = self.times.clone();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    }
}

fn values(spheres: &[Sphere]) -> Vec<[f32; 4]> {
    spheres.iter().map(|sphere| sphere.values()).collect()
}

fn scene(set: &str, by: f32) -> Result<Spheres, Box<dyn Error>> {
    let Spheres { first, second } = set.parse::<SphereSet>()?.spheres(1);
    let moved = |spheres: Vec<Sphere>| {
        let moved: Vec<_> = spheres
            .into_iter()
            .map(|sphere| {
                let [x, y, z, r] = sphere.values();
                Sphere::new([x + by, y + by, z + by, r])
            })
            .collect();
        reorder(&moved, &hilbert_order(&moved))
    };
    Ok(Spheres { first: moved(first), second: second.map(moved) })
}

fn main() -> Result<(), Box<dyn Error>> {
    // `cargo bench` passes options of its own; `cargo test` runs this without time to spare.
    if !std::env::args().any(|argument| argument == "--bench") {
        return Ok(());
    }
    let search = Search::new(Profile::WIDE.arithmetic(), 24)?;
    let mut heading = false;
    for (set, by) in SCENES {
        let spheres = scene(set, by)?;
        let Spheres { first, second } = &spheres;
        let count = first.len() + second.as_ref().map_or(0, Vec::len);
        let (own, others) = (values(first), second.as_deref().map(values));
        let largest = |spheres: &[[f32; 4]]| spheres.iter().map(|sphere| sphere[3]).fold(0.0, f32::max);
        let reach = largest(&own) + others.as_deref().map_or(largest(&own), largest);
        let cells = |found: &mut Vec<[u32; 2]>| {
            let cells = Cells::new(&own, reach);
            match &others {
                None => cells.pairs(found),
                Some(others) => cells.pairs_with(others, found),
            }
        };
        let mut numbers = Vec::new();
        let mut columns = vec![
            Column::new("sorting", || {
                black_box(hilbert_order(black_box(first)));
                second.iter().for_each(|second| drop(black_box(hilbert_order(second))));
                0
            }),
            Column::new("search, numbers", || {
                let found = search.find(&mut Fast::new(Fields::HIT), first, second.as_deref());
                found.expect("software does not fail").hits.len()
            }),
            Column::new("search, contacts", || {
                let found = search.find(&mut Fast::new(Fields::ALL), first, second.as_deref());
                found.expect("software does not fail").hits.len()
            }),
            Column::new("cells, numbers", || {
                numbers.clear();
                cells(&mut numbers);
                numbers.len()
            }),
            Column::new("cells, contacts", || {
                let mut numbers = Vec::new();
                cells(&mut numbers);
                let second = second.as_ref().unwrap_or(first);
                let pairs: Vec<_> = numbers.iter().map(|&[i, j]| first[i as usize].with(second[j as usize])).collect();
                Fast::new(Fields::ALL).contacts(&pairs).expect("software does not fail").len()
            }),
        ];
        columns.extend(peers::columns(&spheres)?);
        for column in &mut columns {
            column.run(count);
            column.times.clear();
        }
        for column in &mut columns {
            let mut spent = 0.0;
            while spent < SECONDS || column.times.len() < 3 {
                spent += column.run(count);
            }
        }
        if !heading {
            let names: Vec<_> = columns.iter().map(|column| column.name).collect();
            println!(
                "| set | spheres | contacts | {} |\n|---|---{}|",
                names.join(" | "),
                "|---".repeat(names.len() + 1)
            );
            heading = true;
        }
        let moved = if by == 0.0 { String::new() } else { format!(" +{by}") };
        let time = |column: &Column<'_>| match column.contacts {
            0 if column.name != "sorting" => "-".to_owned(),
            _ => format!("{:.0}", column.median()),
        };
        let times: Vec<_> = columns.iter().map(time).collect();
        println!("| `{set}`{moved} | {count} | {} | {} |", columns[2].contacts, times.join(" | "));
        for column in columns.iter().filter(|column| column.contacts > 0) {
            // The others decide in their own arithmetic, and tangent spheres are many here.
            let apart = column.contacts.abs_diff(columns[2].contacts) as f64 / columns[2].contacts as f64;
            if apart > 0.001 {
                eprintln!("{set}{moved}: {} finds {} contacts", column.name, column.contacts);
            }
        }
    }
    Ok(())
}
