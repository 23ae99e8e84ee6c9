//! Turns sums of converted numbers into sums that convert, so that a conversion that nothing else needs is not built.

use super::kernel::{Kernel, Source, ValueId};
use crate::number::Format;
use crate::operator::{Operator, is_direct};

impl Kernel {
    /// The same kernel with sums directly from the unconverted numbers, if a sum can convert them
    /// ([`Operator::WideningAdd`]).
    ///
    /// Not for shared operators, because there one converter serves all, and one more adder is expensive.
    pub(super) fn with_widening_sums(&self) -> Self {
        let mut kernel = self.clone();
        for index in 0..kernel.values.len() {
            let Source::Operator(operator, to) = kernel.values[index].source else { continue };
            let widening = match operator {
                Operator::Add => Operator::WideningAdd { to },
                Operator::Sub => Operator::WideningSub { to },
                _ => continue,
            };
            let converted: Option<Vec<(ValueId, Format)>> =
                kernel.values[index].operands.iter().map(|id| self.converted(*id)).collect();
            if let Some(&[(a, from), (b, other)]) = converted.as_deref()
                && from == other
                && is_direct(from, to)
            {
                let value = &mut kernel.values[index];
                value.source = Source::Operator(widening, from);
                value.operands = vec![a, b];
            }
        }
        kernel
    }

    /// The source of a converted value, and its format.
    fn converted(&self, id: ValueId) -> Option<(ValueId, Format)> {
        match (self.value(id).source, self.value(id).operands.as_slice()) {
            (Source::Operator(Operator::Convert { .. }, from), &[whole]) => Some((whole, from)),
            _ => None,
        }
    }
}
