//! The whole AFU as synthesis for an ECP5 reads it: lines, look-up tables, products and chains in the target's
//! primitives, simulated by the models in `tb/`.

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Results};
use contact_afu::cosim::{File, Job, Model, Source, Trace};
use contact_afu::synth::Target;

use crate::bench::{Case, config, driver, with_scpus};
use crate::primitives::primitives;

fn files_in_primitives(config: &Config) -> Vec<File> {
    let afu = Afu::generate(Spec { delays: Target::Ecp5.delays(), ..Spec::from(config.clone()) }).unwrap();
    afu.verilog().into_iter().map(|(name, text)| File { name, text }).collect()
}

fn model(config: &Config, own: Vec<File>) -> Model {
    let first = File { name: "primitives.v".to_owned(), text: primitives() };
    let source = Source::new("contact_afu", std::iter::once(first).chain(own).collect());
    Model::build(&with_scpus(source, config), Trace::Off).unwrap()
}

fn model_in_primitives(config: &Config) -> Model {
    let own = files_in_primitives(config);
    let lines = own.iter().filter(|file| file.name.starts_with("line_memory") && file.text.contains("DP16KD")).count();
    // Of 36 bits and the rest of 512. If all come back, the dispatcher holds as many lines as the collector.
    let expected = if config.results == Results::All { 2 } else { 4 };
    assert_eq!(lines, expected, "the collector's lines and the dispatcher's");
    model(config, own)
}

/// Behind deciders, the numbers of hits wait in a block memory while their contacts are computed.
#[test]
fn numbers_wait_in_a_block_memory() {
    let config = Config { results: Results::Hits, decide: 1, interval: 4, ..config(1, "e8f3z", "depth") };
    let own = files_in_primitives(&config);
    let resolver = own.iter().find(|file| file.name == "contact_afu_resolver.v").unwrap();
    assert!(resolver.text.contains("x32_ecp5 number_waits"), "{}", resolver.text);
    let model = model(&config, own);
    let case = Case::random(&config, 1_501, 3);
    for (link, seed) in [("ideal", 1), ("hostile", 2)] {
        let afu = model.instance(seed).unwrap();
        case.check(&driver(&afu, link, seed).run(&case.job()).unwrap(), link);
    }
}

/// Uses links that keep lines waiting in the memories: out-of-order reads, and writes that stall.
#[test]
fn lines_in_block_memories_come_back_whole() {
    for results in [Results::All, Results::Hits] {
        let config = Config { results, ..config(2, "e8f3z", "depth") };
        let model = model_in_primitives(&config);
        let case = Case::random(&config, 1_501, 3);
        for (link, seed) in [("ideal", 1), ("shuffled", 2), ("hostile", 3)] {
            let afu = model.instance(seed).unwrap();
            let mut driver = driver(&afu, link, seed);
            case.check(&driver.run(&case.job()).unwrap(), link);
            let again = Job { destination_address: 1 << 41, ..case.job() };
            case.check(&driver.run(&again).unwrap(), link);
        }
    }
}
