//! Tables of constants.

use std::panic::Location;

use super::module::Op;
use super::signal::Signal;

impl Signal<'_> {
    /// The word of a table at the index that this value gives; each word has `width` bits. This is a case statement and
    /// logic, because a memory would have to be read one cycle ahead. At most 12 bits of index.
    #[track_caller]
    pub(crate) fn lookup(self, table: &[u128], width: u32) -> Self {
        let place = Location::caller();
        let Some(ids) = self.graph().own("lookup", &[self], place) else { return Self::poison(self.graph()) };
        let index = self.width();
        let fits = width > 0 && table.iter().all(|word| width >= 128 || word >> width == 0);
        if index > 12 || table.len() != 1 << index || !fits {
            let words = table.len();
            self.graph().error(format!("lookup: {words} words of {width} bits by an index of {index} bits"), place);
            return Self::poison(self.graph());
        }
        self.graph().shared(Op::Lookup(table.into()), width, ids, place)
    }
}
