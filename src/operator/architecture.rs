//! Ways to the same bits.

use serde::{Deserialize, Serialize};

use super::{Domain, Operator, corrected};
use crate::hdl::DelayModel;

/// The architecture of correctly rounded roots and reciprocals. It does not change any bit of their results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Architecture {
    /// A table of parabolas and a correcting step, in multiplier blocks: the fewest cycles. Where there is none, as for
    /// subnormals, [`Architecture::Recurrence`].
    Table,
    /// A carry chain a digit: no multiplier block.
    Recurrence,
}

impl Architecture {
    /// The one for a target: the table where there are multiplier blocks with registers, unless they are to be spared.
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

    /// Whether the operator has it for these values. Every operator has that of the recurrence, whatever it is made of.
    pub fn is_possible(self, operator: Operator, domain: impl Into<Domain>) -> bool {
        self == Self::Recurrence || corrected::is_possible(operator, domain.into())
    }
}
