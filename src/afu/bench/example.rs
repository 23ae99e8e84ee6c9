//! The job that a test bench runs by itself.

use crate::afu::Afu;
use crate::config::Input;
use crate::query::{Flow, PairRecord};
use crate::record::{Line, pack, pack_contacts, pack_hits, pack_spheres, unpack_pairs};
use crate::spheres::{Search, Sphere};

/// Spheres of which some touch, with an invalid one, in more than one row.
const SPHERES: [[f32; 4]; 20] = {
    let mut spheres = [[0.0, 0.0, 0.0, 0.5]; 20];
    let mut place = 0;
    while place < 20 {
        spheres[place] = [0.75 * (place % 5) as f32, 0.75 * (place / 5) as f32, 0.0, 0.4];
        place += 1;
    }
    spheres[3] = [f32::NAN, 0.0, 0.0, 0.5];
    spheres[12] = [1.5, 0.75, 2.0, 3.0];
    spheres
};

/// A job with what must come of it.
pub(super) struct Example {
    pub(super) source: Vec<Line>,
    pub(super) expected: Vec<Line>,
    /// Pairs or spheres.
    pub(super) count: usize,
    pub(super) contacts: usize,
    /// Pairs of spheres whose boxes meet; 0 if pairs come in.
    pub(super) candidates: u64,
    pub(super) invalid: usize,
    pub(super) first_invalid: Option<usize>,
    /// The number of the last source line of another job, from its `count`, in Verilog.
    pub(super) last_line: String,
}

impl Example {
    pub(super) fn of(afu: &Afu) -> Self {
        match afu.spec().config.input {
            Input::Direct => Self::of_pairs(afu),
            Input::Spheres => Self::of_spheres(afu),
        }
    }

    fn of_pairs(afu: &Afu) -> Self {
        let (config, layout) = (&afu.spec().config, afu.layout());
        let examples = config.query.shape().examples.iter();
        let pairs: Vec<_> = examples.map(|values| PairRecord::of_values(values.iter().copied())).collect();
        let source = pack(&layout, &pairs);
        // As the AFU reads them: rounded to the record format, with the hardware's radius.
        let records = config.reference().run_all(&unpack_pairs(&layout, &source, pairs.len()));
        let invalid: Vec<usize> = (0..records.len()).filter(|&i| records[i].flow() == Some(Flow::Invalid)).collect();
        Self {
            expected: pack_contacts(&layout, &records),
            source,
            count: pairs.len(),
            contacts: records.iter().filter(|record| record.is_contact()).count(),
            candidates: 0,
            invalid: invalid.len(),
            first_invalid: invalid.first().copied(),
            last_line: format!("(count - 1) / {}", layout.pairs_per_line()),
        }
    }

    fn of_spheres(afu: &Afu) -> Self {
        let config = &afu.spec().config;
        let spheres = SPHERES.map(Sphere::new);
        // A configuration that is generated has a search, and the reference decides every pair.
        let search = Search::new(config.profile.arithmetic(), config.search.box_bits);
        let found = search.map(|search| search.find(&mut config.reference(), &spheres, None));
        let found = found.map(Result::unwrap_or_default).unwrap_or_default();
        Self {
            source: pack_spheres(&spheres),
            expected: pack_hits(&afu.layout(), &found.hits),
            count: spheres.len(),
            contacts: found.hits.len(),
            candidates: found.counts.candidates,
            invalid: spheres.iter().filter(|sphere| !sphere.is_valid()).count(),
            first_invalid: spheres.iter().position(|sphere| !sphere.is_valid()),
            last_line: "(count + 15) / 16 * 4 - 1".to_owned(),
        }
    }
}
