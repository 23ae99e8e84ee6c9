//! All combinations of numbers of SCPUs, counts of pairs and links.

use std::thread;

use contact_afu::cosim::Model;
use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::query::Fields;

use crate::bench::{Case, committed, config, driver, full_rate, generated, of};

/// Runs the cases over every preset, one after another on an AFU that is never reset between them.
fn over_every_link(model: &Model, cases: &[Case], what: &str) {
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let mut driver = driver(&afu, link, seed);
        for case in cases {
            let outcome = driver.run(&case.job()).unwrap_or_else(|e| panic!("{what}, {link}: {e}"));
            case.check(&outcome, &format!("{what}, {link}, {} pairs", case.pairs.len()));
        }
    }
}

#[test]
fn every_word_for_every_number_of_scpus_over_every_link() {
    let mut cases: Vec<Case> =
        [0, 1, 2, 3, 177].into_iter().map(|count| Case::random(&of(1), count, count + 5)).collect();
    cases.insert(3, Case::new(&of(1), Set::Diamond(10).pairs(0)));
    assert_eq!(cases[3].pairs.len(), 12_354);
    // Splits about equal work over two threads: simulation time grows with the number of SCPUs.
    thread::scope(|scope| {
        for numbers in [[1, 7, 10], [2, 3, 16]] {
            let cases = &cases;
            scope.spawn(move || {
                for scpus in numbers {
                    over_every_link(&full_rate(scpus), cases, &format!("{scpus} SCPUs"));
                }
            });
        }
    });
}

/// The largest number of SCPUs: turns and lanes at the end of their range.
#[test]
fn sixty_four_scpus() {
    let cases = [0, 1, 63, 64, 65, 1_001].map(|count| Case::random(&of(64), count, count));
    over_every_link(&committed(64), &cases, "64 SCPUs");
}

#[test]
fn a_hundred_thousand_pairs() {
    let model = committed(10);
    let case = Case::random(&of(10), 100_000, 1);
    let afu = model.instance(1).unwrap();
    let outcome = driver(&afu, "ideal", 1).run(&case.job()).unwrap();
    case.check(&outcome, "random:100000");
}

/// IEEE binary32 in every operation, with subnormals, infinities and NaN.
#[test]
fn the_paper_s_arithmetic() {
    let config = config(2, "paper", &Fields::ALL.to_string());
    let cases = [Case::random(&config, 3_001, 11), Case::new(&config, Set::Diamond(4).pairs(0))];
    over_every_link(&generated(&config), &cases, "paper");
}
