//! Architectures that compute the same bits.

use serde::{Deserialize, Serialize};

use super::{Domain, Operator, corrected};
use crate::hdl::DelayModel;

/// The architecture of correctly rounded roots and reciprocals. It does not change any bit of their results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Architecture {
    /// A table of parabolas and a correcting step, in multiplier blocks: the fewest cycles. If it does not exist, as
    /// for subnormals, it is [`Architecture::Recurrence`].
    Table,
    /// One carry chain per digit, and no multiplier block.
    Recurrence,
}

impl Architecture {
    /// The architecture for a target: the table if it has multiplier blocks with registers, unless they should be
    /// saved.
    pub fn of(model: &DelayModel) -> Self {
        if model.multiplier_registers > 0 && !model.spares_multipliers { Self::Table } else { Self::Recurrence }
    }

    /// The name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Table => "table",
            Self::Recurrence => "recurrence",
        }
    }

    /// True if the operator has this architecture for these values. Every operator counts as having the recurrence.
    pub fn is_possible(self, operator: Operator, domain: impl Into<Domain>) -> bool {
        self == Self::Recurrence || corrected::is_possible(operator, domain.into())
    }
}
