use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::query::{Flow, PairRecord, Query};

/// Makes a pair invalid in one field: NaN (quiet, signalling, negative), infinity or a negative radius.
fn invalid(number: usize, pair: PairRecord) -> PairRecord {
    const WORDS: [u32; 5] = [0x7FC0_0000, 0x7F80_0001, 0xFFFF_FFFF, 0x7F80_0000, 0xFF80_0000];
    const RADII: [u32; 7] = [WORDS[0], WORDS[1], WORDS[2], WORDS[3], WORDS[4], 0x8000_0001, 0xBF80_0000];
    let mut words = pair.0;
    let field = number % 8;
    words[field] = if field % 4 == 3 { RADII[number / 8 % 7] } else { WORDS[number / 8 % 5] };
    if number.is_multiple_of(5) {
        // A second invalid field.
        words[(field + 3) % 8] = 0xFFC0_0001;
    }
    PairRecord(words)
}

/// Runs a job of valid pairs, and one with runs of up to five invalid pairs between them. The valid pairs have the same
/// results in both jobs. Each invalid pair is reported as such, and its numbers are zero.
#[test]
fn an_invalid_pair_has_no_effect_on_its_neighbours() {
    let valid: Vec<PairRecord> = Set::Hard(1_400)
        .pairs(8)
        .into_iter()
        .chain(Set::Random(1_400).pairs(8))
        .filter(|pair| pair.is_valid(Query::SphereSphere))
        .collect();
    let mut mixed = Vec::new();
    let mut spoilt = 0;
    for (number, &pair) in valid.iter().enumerate() {
        for _ in 0..(number * 7 + number / 11) % 6 {
            mixed.push(invalid(spoilt, pair));
            spoilt += 1;
        }
        mixed.push(pair);
    }
    assert!(spoilt > 5_000 && mixed.iter().filter(|pair| !pair.is_valid(Query::SphereSphere)).count() == spoilt);
    let first = mixed.iter().position(|pair| !pair.is_valid(Query::SphereSphere)).map(|number| number as u32);

    for (name, bench) in super::benches() {
        let alone = bench.run(&valid, &LinkModel::hostile(), 5).expect("a job");
        let together = bench.run(&mixed, &LinkModel::hostile(), 6).expect("a job");
        for job in [&alone, &together] {
            assert!(job.is_good(), "{name}: {:?} {:?}", job.mismatches.first(), job.failed_checks);
        }
        assert_eq!((alone.outcome.invalid, alone.outcome.first_invalid), (0, None), "{name}");
        assert_eq!((together.outcome.invalid, together.outcome.first_invalid), (spoilt as u32, first), "{name}");
        let (told, kept): (Vec<_>, Vec<_>) =
            mixed.iter().zip(&together.contacts).partition(|(pair, _)| !pair.is_valid(Query::SphereSphere));
        assert!(told.iter().all(|(_, contact)| contact.0 == [0, 0, 0, 0, 0, 0, 0, Flow::Invalid.flags()]), "{name}");
        let kept: Vec<_> = kept.into_iter().map(|(_, contact)| *contact).collect();
        assert!(kept == alone.contacts, "{name}: a neighbour differs");
        assert_eq!(together.unsettled, alone.unsettled, "{name}");
    }
}
