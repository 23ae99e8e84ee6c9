//! Every operator's graph against its exact twin: every pair of words of an 8-bit format, a million random words and
//! corner cases of the formats in use, and fewer of the widest.

use crate::support::made_for::is_made_for;
use crate::support::{Words, corner};
use contact_afu::hdl::{DelayModel, Evaluator, Module, Op, Pin};
use contact_afu::number::{Format, Soft};
use contact_afu::operator::{Architecture, Domain, INPUTS, Operator, Values, build, build_as, pipelined};
use std::sync::Arc;

const ARITHMETIC: [Operator; 12] = [
    Operator::Add,
    Operator::AddMagnitudes,
    Operator::Square,
    Operator::Sub,
    Operator::Mul,
    Operator::Div,
    Operator::Recip,
    Operator::Sqrt,
    Operator::Halve,
    Operator::Greater,
    Operator::AtMost,
    Operator::RootExceeds,
];

const VALUES: [Values; 3] = [Values::Any, Values::Finite, Values::Normal];

fn format(text: &str) -> Format {
    text.parse().unwrap()
}

/// A combinational operator, run on words.
struct Bench {
    operator: Operator,
    domain: Domain,
    evaluator: Evaluator,
    a: Pin,
    result: Pin,
}

impl Bench {
    fn new(operator: Operator, domain: impl Into<Domain>) -> Self {
        let domain = domain.into();
        Self::of(operator, domain, &build(operator, domain).unwrap())
    }

    /// Uses a table if the operator has one.
    fn by_table(operator: Operator, domain: Domain) -> Self {
        Self::of(operator, domain, &build_as(operator, domain, Architecture::Table).unwrap())
    }

    fn of(operator: Operator, domain: Domain, module: &Arc<Module>) -> Self {
        let evaluator = Evaluator::new(module, &[]).unwrap();
        let [a, result] = ["a", "result"].map(|port| evaluator.pin(port).unwrap());
        Self { operator, domain, evaluator, a, result }
    }

    /// The result for one operand of at most 64 bits. It uses pins, which avoids looking up ports by name.
    fn raw(&mut self, a: u64) -> u64 {
        self.evaluator.write(self.a, a);
        self.evaluator.read(self.result)
    }

    /// The hardware's result and the expected one.
    fn both(&mut self, a: u128, b: u128) -> (u128, u128) {
        self.evaluator.set("a", a);
        if self.operator.operands() == 2 {
            self.evaluator.set("b", b);
        }
        (self.evaluator.get("result"), self.operator.twin(self.domain.format(), a, b))
    }

    /// Compares the results if the hardware is made for these operands. Returns false if it is not.
    #[track_caller]
    fn check(&mut self, a: u128, b: u128) -> bool {
        if !is_made_for(self.operator, self.domain, a, b) {
            return false;
        }
        let (got, wanted) = self.both(a, b);
        assert!(
            got == wanted,
            "{} of {a:#x}, {b:#x}: {got:#x}, not {wanted:#x}",
            self.operator.module_name(self.domain)
        );
        true
    }
}

/// Tests every word, or every pair of words for two operands, that the hardware is made for.
fn exhaust(operator: Operator, domain: impl Into<Domain>) {
    let domain = domain.into();
    exhaust_bench(Bench::new(operator, domain));
}

fn exhaust_bench(mut bench: Bench) {
    let (operator, domain) = (bench.operator, bench.domain);
    let words = 1_u128 << domain.width();
    let (mut checked, mut all) = (0_u64, 0_u64);
    for a in 0..words {
        for b in 0..if operator.operands() == 2 { words } else { 1 } {
            checked += u64::from(bench.check(a, b));
            all += 1;
        }
    }
    let least = if domain.values() == Values::Any && operator != Operator::AddMagnitudes { all } else { all / 8 };
    assert!(checked >= least, "{operator:?} of {domain}: {checked} of {all} checked");
}

fn randomly(operator: Operator, domain: impl Into<Domain>, count: u64) {
    let domain = domain.into();
    let format = domain.format();
    crate::support::halves(count, |part| {
        let mut bench = Bench::new(operator, domain);
        let mut words = Words::new(format.exponent_bits(), format.fraction_bits(), part.start + 1);
        for number in part {
            let (a, b) = corner(operator, format, &mut words, number);
            bench.check(a, b);
        }
    });
}

#[test]
fn every_pair_of_an_8_bit_format() {
    for text in ["e5f2", "e5f2z", "e5f2t", "e5f2zt"] {
        for operator in ARITHMETIC {
            VALUES.into_iter().for_each(|values| exhaust(operator, Domain::new(format(text), values)));
        }
    }
}

/// Faithful roots: an 8-bit format whose table holds every result, and longer fractions whose tables are parabolas.
#[test]
fn every_word_of_faithful_formats() {
    for operator in [Operator::Sqrt, Operator::Recip] {
        for text in ["e5f2r", "e5f2zr", "e5f2tr", "e5f2ztr", "e5f6r", "e5f7r", "e5f8ztr", "e5f10tr", "e6f9zr"] {
            VALUES.into_iter().for_each(|values| exhaust(operator, Domain::new(format(text), values)));
        }
    }
}

/// Correct roots by a table and a correcting step: every word of formats for each kind of table. Formats without a
/// table use digit recurrence.
#[test]
fn every_word_of_roots_by_table() {
    for operator in [Operator::Sqrt, Operator::Recip] {
        let mut tables = 0;
        for text in ["e5f2z", "e5f2", "e5f6z", "e5f7z", "e6f9z", "e5f10z", "e5f10", "e5f12z", "e5f10zt"] {
            for values in VALUES {
                let domain = Domain::new(format(text), values);
                tables += u32::from(Architecture::Table.is_possible(operator, domain));
                exhaust_bench(Bench::by_table(operator, domain));
            }
        }
        assert_eq!(tables, 6 * 3 + 2, "{operator:?}: formats without subnormals, and the others' normal numbers");
    }
}

/// Sums of narrower words that are rounded once, to a wider format, with and without the exponent range that this
/// takes.
#[test]
fn every_pair_of_8_bit_words_added_in_another_format() {
    for from in ["e5f2", "e5f2z", "e5f2t", "e5f2zt"].map(format) {
        for to in ["e6f2", "e6f5z", "e7f9", "e7f9zt", "e5f3", "e5f5z"].map(format) {
            for operator in [Operator::WideningAdd { to }, Operator::WideningSub { to }] {
                VALUES.into_iter().for_each(|values| exhaust(operator, Domain::new(from, values)));
            }
        }
    }
}

#[test]
fn a_million_of_records_added_in_wide() {
    for operator in [Operator::WideningAdd { to: Format::WIDE }, Operator::WideningSub { to: Format::WIDE }] {
        randomly(operator, Domain::new(Format::BINARY32, Values::Finite), 500_000);
        randomly(operator, Format::BINARY32, 200_000);
        randomly(operator, format("half"), 100_000);
    }
}

/// Rounding toward zero, the opposite treatment of subnormals, and faithful roots at 24 bits and elsewhere.
#[test]
fn a_million_of_other_arithmetic() {
    for operator in ARITHMETIC {
        for (text, count) in [("e8f23t", 150_000), ("e8f23z", 150_000), ("e5f14t", 20_000), ("e5f24t", 20_000)] {
            randomly(operator, format(text), count);
        }
        for text in ["e10f23zt", "e10f23"] {
            randomly(operator, Domain::new(format(text), Values::Normal), 150_000);
            randomly(operator, format(text), 50_000);
        }
    }
    for (from, to) in [("e8f23t", "e10f23zt"), ("e10f23zt", "e8f23t"), ("half", "e8f23t"), ("e8f23t", "e5f10t")] {
        let convert = Operator::Convert { to: format(to) };
        VALUES.into_iter().for_each(|values| randomly(convert, Domain::new(format(from), values), 100_000));
    }
    for operator in [Operator::Sqrt, Operator::Recip] {
        for text in ["e10f23zr", "e8f23r", "e8f23tr", "e8f15r", "e5f23r", "e5f23tr", "e10f27zr", "e6f29r", "e10f31ztr"]
        {
            VALUES.into_iter().for_each(|values| randomly(operator, Domain::new(format(text), values), 100_000));
        }
    }
}

#[test]
fn every_word_of_small_formats_converted() {
    let formats = ["e5f2", "e5f2z", "e5f6", "e5f6z", "e6f3", "e6f3z", "e7f2", "e7f9z", "half", "paper", "wide"];
    for from in formats.map(format).into_iter().filter(|from| from.width() <= 16) {
        for to in formats.map(format).into_iter().filter(|to| *to != from) {
            let convert = Operator::Convert { to };
            VALUES.into_iter().for_each(|values| exhaust(convert, Domain::new(from, values)));
        }
    }
}

/// With five exponent bits and many fraction bits the squares and roots of subnormals are in range.
#[test]
fn short_exponents_under_long_fractions() {
    for text in ["e5f14", "e5f15", "e5f24", "e5f24z", "e5f52", "e6f40"] {
        for operator in ARITHMETIC {
            randomly(operator, format(text), 20_000);
        }
    }
}

#[test]
fn a_million_of_binary32() {
    for operator in ARITHMETIC {
        randomly(operator, Format::BINARY32, 1_000_000);
    }
    for values in [Values::Any, Values::Finite] {
        randomly(Operator::Convert { to: Format::WIDE }, Domain::new(Format::BINARY32, values), 500_000);
    }
}

#[test]
fn a_million_of_wide() {
    for operator in ARITHMETIC {
        randomly(operator, Format::WIDE, 300_000);
        randomly(operator, Domain::new(Format::WIDE, Values::Normal), 700_000);
    }
    for values in [Values::Any, Values::Normal] {
        randomly(Operator::Convert { to: Format::BINARY32 }, Domain::new(Format::WIDE, values), 500_000);
    }
}

#[test]
fn other_formats() {
    for (text, count) in [("half", 100_000), ("bfloat", 100_000), ("e11f52", 20_000), ("e15f52", 20_000)] {
        let format = format(text);
        for operator in ARITHMETIC {
            randomly(operator, format, count);
        }
        for to in [Format::BINARY32, Format::WIDE] {
            randomly(Operator::Convert { to }, format, count);
            randomly(Operator::Convert { to: format }, to, count);
        }
    }
}

/// Rounding to odd, in the format of the exact kernel and in one with subnormals.
#[test]
fn sums_rounded_to_odd() {
    for operator in [Operator::AddToOdd, Operator::SubToOdd] {
        for (format, count) in [(Format::DIFFERENCE, 300_000), (Format::BINARY32, 300_000), (format("e6f9z"), 100_000)]
        {
            randomly(operator, format, count);
        }
    }
}

/// The excess of squares: operands of very different and similar magnitude, sums that nearly cancel, words with few
/// bits.
#[test]
fn the_excess_of_squares() {
    let (format, operator) = (Format::DIFFERENCE, Operator::SquareExcess { to: Format::TAIL });
    let mut words = Words::new(10, 47, 77);
    let mut evaluator = Evaluator::new(&build(operator, format).unwrap(), &[]).unwrap();
    let (mut settled, mut doubtful) = (0, 0);
    for count in 0..400_000_u32 {
        let ((a, b), (c, d)) = (words.two(), words.two());
        let mut operands = [a, b, c, d];
        if count % 4 != 0 {
            // Operands of one scale, with a random number of trailing zeros.
            let zeros = count / 4 % 48;
            let exponent = 500 + u128::from(count % 7);
            for (operand, less) in operands.iter_mut().zip([0, 0, count % 3, count % 31]) {
                *operand = *operand & ((1 << 57) | ((1 << 47) - 1)) | (exponent - u128::from(less)) << 47;
                *operand = *operand >> zeros << zeros;
            }
        }
        if count % 4 == 1 {
            // The first operand is the root of the others' squares, so that everything but the rounding error cancels.
            let squares = operands[1..].iter().map(|&word| Soft::from_bits(format, word).to_f64().powi(2));
            operands[0] = Soft::from_f64(format, squares.sum::<f64>().sqrt()).bits();
        }
        for (name, operand) in INPUTS.into_iter().zip(operands) {
            evaluator.set(name, operand);
        }
        let (got, wanted) = (evaluator.get("result"), operator.twin_of(format, operands));
        assert!(got == wanted, "{operands:x?}: {got:#x}, not {wanted:#x}");
        let counter = if wanted == Format::TAIL.nan_bits() { &mut doubtful } else { &mut settled };
        *counter += 1;
    }
    assert!(settled > 100_000 && doubtful > 50_000, "{settled} settled, {doubtful} in doubt");
}

/// A digit recurrence has no table entries to sample, and each word of a table may be wrong. So this tests every
/// significand of binary32 against the machine's own arithmetic, with an even and an odd exponent for the root.
#[test]
fn every_significand_of_root_and_reciprocal() {
    every_significand(Bench::new);
    // The architecture that the default AFU uses.
    every_significand(Bench::by_table);
}

fn every_significand(bench: impl Fn(Operator, Domain) -> Bench + Sync) {
    crate::support::halves(1 << 24, |part| {
        let domain = Domain::new(Format::WIDE, Values::Normal);
        let mut root = bench(Operator::Sqrt, domain);
        let mut inverse = bench(Operator::Recip, domain);
        // Binary32 and wide have the same fraction; the biases differ by 384.
        let wide = |word: u32| u64::from(word) + (384 << 23);
        let check = |bench: &mut Bench, value: f32, wanted: f32| {
            let got = bench.raw(wide(value.to_bits()));
            assert!(got == wide(wanted.to_bits()), "{:?} of {value:e}: {got:#x}, not {wanted:e}", bench.operator);
        };
        for word in part.map(|number| (127 << 23) + number as u32) {
            let value = f32::from_bits(word);
            check(&mut root, value, value.sqrt());
            if word < 128 << 23 {
                check(&mut inverse, value, 1.0 / value);
            }
        }
    });
}

/// An operator cut for any clock gives the same results, with new operands in every cycle.
#[test]
fn pipelines_compute_the_same() {
    for format in ["e5f2", "half", "paper", "wide", "e11f52", "e10f23ztr"].map(format) {
        let convert = Operator::Convert { to: if format == Format::WIDE { Format::BINARY32 } else { Format::WIDE } };
        for (operator, clock_mhz) in ARITHMETIC.into_iter().chain([convert]).zip([100.0, 200.0, 300.0].iter().cycle()) {
            // Includes both kinds of multiplier blocks.
            let model = match format.fraction_bits() {
                23 => DelayModel::default(),
                _ => DelayModel::ecp5(),
            };
            let module = pipelined(operator, format, &model, *clock_mhz).unwrap();
            let mut evaluator = Evaluator::new(&module, &[]).unwrap();
            let mut words = Words::new(format.exponent_bits(), format.fraction_bits(), 1);
            let operands: Vec<_> = (0..2_000).map(|count| corner(operator, format, &mut words, count)).collect();
            let latency = module.latency as usize;
            assert!(latency > 0);
            for cycle in 0..operands.len() + latency {
                if cycle >= latency {
                    let (a, b) = operands[cycle - latency];
                    let wanted = operator.twin(format, a, b);
                    assert_eq!(evaluator.get("result"), wanted, "{} of {a:#x}, {b:#x}", module.name);
                }
                let (a, b) = operands.get(cycle).copied().unwrap_or_default();
                evaluator.set("a", a);
                if operator.operands() == 2 {
                    evaluator.set("b", b);
                }
                evaluator.step();
            }
        }
    }
}

/// The module with one gate replaced by another; `None` if the node is not a suitable gate.
fn with_fault(module: &Module, node: usize) -> Option<Module> {
    let mut faulty = module.clone();
    faulty.nodes[node].op = match faulty.nodes[node].op {
        Op::And => Op::Or,
        Op::Or => Op::And,
        Op::Xor => Op::And,
        Op::Add => Op::Sub,
        Op::Sub => Op::Add,
        Op::Any => Op::All,
        Op::All => Op::Any,
        Op::Less => Op::Equal,
        Op::Equal => Op::Less,
        _ => return None,
    };
    Some(faulty)
}

/// The comparison can fail: the words of the 8-bit format detect nearly every wrong gate in an operator. The few others
/// make no difference in this format, such as a sum with zero that became a difference.
#[test]
fn planted_faults_are_found() {
    let format = format("e5f2");
    for operator in ARITHMETIC {
        let module = build(operator, format).unwrap();
        let faults: Vec<_> = (0..module.nodes.len()).filter_map(|node| with_fault(&module, node)).collect();
        let is_found = |fault: &&Module| {
            let mut bench = Bench::of(operator, format.into(), &Arc::new((*fault).clone()));
            (0..1_u128 << 16).any(|pair| {
                let (got, wanted) = bench.both(pair >> 8, pair & 0xFF);
                got != wanted
            })
        };
        let found = faults.iter().filter(is_found).count();
        let name = operator.module_name(format);
        println!("{name}: {found} of {} found", faults.len());
        assert!(faults.len() >= 8 && found * 10 >= faults.len() * 9, "{name}: {found} of {} found", faults.len());
    }
}
