//! The whole AFU as synthesis for an ECP5 reads it: lines, look-up tables, products and chains in the target's
//! primitives, simulated by the models in `tb/`.

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Results};
use contact_afu::cosim::{File, Job, Model, Source, Trace};
use contact_afu::synth::Target;

use crate::bench::{Case, config, driver};
use crate::primitives::primitives;

fn model_in_primitives(config: &Config) -> Model {
    let first = File { name: "primitives.v".to_owned(), text: primitives() };
    let afu = Afu::generate(Spec { delays: Target::Ecp5.delays(), ..Spec::from(config.clone()) }).unwrap();
    let own: Vec<File> = afu.verilog().into_iter().map(|(name, text)| File { name, text }).collect();
    let lines = own.iter().filter(|file| file.name.starts_with("line_memory") && file.text.contains("DP16KD")).count();
    // Of 36 bits and the rest of 512. If all come back, the dispatcher holds as many lines as the collector.
    let expected = if config.results == Results::All { 2 } else { 4 };
    assert_eq!(lines, expected, "the collector's lines and the dispatcher's");
    let source = Source::new("contact_afu", std::iter::once(first).chain(own).collect());
    Model::build(&source.parameter("SCPUS", config.scpus.into()), Trace::Off).unwrap()
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
