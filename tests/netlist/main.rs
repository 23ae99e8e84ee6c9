//! Operators and SCPUs in a second, four-state simulator: the Verilog as it is printed, and the netlist after
//! synthesis, as gates and as cells of an ECP5. All run in Icarus, against the twins and the reference kernel. An
//! unknown output bit is a mismatch. SCPUs of full width after synthesis run in Verilator, because Icarus takes hours
//! to compile them.

#[path = "../support/primitives.rs"]
mod primitives;
mod simulate;
mod synthesise;
mod verilated;

use contact_afu::query::Query;
use std::sync::Arc;

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Input, Profile, Results, Search, Shell};
use contact_afu::hdl::{DelayModel, Evaluator, Graph, Module, Signal};
use contact_afu::operator::{Operator, Values};
use contact_afu::pairs::{self, Set};
use contact_afu::query::{Fields, PairRecord};
use contact_afu::record::Layout;
use contact_afu::synth::{Target, Unit};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use simulate::{Vector, simulate};
use synthesise::{As, verilog};

/// Compares a module's outputs in each form with the expected ones.
fn check(what: &str, module: &Arc<Module>, forms: &[As], latency: u32, inputs: &[Vector], wanted: &[Vector]) {
    for &form in forms {
        let found = simulate(module, &verilog(module, form), latency, inputs);
        for ((input, found), wanted) in inputs.iter().zip(&found).zip(wanted) {
            assert_eq!(found, &simulate::bits(wanted), "{what}, {form:?}, of {input:x?}");
        }
        assert_eq!(found.len(), inputs.len());
    }
}

/// Tests an operator with random words and with corner cases.
fn operator(operator: Operator, profile: &str, forms: &[As], count: usize) {
    let profile: Profile = profile.parse().expect("a profile");
    let format = profile.format();
    let model = if forms.contains(&As::Blocks) { Target::Ecp5.delays() } else { DelayModel::default() };
    let unit = Unit::operator(operator, &profile, Values::Any, &model, 200.0).expect("it can be cut");
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let corners = [0, 1, format.sign_mask(), format.sign_mask() - 1, format.sign_mask() >> 1, format.sign_mask() >> 2];
    let mut word = |i: usize| match i % 3 {
        0 => corners[random.random_range(0..corners.len())],
        _ => u128::from(random.random::<u64>()) & (2 * format.sign_mask() - 1),
    };
    let operands: Vec<[u128; 2]> = (0..count).map(|i| [word(i), word(i / 3)]).collect();
    let width = format.width();
    let result = operator.result_format(format).map_or(1, |format| format.width());
    let inputs: Vec<Vector> =
        operands.iter().map(|&two| two[..operator.operands()].iter().map(|&v| (v, width)).collect()).collect();
    let wanted: Vec<Vector> = operands.iter().map(|&[a, b]| vec![(operator.twin(format, a, b), result)]).collect();
    let latency = unit.latency.expect("a pipeline");
    check(&unit.title(), &unit.module, forms, latency, &inputs, &wanted);
}

/// Packs words into a vector, the first word in the lowest bits.
fn words(words: [u32; 8]) -> Vector {
    words.into_iter().rev().map(|word| (word.into(), 32)).collect()
}

/// Tests an SCPU: each pair's record, and the flags for a contact and for an invalid pair.
fn scpu(profile: &str, contact: &str, forms: &[As], pairs: &[PairRecord]) {
    let profile: Profile = profile.parse().expect("a profile");
    let contact = contact.parse().expect("fields");
    let config = Config { scpus: 1, profile, contact, shell: Shell::Line, ..Config::default() };
    let unit = Unit::scpu(&config).expect("it can be generated");
    let inputs: Vec<Vector> = pairs.iter().map(|pair| words(pair.0)).collect();
    let records = config.profile.reference(contact).run_all(pairs);
    let layout = Layout::of(512, &config);
    let wanted: Vec<Vector> = pairs
        .iter()
        .zip(&records)
        .map(|(pair, record)| {
            let fields = layout.contact_words().into_iter().rev().map(|word| (record.0[word].into(), 32));
            fields.chain([(record.is_contact().into(), 1), ((!pair.is_valid(Query::SphereSphere)).into(), 1)]).collect()
        })
        .collect();
    let latency = unit.latency.expect("a pipeline");
    check(&format!("{} {contact}", unit.title()), &unit.module, forms, latency, &inputs, &wanted);
}

fn mixed(count: u64) -> Vec<PairRecord> {
    Set::Hard(count / 2).pairs(5).into_iter().chain(Set::Random(count - count / 2).pairs(5)).collect()
}

#[test]
fn operators_after_synthesis_give_the_twins_bits() {
    operator(Operator::Add, "e5f6", &[As::Printed, As::Gates], 600);
    operator(Operator::Mul, "e5f6", &[As::Ecp5], 600);
    operator(Operator::RootExceeds, "e5f6", &[As::Ecp5], 600);
}

/// Fractions of 31 bits have tables that fill block memories, in words of 18 bits.
#[test]
fn a_long_root_and_its_tables_in_the_blocks_of_a_target() {
    for root in [Operator::Sqrt, Operator::Recip] {
        operator(root, "e10f31zr", &[As::Blocks], 600);
    }
}

#[test]
fn an_scpu_after_synthesis_gives_the_reference_s_bits() {
    scpu("e6f3z", "hit,depth", &[As::Gates, As::Ecp5], &mixed(300));
}

/// No register without a reset affects an output: the SCPU of each profile, as printed.
#[test]
fn every_profile_in_four_states() {
    for profile in ["paper", "wide", "exact"] {
        scpu(profile, "hit,depth,normal,position", &[As::Printed], &mixed(100));
    }
}

/// Whatever the places of a delay line hold in the beginning, even beyond its last word, they come right within the
/// first 16 cycles: no reset reaches them. A place that does not follow the other one stays wrong.
#[test]
fn a_delay_line_comes_right_from_any_places() {
    const CYCLES: u32 = 6;
    let graph = Graph::new("line");
    graph.output("delayed", graph.input("value", 16).delay(CYCLES));
    let module = graph.finish().expect("a sound module");
    let words: Vec<Vector> = (1..40).map(|word| vec![(word, 16)]).collect();
    let wanted: Vec<String> = words.iter().map(simulate::bits).collect();
    let found = |newest: u32, oldest: u32, next: &str| {
        let files = verilog(&module, As::Printed)
            .spoilt("initial newest_of_6 = 3'd0;", &format!("initial newest_of_6 = 3'd{newest};"))
            .spoilt("initial oldest_of_6 = 3'd1;", &format!("initial oldest_of_6 = 3'd{oldest};"))
            .spoilt("newest_of_6 <= oldest_of_6;", next);
        simulate(&module, &files, CYCLES, &words)
    };
    for (newest, oldest) in (0..8).flat_map(|newest| (0..8).map(move |oldest| (newest, oldest))) {
        assert_eq!(found(newest, oldest, "newest_of_6 <= oldest_of_6;")[16..], wanted[16..], "{newest}, {oldest}");
    }
    let alone = "newest_of_6 <= (newest_of_6 == 3'd5) ? 3'd0 : (newest_of_6 + 3'd1);";
    assert_eq!(found(0, 1, alone), wanted);
    assert_ne!(found(0, 3, alone)[16..], wanted[16..]);
}

/// Copies of a register survive synthesis, and equal registers that are no copies become one.
#[test]
fn copies_of_a_register_are_kept() {
    let registers = |copies: bool| {
        let graph = Graph::new("steered");
        let (value, enable) = (graph.input("value", 8), graph.input("enable", 1));
        let steering = match copies {
            true => enable.copies("enable", 2),
            false => vec![enable.registered("enable_0"), enable.registered("enable_1")],
        };
        let halves = steering.iter().zip([0, 4]).map(|(enable, low)| {
            let half = graph.data_register(&format!("half_{low}"), 4);
            half.next_if(*enable, value.slice(low, 4));
            half.value()
        });
        graph.output("halves", Signal::join(&halves.collect::<Vec<_>>()));
        let module = graph.finish().expect("a sound module");
        let netlist = std::fs::read_to_string(&verilog(&module, As::Ecp5).files[0]).expect("the netlist");
        netlist.matches("TRELLIS_FF #(").count()
    };
    assert_eq!(registers(true), 8 + 2);
    assert_eq!(registers(false), 8 + 1);
}

/// Of a word that is read in the cycle in which it is written, the model of a block memory gives the wrong bits, as the
/// evaluator does. Elsewhere both give the word.
#[test]
fn a_read_that_meets_a_write_is_wrong_in_every_bit() {
    let search = Search { table: 2048, lanes: 16, deciders: 2, ..Search::default() };
    let (input, results, contact, shell) = (Input::Spheres, Results::Hits, Fields::HIT, Shell::Line);
    let config = Config { input, results, contact, shell, search, ..Config::default() };
    let afu = Afu::generate(Spec { delays: Target::Ecp5.delays(), ..Spec::from(config) }).expect("a search");
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    for (name, index_bits, bits) in [("line_memory_1024x18_ecp5", 10, 18), ("line_memory_128x36_ecp5", 7, 36)] {
        let memory = afu.top().hierarchy().into_iter().find(|module| module.name == name).expect(name);
        let graph = Graph::new("memory_that_reads_always");
        let always = graph.constant(1, 1);
        let widths = [("write", 1), ("write_index", index_bits), ("write_word", bits), ("read_index", index_bits)];
        let mut inputs = widths.map(|(name, width)| (name, graph.input(name, width))).to_vec();
        inputs.extend([("read", always), ("advance", always)]);
        graph.output("word", graph.instance("memory", &memory, &inputs).output("word"));
        let module = graph.finish().expect("a sound module");

        // Eight places in all of the memory, so that reads and writes meet.
        let mut place = || (random.random_range(0..8_u128) * 0x91) & ((1 << index_bits) - 1);
        let places: Vec<[u128; 2]> = (0..4000).map(|_| [place(), place()]).collect();
        let values = |&[to, from]: &[u128; 2]| {
            let word = u128::from(random.random::<u64>()) & ((1 << bits) - 1);
            vec![(u128::from(random.random::<bool>()), 1), (to, index_bits), (word, bits), (from, index_bits)]
        };
        let inputs: Vec<Vector> = places.iter().map(values).collect();
        let meets = |input: &&Vector| input[0].0 == 1 && input[1].0 == input[3].0;
        assert!((100..400).contains(&inputs.iter().filter(meets).count()));
        let mut run = Evaluator::new(&module, &[]).expect("it runs");
        let mut step = |input: &Vector| {
            widths.iter().zip(input).for_each(|((name, _), (value, _))| run.set(name, *value));
            run.step();
            vec![(run.get("word"), bits)]
        };
        let mut wanted: Vec<Vector> = inputs.iter().map(&mut step).skip(1).collect();
        wanted.push(step(&inputs[0]));
        check(name, &module, &[As::Blocks], 2, &inputs, &wanted);
    }
}

/// The comparison can fail: an inverted bit and an undriven one are detected.
#[test]
fn a_spoilt_netlist_is_found_out() {
    let profile: Profile = "e5f6".parse().expect("a profile");
    let unit =
        Unit::operator(Operator::AtMost, &profile, Values::Any, &DelayModel::default(), 200.0).expect("it can be cut");
    let latency = unit.latency.expect("a pipeline");
    let inputs: Vec<Vector> = (0..200_u128).map(|i| vec![((i * 37) & 0xFFF, 12), ((i * 91) & 0xFFF, 12)]).collect();
    let good = simulate(&unit.module, &verilog(&unit.module, As::Printed), latency, &inputs);
    for wrong in ["result <= 1'b1 ^ ", "result <= 1'bx ^ "] {
        let files = verilog(&unit.module, As::Printed).spoilt("result <= ", wrong);
        let found = simulate(&unit.module, &files, latency, &inputs);
        assert!(found.iter().zip(&good).all(|(found, good)| found != good), "{wrong}");
    }
    let twin = |a, b| Operator::AtMost.twin(profile.format(), a, b);
    assert!(inputs.iter().zip(&good).all(|(two, found)| *found == twin(two[0].0, two[1].0).to_string()));
}

/// Runs an SCPU of full width in Verilator and compares every bit with the reference.
fn verilated_scpu(profile: &str, form: As, pairs: &[PairRecord]) {
    let profile: Profile = profile.parse().expect("a profile");
    let config = Config { scpus: 1, profile, shell: Shell::Line, ..Config::default() };
    let unit = Unit::scpu_for(&config, Target::Ecp5).expect("it can be generated");
    let wanted = config.profile.reference(config.contact).run_all(pairs);
    let files = verilog(&unit.module, form);
    let found = verilated::scpu(&unit.module.name, &files, unit.latency.expect("a pipeline"), pairs);
    for ((pair, found), wanted) in pairs.iter().zip(&found).zip(&wanted) {
        let flags = (wanted.is_contact(), !pair.is_valid(Query::SphereSphere));
        assert_eq!(*found, (wanted.0, flags), "{}, of {pair:x?}", unit.title());
    }
    assert_eq!(found.len(), pairs.len());
    println!("{}: {} pairs", unit.title(), pairs.len());
}

fn corpus_and_mixed(count: u64) -> Vec<PairRecord> {
    let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/tb/corpus/hard.csv");
    let mut pairs = pairs::read_pairs(Query::SphereSphere, corpus.as_ref()).expect("the corpus");
    pairs.extend(mixed(count));
    pairs
}

/// With multipliers, look-up tables, long delays and carry chains in the blocks that `--target ecp5` instantiates.
#[test]
fn an_scpu_in_the_blocks_of_its_target() {
    verilated_scpu("wide", As::Blocks, &corpus_and_mixed(6000));
}

#[test]
#[ignore = "minutes: SCPUs of full width through Yosys and Verilator"]
fn every_profile_after_synthesis() {
    for profile in ["paper", "wide", "exact"] {
        verilated_scpu(profile, As::Ecp5Apart, &corpus_and_mixed(6000));
    }
}
