//! Times on this machine: each column is a way to find the contacts of a set.

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use contact_afu::config::Profile;
use contact_afu::kernel::{Engine, Fast};
use contact_afu::query::{Fields, PairRecord};
use contact_afu::report::spheres_times::Measured;
use contact_afu::spheres::{Search, Sphere, Spheres, hilbert_order, reorder};

use super::cells::Cells;
use super::peers;

/// Seconds of a first pass after which there is no second one.
const SLOW: f64 = 3.0;
/// How often each column has its turn: what else a machine does slows it for seconds, and then all columns alike.
const TURNS: u32 = 10;

/// A way to find contacts. A pass returns how many it finds; times are in ns per sphere.
pub struct Column<'a> {
    name: &'static str,
    pass: Box<dyn FnMut() -> usize + 'a>,
    contacts: usize,
    times: Vec<f64>,
}

impl<'a> Column<'a> {
    pub fn new(name: &'static str, pass: impl FnMut() -> usize + 'a) -> Self {
        Self { name, pass: Box::new(pass), contacts: 0, times: Vec::new() }
    }

    /// One pass; returns its seconds.
    fn pass(&mut self, spheres: usize) -> f64 {
        let begin = Instant::now();
        self.contacts = black_box((self.pass)());
        let seconds = begin.elapsed().as_secs_f64();
        self.times.push(seconds * 1e9 / spheres as f64);
        seconds
    }

    /// The first pass, which is not counted unless it is slow, and is then the only one.
    fn begin(&mut self, spheres: usize) {
        if self.pass(spheres) < SLOW {
            self.times.clear();
        }
    }

    /// Passes for so many seconds, at least one; none if the first was slow.
    fn turn(&mut self, spheres: usize, seconds: f64) {
        let is_slow = self.times.first().is_some_and(|&time| time * spheres as f64 >= SLOW * 1e9);
        let mut spent = 0.0;
        while !is_slow && spent < seconds {
            spent += self.pass(spheres);
        }
    }

    fn median(&mut self) -> f64 {
        self.times.sort_by(f64::total_cmp);
        self.times[self.times.len() / 2]
    }
}

/// The spheres of each set in the order of a Hilbert curve.
pub fn in_order(Spheres { first, second }: Spheres) -> Spheres {
    let sorted = |spheres: Vec<Sphere>| reorder(&spheres, &hilbert_order(&spheres));
    Spheres { first: sorted(first), second: second.map(sorted) }
}

fn values(spheres: &[Sphere]) -> Vec<[f32; 4]> {
    spheres.iter().map(|sphere| sphere.values()).collect()
}

/// The spheres as the cell list takes them.
struct ForCells {
    first: Vec<[f32; 4]>,
    second: Option<Vec<[f32; 4]>>,
    /// As far as two can be apart and touch.
    reach: f32,
}

impl ForCells {
    fn new(spheres: &Spheres) -> Self {
        let (first, second) = (values(&spheres.first), spheres.second.as_deref().map(values));
        let largest = |spheres: &[[f32; 4]]| spheres.iter().map(|sphere| sphere[3]).fold(0.0, f32::max);
        let reach = largest(&first) + second.as_deref().map_or(largest(&first), largest);
        Self { first, second, reach }
    }

    fn find(&self, found: &mut Vec<[u32; 2]>) {
        found.clear();
        let cells = Cells::new(&self.first, self.reach);
        match &self.second {
            None => cells.pairs(found),
            Some(second) => cells.pairs_with(second, found),
        }
    }
}

fn pairs(spheres: &Spheres, numbers: &[[u32; 2]]) -> Vec<PairRecord> {
    let Spheres { first, second } = spheres;
    let second = second.as_ref().unwrap_or(first);
    numbers.iter().map(|&[i, j]| first[i as usize].with(second[j as usize])).collect()
}

/// The pairs that the cell list finds.
pub fn touching(spheres: &Spheres) -> Vec<PairRecord> {
    let mut numbers = Vec::new();
    ForCells::new(spheres).find(&mut numbers);
    pairs(spheres, &numbers)
}

/// The number of contacts, and the medians of all columns, which take turns for so many `seconds` each. Engines that
/// find another number are named on standard error.
pub fn measure(set: &str, spheres: &Spheres, seconds: f64) -> Result<(u64, Measured), Box<dyn Error>> {
    let search = Search::new(Profile::WIDE.arithmetic(), 24)?;
    let Spheres { first, second } = spheres;
    let count = spheres.count();
    let find = |fields| {
        let found = search.find(&mut Fast::new(fields), first, second.as_deref());
        found.expect("software does not fail").hits.len()
    };
    let for_cells = ForCells::new(spheres);
    let mut numbers = Vec::new();
    let mut columns = [
        Some(Column::new("sorting", || {
            black_box(hilbert_order(black_box(first)));
            second.iter().for_each(|second| drop(black_box(hilbert_order(second))));
            0
        })),
        Some(Column::new("search, numbers", || find(Fields::HIT))),
        Some(Column::new("search, contacts", || find(Fields::ALL))),
        Some(Column::new("cells, numbers", || {
            for_cells.find(&mut numbers);
            numbers.len()
        })),
        Some(Column::new("cells, contacts", || {
            let mut numbers = Vec::new();
            for_cells.find(&mut numbers);
            Fast::new(Fields::ALL).contacts(&pairs(spheres, &numbers)).expect("software does not fail").len()
        })),
        peers::hash(spheres)?,
        peers::sweep_and_prune(spheres)?,
        peers::parry(spheres),
    ];
    let expected = find(Fields::HIT);
    for column in columns.iter_mut().flatten() {
        column.begin(count);
    }
    for _ in 0..TURNS {
        for column in columns.iter_mut().flatten() {
            column.turn(count, seconds / f64::from(TURNS));
        }
    }
    let times = columns.map(|column| {
        let mut column = column?;
        // The others decide in their own arithmetic, and tangent spheres are many here.
        let apart = column.contacts.abs_diff(expected) as f64 > 0.001 * expected as f64;
        if apart && column.name != "sorting" {
            eprintln!("{set}: {} finds {} contacts, not {expected}", column.name, column.contacts);
        }
        Some(column.median())
    });
    let [sorting, search_numbers, search_contacts, cells_numbers, cells_contacts, ode_hash, ode_sweep, parry] = times;
    let measured = Measured {
        sorting,
        search_numbers,
        search_contacts,
        cells_numbers,
        cells_contacts,
        ode_hash,
        ode_sweep,
        parry,
    };
    Ok((expected as u64, measured))
}
