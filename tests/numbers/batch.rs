//! The batch kernel gives the reference's bits on every instruction set of this processor.

use contact_afu::kernel::Reference;
use contact_afu::kernel::batch::{Batch, Level};
use contact_afu::number::Format;
use contact_afu::pairs::Set;
use contact_afu::query::{ContactRecord, Fields, PairRecord};

fn check(pairs: &[PairRecord], fields: Fields) {
    let expected = Reference::new(Format::BINARY32, fields).run_all(pairs);
    let batch = Batch::from_pairs(pairs);
    for level in Level::available() {
        let mut contacts = Batch::zeros(pairs.len());
        level.run(&batch, &mut contacts, fields);
        assert_eq!(contacts.len(), pairs.len());
        for (i, (found, expected)) in contacts.contacts().zip(&expected).enumerate() {
            assert_eq!(found, *expected, "{}, {fields}, pair {i}: {:x?}", level.name(), pairs[i]);
        }
    }
}

#[test]
fn every_level_and_field_on_random_pairs() {
    let pairs = Set::Random(200_000).pairs(6);
    for bits in 0..8 {
        check(&pairs, Fields { depth: bits & 1 != 0, normal: bits & 2 != 0, position: bits & 4 != 0 });
    }
}

#[test]
fn every_level_on_the_diamond() {
    check(&Set::Diamond(10).pairs(0), Fields::ALL);
}

#[test]
fn batches_of_any_length() {
    for count in [0, 1, 2, 63, 64, 65, 1000] {
        check(&Set::Random(count).pairs(7), Fields::ALL);
    }
}

#[test]
fn a_batch_leaves_nothing_of_an_earlier_one() {
    let pairs = Set::Random(100).pairs(8);
    let mut contacts = Batch::zeros(pairs.len());
    let level = Level::best();
    level.run(&Batch::from_pairs(&pairs), &mut contacts, Fields::ALL);
    level.run(&Batch::from_pairs(&pairs), &mut contacts, Fields::HIT);
    let expected = Reference::new(Format::BINARY32, Fields::HIT).run_all(&pairs);
    assert_eq!(contacts.contacts().collect::<Vec<ContactRecord>>(), expected);
}
