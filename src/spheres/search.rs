//! The search: boxes of 16 rows, then boxes of rows, then each sphere against a row's box, then box against box.

#[cfg(target_arch = "x86_64")]
use super::lanes::{Avx2, Avx512};
use super::lanes::{Lanes, Portable};
use super::rows::{ROW, Row, Rows};
use super::{BoundsRule, RefusedArithmetic, Sphere, reorder};
use crate::kernel::{Arithmetic, Engine, EngineError};
use crate::query::{ContactRecord, PairRecord};

/// How many comparisons each stage made, and what was left after the last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// A row's box with the box around 16 rows.
    pub group_tests: u64,
    /// A row's box with a row's box.
    pub row_tests: u64,
    /// A sphere's box with a row's box.
    pub sphere_tests: u64,
    /// A sphere's box with each box of a row: 16 at once.
    pub column_tests: u64,
    /// Pairs of spheres whose boxes meet.
    pub candidates: u64,
    /// Invalid spheres. They pair with no sphere.
    pub invalid: u64,
}

/// The pairs of spheres whose boxes meet.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Candidates {
    /// The numbers of the two spheres. In one set the first number is the smaller one; of two sets the first is in the
    /// first set.
    ///
    /// Pairs come in the order of the second sphere's row, the first sphere's row, the second sphere, the first sphere.
    pub pairs: Vec<[u32; 2]>,
    /// The comparisons that this took.
    pub counts: Counts,
}

/// Two spheres that touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hit {
    /// The numbers of the two spheres, as in [`Candidates::pairs`].
    pub spheres: [u32; 2],
    /// Their contact. Its normal points into the first sphere.
    pub contact: ContactRecord,
}

/// The result of a search.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// The spheres that touch, in the order of [`Candidates::pairs`].
    pub hits: Vec<Hit>,
    /// The comparisons that this took.
    pub counts: Counts,
}

/// A search among spheres, for one arithmetic.
///
/// ```
/// use contact_afu::config::Profile;
/// use contact_afu::query::Fields;
/// use contact_afu::spheres::{Search, Sphere};
///
/// let spheres = [[0.0, 0.0, 0.0, 1.0], [5.0, 0.0, 0.0, 1.0], [1.5, 0.0, 0.0, 1.0]].map(Sphere::new);
/// let search = Search::new(Profile::WIDE.arithmetic(), 24)?;
/// let hits = search.find(&mut Profile::WIDE.reference(Fields::ALL), &spheres, None)?.hits;
/// assert_eq!(hits.len(), 1);
/// assert_eq!((hits[0].spheres, hits[0].contact.depth()), ([0, 2], 0.5));
/// # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    rule: BoundsRule,
}

impl Search {
    /// A search whose pairs are decided in `arithmetic`, with boxes of `bits` bits. Fewer bits make more candidates and
    /// the same hits.
    ///
    /// # Errors
    /// Returns the errors of [`BoundsRule::new`].
    pub fn new(arithmetic: Arithmetic, bits: u32) -> Result<Self, RefusedArithmetic> {
        Ok(Self { rule: BoundsRule::new(arithmetic, bits)? })
    }

    /// The rule of the boxes.
    pub const fn rule(&self) -> BoundsRule {
        self.rule
    }

    /// The candidates among `spheres`, each pair once; or, with a second set, between `spheres` and `others`.
    pub fn candidates(&self, spheres: &[Sphere], others: Option<&[Sphere]>) -> Candidates {
        self.walk(spheres, others, false)
    }

    /// The candidates, or those of them that a comparison in binary32 does not call apart; `counts` are the same.
    fn walk(&self, spheres: &[Sphere], others: Option<&[Sphere]>, only_near: bool) -> Candidates {
        let first = Rows::new(self.rule, spheres);
        let second = others.map(|others| Rows::new(self.rule, others));
        let only_near = only_near && self.rule.contains_binary32();
        let second = second.as_ref();
        #[cfg(target_arch = "x86_64")]
        if let Some(lanes) = Avx512::new() {
            // SAFETY: `new` found the instruction set.
            return unsafe { walk_avx512(lanes, &first, second, only_near) };
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(lanes) = Avx2::new() {
            // SAFETY: `new` found the instruction set.
            return unsafe { walk_avx2(lanes, &first, second, only_near) };
        }
        walk(Portable, &first, second, only_near)
    }

    /// The spheres that touch, of one set or of two. `engine` decides the candidates; it must compute in the arithmetic
    /// of this search.
    ///
    /// # Errors
    /// Returns the error of the engine.
    pub fn find(
        &self,
        engine: &mut dyn Engine,
        spheres: &[Sphere],
        others: Option<&[Sphere]>,
    ) -> Result<Found, EngineError> {
        let Candidates { pairs, counts } = self.walk(spheres, others, true);
        Ok(Found { hits: decided(engine, pairs, spheres, others.unwrap_or(spheres))?, counts })
    }

    /// The same among `spheres`, which are compared in the given `order`, such as that of [`hilbert_order`]. The result
    /// does not depend on the order: numbers are those in `spheres`, the first one of a hit is the smaller one, and
    /// hits are sorted by their first and then their second number.
    ///
    /// # Errors
    /// Returns the error of the engine.
    ///
    /// # Panics
    /// If `order` names a sphere that does not exist.
    ///
    /// [`hilbert_order`]: super::hilbert_order
    pub fn find_in_order(
        &self,
        engine: &mut dyn Engine,
        spheres: &[Sphere],
        order: &[u32],
    ) -> Result<Found, EngineError> {
        let Candidates { mut pairs, counts } = self.walk(&reorder(spheres, order), None, true);
        for pair in &mut pairs {
            *pair = pair.map(|place| order[place as usize]);
            pair.sort_unstable();
        }
        pairs.sort_unstable();
        Ok(Found { hits: decided(engine, pairs, spheres, spheres)?, counts })
    }
}

/// Those of `pairs` that touch.
fn decided(
    engine: &mut dyn Engine,
    pairs: Vec<[u32; 2]>,
    first: &[Sphere],
    second: &[Sphere],
) -> Result<Vec<Hit>, EngineError> {
    let records: Vec<PairRecord> = pairs.iter().map(|&[i, j]| first[i as usize].with(second[j as usize])).collect();
    let contacts = engine.contacts(&records)?;
    let touching = pairs.into_iter().zip(contacts).filter(|(_, contact)| contact.is_contact());
    Ok(touching.map(|(spheres, contact)| Hit { spheres, contact }).collect())
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn walk_avx512(lanes: Avx512, first: &Rows, second: Option<&Rows>, only_near: bool) -> Candidates {
    walk(lanes, first, second, only_near)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn walk_avx2(lanes: Avx2, first: &Rows, second: Option<&Rows>, only_near: bool) -> Candidates {
    walk(lanes, first, second, only_near)
}

/// Compares every row of the second set with the rows of the first; within one set, with those up to itself.
#[inline(always)]
fn walk<L: Lanes>(lanes: L, first: &Rows, second: Option<&Rows>, only_near: bool) -> Candidates {
    let mut found = Candidates::default();
    found.counts.invalid = first.invalid + second.map_or(0, |second| second.invalid);
    for (number, row) in second.unwrap_or(first).rows.iter().enumerate() {
        let rows = if second.is_none() { number + 1 } else { first.rows.len() };
        for (group, boxes) in first.groups[..rows.div_ceil(ROW)].iter().enumerate() {
            found.counts.group_tests += 1;
            if !boxes.around.meets(&row.boxes.around) {
                continue;
            }
            let members = ROW.min(rows - group * ROW);
            found.counts.row_tests += members as u64;
            for member in places(lanes.meeting(boxes, &row.boxes.around) & below(members)) {
                let other = group * ROW + member;
                let is_same = second.is_none() && other == number;
                two_rows(lanes, [other, number], [&first.rows[other], row], [is_same, only_near], &mut found);
            }
        }
    }
    found
}

/// The candidates of two rows of these numbers, or within one row.
#[inline(always)]
fn two_rows<L: Lanes>(
    lanes: L,
    [first, second]: [usize; 2],
    [member, row]: [&Row; 2],
    [is_same, only_near]: [bool; 2],
    found: &mut Candidates,
) {
    found.counts.sphere_tests += ROW as u64;
    let columns = lanes.meeting(&row.boxes, &member.boxes.around);
    found.counts.column_tests += u64::from(columns.count_ones());
    for column in places(columns) {
        let mut meeting = lanes.meeting(&member.boxes, &row.boxes.column(column));
        if is_same {
            meeting &= below(column);
        }
        found.counts.candidates += u64::from(meeting.count_ones());
        if only_near && meeting != 0 {
            meeting &= lanes.near(member, &row.sphere(column));
        }
        let sphere = (second * ROW + column) as u32;
        found.pairs.extend(places(meeting).map(|place| [(first * ROW + place) as u32, sphere]));
    }
}

/// The columns before this one.
#[inline(always)]
fn below(column: usize) -> u16 {
    ((1_u32 << column) - 1) as u16
}

/// The columns whose bits are set, in order.
#[inline(always)]
fn places(mut columns: u16) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = columns.trailing_zeros() as usize;
        (columns != 0).then(|| {
            columns &= columns - 1;
            place
        })
    })
}

#[cfg(test)]
mod tests;
