//! Records of every size: the selected fields decide where words lie and how many lines there are.

use contact_afu::link::LinkModel;
use contact_afu::query::Fields;

use crate::bench::{Case, config, driver, generated};

/// Bits per record, which decide how many records share a line.
fn record_bits(fields: Fields) -> u64 {
    match (fields.position, fields.normal, fields.depth) {
        (false, false, false) => 1,
        (false, false, true) => 64,
        (true, true, _) => 256,
        (true, false, true) | (false, true, true) => 256,
        (true, false, false) | (false, true, false) => 128,
    }
}

fn every_count_about_a_line(fields: Fields, profile: &str, scpus: u32) {
    let config = config(scpus, profile, &fields.to_string());
    let model = generated(&config);
    let per_line = 512 / record_bits(fields);
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let mut driver = driver(&afu, link, seed);
        let fields_bit = afu.output("capability", 64).unwrap().get() >> 16 & 0xf;
        let expected = [true, fields.depth, fields.normal, fields.position];
        assert_eq!([0, 1, 2, 3].map(|bit| fields_bit >> bit & 1 == 1), expected, "the AFU says what it gives");
        for count in [0, 1, per_line - 1, per_line, per_line + 1, 3 * per_line - 1, 401] {
            let case = Case::random(&config, count, count + 3);
            assert_eq!(case.lines.len() as u64, count.div_ceil(per_line));
            let what = format!("{fields} in {profile}, {link}, {count} pairs");
            // The driver returns an error if any other line is written.
            let outcome = driver.run(&case.job()).unwrap_or_else(|e| panic!("{what}: {e}"));
            case.check(&outcome, &what);
        }
    }
}

/// All but the full record, which every other test covers.
#[test]
fn every_subset_of_fields() {
    for mask in 1..7 {
        let fields = Fields { depth: mask & 1 != 0, normal: mask & 2 != 0, position: mask & 4 != 0 };
        every_count_about_a_line(fields, "e8f3z", 3);
    }
}

#[test]
fn one_bit_records() {
    every_count_about_a_line(Fields::HIT, "wide", 2);
}
