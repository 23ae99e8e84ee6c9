//! A contact as words: one order for every query.

use super::{Fields, Flow, PairRecord};

/// A group of numbers that an option asks for together.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// The name in options.
    pub name: &'static str,
    /// True if the group is among these fields.
    pub is_asked: fn(Fields) -> bool,
    /// The names of the words in files and hardware.
    pub words: &'static [&'static str],
    /// The meaning, for documentation.
    pub meaning: &'static str,
}

/// The groups of a contact's numbers, in the order of its record.
pub const GROUPS: [Group; 3] = [
    Group {
        name: "position",
        is_asked: |fields| fields.position,
        words: &["pos_x", "pos_y", "pos_z"],
        meaning: "contact position",
    },
    Group {
        name: "normal",
        is_asked: |fields| fields.normal,
        words: &["normal_x", "normal_y", "normal_z"],
        meaning: "contact normal",
    },
    Group { name: "depth", is_asked: |fields| fields.depth, words: &["depth"], meaning: "penetration depth" },
];

/// The number of numbers in a contact.
pub const NUMBERS: usize = GROUPS[0].words.len() + GROUPS[1].words.len() + GROUPS[2].words.len();
/// The index of the word after them: the [flags](Flow::flags).
pub const FLAGS: usize = NUMBERS;

/// The index of the depth.
pub const DEPTH: usize = NUMBERS - 1;
/// The number of words in a contact.
pub const CONTACT_WORDS: usize = NUMBERS + 1;

/// A contact: position x y z, normal x y z, depth, flags.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct ContactRecord(pub [u32; CONTACT_WORDS]);

impl ContactRecord {
    /// Bit 4 of the flags and nothing else: the profile `exact` writes this record for a pair that it cannot decide in
    /// its window. The host replaces it with the contact before anyone reads it.
    pub const UNSETTLED: Self = Self::of_flags(16);

    /// The names of its words, in order.
    pub const NAMES: [&'static str; CONTACT_WORDS] = {
        let mut names = ["flags"; CONTACT_WORDS];
        let (mut word, mut group) = (0, 0);
        while group < GROUPS.len() {
            let mut i = 0;
            while i < GROUPS[group].words.len() {
                names[word] = GROUPS[group].words[i];
                (word, i) = (word + 1, i + 1);
            }
            group += 1;
        }
        names
    };

    /// The indices of the words in the record of these fields, in order. With only the hit there are none: that record
    /// is one bit.
    pub fn words(fields: Fields) -> impl Iterator<Item = usize> {
        let asked = GROUPS.iter().flat_map(move |group| group.words.iter().map(move |_| (group.is_asked)(fields)));
        asked.chain([fields != Fields::HIT]).enumerate().filter(|(_, asked)| *asked).map(|(word, _)| word)
    }

    /// The record with these flags, whose numbers are zero.
    pub const fn of_flags(flags: u32) -> Self {
        let mut words = [0; CONTACT_WORDS];
        words[FLAGS] = flags;
        Self(words)
    }

    /// The record in which the words that are not asked for are zero.
    #[must_use]
    pub fn only(self, fields: Fields) -> Self {
        let mut record = Self::of_flags(self.flags());
        Self::words(fields).for_each(|word| record.0[word] = self.0[word]);
        record
    }

    /// True if the pair is unsettled: this is not yet a contact.
    pub const fn is_unsettled(self) -> bool {
        self.flags() & 16 != 0
    }

    /// The flags word: see [`Flow::flags`].
    pub const fn flags(self) -> u32 {
        self.0[FLAGS]
    }

    /// True if the pair touches.
    pub const fn is_contact(self) -> bool {
        self.flags() & 1 == 1
    }

    /// The outcome of the pair; `None` if no kernel writes these flags.
    pub fn flow(self) -> Option<Flow> {
        Flow::ALL.into_iter().find(|flow| flow.flags() == self.flags())
    }

    /// The numbers, in order: position, normal, depth.
    pub fn numbers(self) -> [f32; NUMBERS] {
        std::array::from_fn(|word| f32::from_bits(self.0[word]))
    }

    /// This record with the centre of the pair's first sphere as its position. In every query a pair begins with that
    /// centre, and a contact with its position.
    pub(crate) fn at_first_centre(mut self, pair: &PairRecord) -> Self {
        self.0[..3].copy_from_slice(&pair.0[..3]);
        self
    }

    /// The point of contact.
    pub fn position(self) -> [f32; 3] {
        let [x, y, z, ..] = self.numbers();
        [x, y, z]
    }

    /// The unit normal, pointing into the first body.
    pub fn normal(self) -> [f32; 3] {
        let [_, _, _, x, y, z, _] = self.numbers();
        [x, y, z]
    }

    /// The penetration depth, a length.
    pub fn depth(self) -> f32 {
        let [.., depth] = self.numbers();
        depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_are_those_of_the_design() {
        assert_eq!(Flow::ALL.map(Flow::flags), [8, 2, 5, 7]);
        for flow in Flow::ALL {
            let record = ContactRecord::of_flags(flow.flags());
            assert_eq!(record.flow(), Some(flow));
            assert_eq!((record.is_contact(), record.is_contact()), (flow.is_contact(), flow >= Flow::Coincident));
        }
        assert_eq!(ContactRecord::default().flow(), None);
    }

    #[test]
    fn words_are_those_of_the_fields() {
        let names = ["pos_x", "pos_y", "pos_z", "normal_x", "normal_y", "normal_z", "depth", "flags"];
        assert_eq!(ContactRecord::NAMES, names);
        let of = |fields: &str| ContactRecord::words(fields.parse().expect("fields")).collect::<Vec<_>>();
        assert!(of("hit").is_empty());
        assert_eq!(of("depth"), [6, 7]);
        assert_eq!(of("normal"), [3, 4, 5, 7]);
        assert_eq!(of("position,depth"), [0, 1, 2, 6, 7]);
        let record = ContactRecord([1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(record.only("normal".parse().expect("fields")).0, [0, 0, 0, 4, 5, 6, 0, 8]);
        assert_eq!(record.only(Fields::HIT), ContactRecord::of_flags(8));
    }
}
