//! The profile `exact` as hardware: the Verilated AFU leaves exactly those pairs to the host that it cannot decide.

use contact_afu::config::{Config, Profile};
use contact_afu::kernel::Truth;
use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::query::{Flow, PairRecord};
use contact_afu::verify::Bench;

#[test]
fn the_afu_is_the_reference_and_the_host_settles_the_rest() {
    let config = Config { scpus: 1, profile: Profile::EXACT, ..Config::default() };
    let bench = Bench::new(&config).expect("a model");

    // Hard pairs with invalid ones between them, which must not affect their neighbours.
    let hard = Set::Hard(3_400).pairs(8);
    let invalid = PairRecord([0x7F80_0000, 0, 0x7FC0_0001, 0x8000_0001, 0xFF80_0000, 0, 0, 0x3F80_0000]);
    let mixed: Vec<_> = hard.chunks(3).flat_map(|some| some.iter().copied().chain([invalid])).collect();

    let alone = bench.run(&hard, &LinkModel::hostile(), 5).expect("a job");
    assert!(alone.is_good(), "{:?} {:?}", alone.mismatches.first(), alone.failed_checks);
    assert!(alone.unsettled > 100, "{} unsettled", alone.unsettled);
    for (pair, contact) in hard.iter().zip(&alone.contacts) {
        let truth = Truth::of(pair);
        assert_eq!(contact.flow(), Some(truth.flow()), "{pair:?}");
        assert!(truth.errors(*contact).is_none_or(|errors| errors.largest() <= 1.0), "{pair:?}: {contact:?}");
    }

    let together = bench.run(&mixed, &LinkModel::hostile(), 6).expect("a job");
    assert!(together.is_good(), "{:?} {:?}", together.mismatches.first(), together.failed_checks);
    let valid: Vec<_> = together.contacts.into_iter().filter(|c| c.flow() != Some(Flow::Invalid)).collect();
    assert_eq!(valid, alone.contacts);
    assert_eq!(together.unsettled, alone.unsettled);
}
