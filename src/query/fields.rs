//! The fields of a contact that are asked for.

use std::fmt;
use std::str::FromStr;

/// The fields of a contact to compute. The hit itself is always computed. Fields that are not asked for have no
/// hardware and no words in memory; in a [`super::ContactRecord`] their words are zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Fields {
    /// The penetration depth.
    pub depth: bool,
    /// The unit normal from body 2 to body 1.
    pub normal: bool,
    /// The point of contact.
    pub position: bool,
}

impl Fields {
    /// Every field.
    pub const ALL: Self = Self { depth: true, normal: true, position: true };
    /// The hit only.
    pub const HIT: Self = Self { depth: false, normal: false, position: false };

    /// True if the distance itself is needed, and so a square root. The hit is decided without one.
    pub const fn need_distance(self) -> bool {
        self.depth || self.normal || self.position
    }
}

impl Default for Fields {
    fn default() -> Self {
        Self::ALL
    }
}

impl fmt::Display for Fields {
    /// Writes the fields as in `hit,depth,normal,position`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("hit")?;
        for (asked, name) in [(self.depth, "depth"), (self.normal, "normal"), (self.position, "position")] {
            if asked {
                write!(f, ",{name}")?;
            }
        }
        Ok(())
    }
}

/// A list with an unknown field name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown contact field `{0}`: list some of hit,depth,normal,position")]
pub struct FieldsError(String);

impl FromStr for Fields {
    type Err = FieldsError;

    /// Reads names in any order, separated by commas; `hit` may be left out.
    fn from_str(text: &str) -> Result<Self, FieldsError> {
        let mut fields = Self::HIT;
        for name in text.split(',').map(str::trim) {
            match name {
                "hit" => {}
                "depth" => fields.depth = true,
                "normal" => fields.normal = true,
                "position" => fields.position = true,
                _ => return Err(FieldsError(name.to_owned())),
            }
        }
        Ok(fields)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_read_what_they_write() {
        for bits in 0..8 {
            let fields = Fields { depth: bits & 1 != 0, normal: bits & 2 != 0, position: bits & 4 != 0 };
            assert_eq!(fields.to_string().parse(), Ok(fields));
        }
        assert_eq!("position, depth".parse(), Ok(Fields { depth: true, normal: false, position: true }));
        assert_eq!("hit,mass".parse::<Fields>(), Err(FieldsError("mass".into())));
        assert!("".parse::<Fields>().is_err());
    }
}
