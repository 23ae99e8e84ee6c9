//! Errors as the accuracy studies compute them, against independent computations.

use contact_afu::accuracy::{Answer, Contender, Contenders, Formula, Profiled, Row, assess, measure};
use contact_afu::kernel::EngineError;
use contact_afu::pairs::Set;
use contact_afu::query::PairRecord;
use contact_afu::query::Query::SphereSphere;
use contact_afu::store::Store;

fn profiled(name: &str) -> Box<dyn Contender> {
    Box::new(Profiled::new(&name.parse().expect("a profile")))
}

fn rows(pairs: &[PairRecord], mut contenders: Contenders) -> Vec<Row> {
    let store = Store::temporary().expect("a temporary folder");
    measure(SphereSphere, "dense", pairs, &mut contenders, &store, |_| {}).expect("no contender fails").0
}

fn dense() -> Vec<PairRecord> {
    Set::Dense(10_000).pairs(3)
}

/// `paper` is binary32, so this evaluates the formula in the machine's own `f32`. Errors are computed in `f64` only,
/// which is right to 29 bits of the compared numbers.
#[test]
fn errors_of_paper_are_those_of_f32() {
    let pairs = dense();
    let rows = rows(&pairs, vec![profiled("paper"), Box::new(Formula(SphereSphere))]);
    assert_eq!((rows[0].tally, rows[0].errors), (rows[1].tally, rows[1].errors));

    let (mut sum, mut largest, mut count) = (0.0, 0.0_f64, 0_u64);
    for pair in &pairs {
        let [x1, y1, z1, r1, x2, y2, z2, r2] = pair.values();
        let (dx, dy, dz) = (x1 - x2, y1 - y2, z1 - z2);
        let distance = (dx * dx + dy * dy + dz * dz).sqrt();
        let [x, y, z] = [[x1, x2], [y1, y2], [z1, z2]].map(|[a, b]| f64::from(a) - f64::from(b));
        let (exact, radii) = ((x * x + y * y + z * z).sqrt(), f64::from(r1) + f64::from(r2));
        if distance > r1 + r2 || exact > radii {
            continue;
        }
        let error = (f64::from(r1 + r2 - distance) - (radii - exact)).abs() / radii;
        (sum, largest, count) = (sum + error, largest.max(error), count + 1);
    }
    let depth = rows[0].errors.depth;
    assert_eq!(depth.count, count);
    assert!((depth.mean - sum / count as f64).abs() < 1e-12, "{depth:?}, {}", sum / count as f64);
    assert!((depth.largest - largest).abs() < 1e-12, "{depth:?}, {largest}");
    assert!(depth.mean < depth.p999 && depth.p999 <= depth.largest);
}

/// Up to the 23 fraction bits of the record, every bit makes errors smaller. With 24 bits they grow, and with more bits
/// they fall again. Every second number of 24 bits lies in the middle between two numbers of the record, so a second
/// rounding adds to the first. In the end the errors are those of rounding the true number to the record, which no
/// arithmetic avoids.
#[test]
fn more_fraction_bits_are_no_more_error_on_average_but_from_23_to_24() {
    let bits: Vec<u32> = (5..=32).collect();
    let rows = rows(&dense(), bits.iter().map(|bits| profiled(&format!("e10f{bits}z"))).collect());
    let of = |row: &Row| [row.errors.depth.mean, row.errors.normal.mean, row.errors.position.mean];
    for (pair, bits) in rows.windows(2).zip(&bits) {
        for (fewer, more) in of(&pair[0]).into_iter().zip(of(&pair[1])) {
            // From 28 bits on, means vary at random.
            let limit = fewer * if *bits < 28 { 1.0 } else { 1.001 };
            assert!(*bits == 23 || more <= limit, "{bits} bits: {fewer:e}, one more: {more:e}");
        }
    }
    // The mean error of a position, in units of its last place: 1/4 on average, and 5/16 if every second number is a
    // tie.
    let [at_23, at_24, at_32] = [23, 24, 32].map(|bits| of(&rows[bits - 5])[2]);
    assert!((1.2..1.3).contains(&(at_24 / at_32)) && at_24 > 1.2 * at_23, "{at_23:e} {at_24:e} {at_32:e}");
    // From 5 to 20 bits, each bit nearly halves the error.
    let [first, last] = [0, 15].map(|i| rows[i].errors.contact.mean);
    assert!((0.4..0.6).contains(&(last / first).powf(1.0 / 15.0)), "{first:e} {last:e}");
}

/// A formula with one sum rounded in the wrong direction.
struct Broken;

impl Contender for Broken {
    fn name(&self) -> String {
        "broken".to_owned()
    }

    fn answers(&mut self, pairs: &[PairRecord]) -> Result<Vec<Answer>, EngineError> {
        let mut answers = Formula(SphereSphere).answers(pairs)?;
        for answer in &mut answers {
            // Rounds toward zero.
            answer.depth = f64::from((answer.depth as f32).next_down());
        }
        Ok(answers)
    }
}

#[test]
fn a_broken_rounding_is_seen() {
    let pairs = dense();
    let found = rows(&pairs, vec![profiled("paper"), Box::new(Broken)]);
    let [good, bad] = [&found[0].errors, &found[1].errors];
    assert!(bad.depth_ulps.mean > good.depth_ulps.mean * 1.01, "{good:?} {bad:?}");
    assert_eq!(bad.normal, good.normal, "nothing else changed");
    assert_eq!(bad.position, good.position);
}

/// A formula that may be evaluated only once.
struct Once(bool);

impl Contender for Once {
    fn name(&self) -> String {
        "once".to_owned()
    }

    fn answers(&mut self, pairs: &[PairRecord]) -> Result<Vec<Answer>, EngineError> {
        match std::mem::replace(&mut self.0, false) {
            true => Formula(SphereSphere).answers(pairs),
            false => Err("asked again".into()),
        }
    }
}

#[test]
fn a_known_row_is_not_measured_again() {
    let pairs = &dense()[..500];
    let store = Store::temporary().expect("a temporary folder");
    let measured = |pairs: &[PairRecord], contenders: Contenders| {
        let mut contenders = contenders;
        measure(SphereSphere, "dense", pairs, &mut contenders, &store, |_| {}).map_err(|error| error.to_string())
    };
    let (rows, known) = measured(pairs, vec![Box::new(Once(true))]).expect("answers");
    assert_eq!(known, 0);
    let (tally, errors) = assess(SphereSphere, pairs, &Formula(SphereSphere).answers(pairs).expect("answers"));
    assert_eq!((rows[0].tally, rows[0].errors), (tally, errors));

    let (again, known) = measured(pairs, vec![Box::new(Once(false)), profiled("bfloat")]).expect("not asked again");
    assert_eq!((known, &again[0]), (1, &rows[0]));
    assert_ne!(again[1].errors, again[0].errors, "nor is one contender's row another's");
    assert_eq!(measured(&pairs[1..], vec![Box::new(Once(false))]).expect_err("other pairs"), "once: asked again");
}
