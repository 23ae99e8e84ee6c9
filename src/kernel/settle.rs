//! How the host resolves pairs that the kernel of the profile `exact` leaves unsettled.

use super::Truth;
use crate::query::{ContactRecord, Fields, PairRecord};

/// Replaces the unsettled records among the `contacts` of `pairs` by the correctly rounded truth, and returns their
/// number. Fields that are not asked for are zero.
pub fn settle(pairs: &[PairRecord], contacts: &mut [ContactRecord], fields: Fields) -> u64 {
    let mut count = 0;
    for (pair, contact) in pairs.iter().zip(contacts) {
        if contact.is_unsettled() {
            *contact = Truth::of(pair).record().only(fields);
            count += 1;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Reference;
    use crate::query::Flow;

    #[test]
    fn the_unsettled_are_settled_and_the_others_left_alone() {
        // Two pairs that no window decides: on both sides of "1 and a little more", a contact 2^-141 deep.
        let tiny = f32::from_bits(1 << 8);
        let pair = PairRecord::from_spheres([1.0, 0.0, 0.0, 1.0], [-tiny, 0.0, 0.0, 2.0 * tiny]);
        let plain = PairRecord::from_spheres([1.0, 0.0, 0.0, 0.5], [0.0, 0.0, 0.0, 1.0]);
        let reference = Reference::exact(Fields::ALL);
        assert_eq!(reference.run(&pair), ContactRecord::UNSETTLED);
        let (contacts, unsettled) = reference.settled(&[plain, pair, plain]);
        assert_eq!((unsettled, contacts[0]), (1, contacts[2]));
        assert_eq!((contacts[0].depth(), contacts[0].normal()), (0.5, [1.0, 0.0, 0.0]));
        assert_eq!((contacts[1].flow(), contacts[1].depth()), (Some(Flow::Real), tiny));

        let fields = Fields { normal: true, ..Fields::HIT };
        let mut contacts = [ContactRecord::UNSETTLED];
        assert_eq!(settle(&[pair], &mut contacts, fields), 1);
        assert_eq!(contacts[0].0, [0, 0, 0, 1.0_f32.to_bits(), 0, 0, 0, Flow::Real.flags()]);
    }
}
