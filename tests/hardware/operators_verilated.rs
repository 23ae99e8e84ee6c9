//! Every operator's Verilog, cut for 200 MHz and compiled by Verilator, against its exact twin: a stream of one word
//! per cycle, so that the pipeline is always full.
//!
//! The usual run tests ten million words per operator of two operands, and every significand of square root and
//! reciprocal. `cargo test --test hardware operators_verilated -- --ignored` runs a hundred million each.

use std::collections::VecDeque;

use crate::support::made_for::is_made_for;
use crate::support::{Words, corner};
use contact_afu::cosim::{File, Model, Source, Trace};
use contact_afu::hdl::DelayModel;
use contact_afu::hdl::verilog::{Style, emit};
use contact_afu::number::Format;
use contact_afu::operator::{Domain, Operator, Values, pipelined};
use contact_afu::synth::Target;

const MHZ: f64 = 200.0;

/// Streams `words` through the compiled operator and compares each result `latency` cycles later.
fn stream(model: &Model, operator: Operator, domain: Domain, latency: u32, words: impl Iterator<Item = (u128, u128)>) {
    let format = domain.format();
    let instance = model.instance(1).unwrap();
    let clock = instance.clock("clk").unwrap();
    if instance.has_port("rst") {
        let reset = instance.input("rst", 1).unwrap();
        reset.set(1);
        clock.tick(2).unwrap();
        reset.set(0);
    }
    let a_port = instance.input("a", format.width()).unwrap();
    let b_port = (operator.operands() == 2).then(|| instance.input("b", format.width()).unwrap());
    let result_bits = operator.result_format(format).map_or(1, Format::width);
    let result = instance.output("result", result_bits).unwrap();
    let mut pending: VecDeque<(u128, u128)> = VecDeque::new();
    let mut check = |(a, b): (u128, u128)| {
        if !is_made_for(operator, domain, a, b) {
            return;
        }
        let (got, wanted) = (u128::from(result.get()), operator.twin(format, a, b));
        assert!(got == wanted, "{} of {a:#x}, {b:#x}: {got:#x}, not {wanted:#x}", operator.module_name(domain));
    };
    for (a, b) in words {
        a_port.set(a as u64);
        if let Some(port) = b_port {
            port.set(b as u64);
        }
        pending.push_back((a, b));
        clock.tick(1).unwrap();
        if pending.len() as u32 == latency {
            pending.pop_front().map(&mut check).unwrap();
        }
    }
    while let Some(oldest) = pending.pop_front() {
        clock.tick(1).unwrap();
        check(oldest);
    }
}

fn build(operator: Operator, domain: Domain) -> (Model, u32) {
    build_for(&DelayModel::default(), operator, domain, vec![])
}

/// Builds a model from the operator's files, with `first` before them.
fn build_for(delays: &DelayModel, operator: Operator, domain: Domain, first: Vec<File>) -> (Model, u32) {
    let module = pipelined(operator, domain, delays, MHZ).unwrap();
    let own = module.hierarchy().into_iter();
    let own = own.map(|module| File { name: format!("{}.v", module.name), text: emit(&module, &Style::default()) });
    let files = first.into_iter().chain(own).collect();
    (Model::build(&Source::new(&module.name, files), Trace::Off).unwrap(), module.latency)
}

fn randomly(operator: Operator, domain: impl Into<Domain>, count: u64) {
    let domain = domain.into();
    run(&build(operator, domain), operator, domain, count);
}

fn run((model, latency): &(Model, u32), operator: Operator, domain: Domain, count: u64) {
    let (format, latency) = (domain.format(), *latency);
    crate::support::halves(count, |part| {
        let mut words = Words::new(format.exponent_bits(), format.fraction_bits(), part.start + 1);
        stream(model, operator, domain, latency, part.map(|number| corner(operator, format, &mut words, number)));
    });
}

const TWO_OPERANDS: [Operator; 3] = [Operator::Add, Operator::Mul, Operator::Div];
const OTHERS: [Operator; 6] =
    [Operator::Sub, Operator::Halve, Operator::Greater, Operator::AtMost, Operator::RootExceeds, Operator::Recip];

#[test]
fn ten_million_of_binary32() {
    for operator in TWO_OPERANDS {
        randomly(operator, Format::BINARY32, 10_000_000);
    }
    for operator in OTHERS {
        randomly(operator, Format::BINARY32, 1_000_000);
    }
    randomly(Operator::Convert { to: Format::WIDE }, Format::BINARY32, 1_000_000);
}

#[test]
fn a_million_of_wide() {
    for operator in TWO_OPERANDS.into_iter().chain(OTHERS).chain([Operator::Sqrt]) {
        randomly(operator, Format::WIDE, 300_000);
    }
    randomly(Operator::Convert { to: Format::BINARY32 }, Format::WIDE, 1_000_000);
}

/// The operators of the default AFU.
#[test]
fn a_million_of_wide_without_its_ends() {
    let more = [Operator::Sqrt, Operator::Square, Operator::AddMagnitudes, Operator::Convert { to: Format::BINARY32 }];
    for operator in TWO_OPERANDS.into_iter().chain(OTHERS).chain(more) {
        randomly(operator, Domain::new(Format::WIDE, Values::Normal), 1_000_000);
    }
}

/// The Verilog that synthesis reads: primitives instead of products and of chains that add or subtract, simulated by
/// the models in `tb/`.
#[test]
fn primitives_compute_as_their_twins_do() {
    let delays = Target::Ecp5.delays();
    for synthesis in [true, false] {
        let first = File { name: "primitives.v".to_owned(), text: crate::primitives::primitives() };
        let both = [Operator::Mul, Operator::Square, Operator::Add, Operator::Div, Operator::Sqrt, Operator::Recip];
        let paper = both.map(|operator| (operator, Domain::from(Format::BINARY32)));
        // These roots use tables.
        let wide = [Operator::Sqrt, Operator::Recip].map(|operator| (operator, Domain::from(Format::WIDE)));
        for (operator, domain) in paper.into_iter().chain(wide) {
            let first = if synthesis { vec![first.clone()] } else { vec![] };
            run(&build_for(&delays, operator, domain, first), operator, domain, 200_000);
        }
    }
}

/// Roots by digit recurrence, as subnormals require, and by table.
#[test]
fn every_significand_of_root_and_reciprocal() {
    for (operator, exponents) in [(Operator::Sqrt, 2), (Operator::Recip, 1)] {
        for domain in [Domain::from(Format::BINARY32), Domain::new(Format::WIDE, Values::Normal)] {
            let one = u128::from(domain.bias().unsigned_abs()) << 23;
            let (model, latency) = build(operator, domain);
            crate::support::halves(exponents << 23, |part| {
                stream(&model, operator, domain, latency, part.map(|number| (one + u128::from(number), 0)));
            });
        }
    }
}

#[test]
#[ignore = "some minutes"]
fn a_hundred_million_of_binary32() {
    for operator in TWO_OPERANDS {
        randomly(operator, Format::BINARY32, 100_000_000);
    }
}
