//! The sites of blocks on the devices that are routed for, as nextpnr names them.

use super::Target;

/// The blocks of one kind.
pub(super) struct Kind {
    /// The type of their cells.
    pub cell: &'static str,
    /// Where they may stand.
    pub sites: Vec<Site>,
}

/// A place for a block.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Site {
    /// Column and row of its tile.
    pub at: [f64; 2],
    /// nextpnr's name.
    pub name: String,
}

/// The kinds of blocks of the family's device.
pub(super) fn kinds(target: Target) -> Vec<Kind> {
    match target {
        Target::Ecp5 => vec![
            Kind {
                cell: "MULT18X18D",
                sites: lfe5u_85f(&[10, 34, 58], &[(0, "MULT18_0"), (1, "MULT18_1"), (4, "MULT18_4"), (5, "MULT18_5")]),
            },
            Kind {
                cell: "DP16KD",
                sites: lfe5u_85f(&[22, 46, 70, 82], &[(0, "EBR0"), (2, "EBR1"), (4, "EBR2"), (6, "EBR3")]),
            },
        ],
        Target::Ice40 | Target::Cyclonev | Target::Xilinx => Vec::new(),
    }
}

/// Thirteen groups of nine columns in each of these rows, from column 4 on. Each group has these sites, by their
/// columns. Two columns of something else stand before the eighth group.
fn lfe5u_85f(rows: &[u32], of_group: &[(u32, &str)]) -> Vec<Site> {
    let mut sites = Vec::new();
    for row in rows {
        for group in 0..13 {
            for (column, name) in of_group {
                let column = 4 + 9 * group + if group < 7 { 0 } else { 2 } + column;
                sites.push(Site { at: [f64::from(column), f64::from(*row)], name: format!("X{column}/Y{row}/{name}") });
            }
        }
    }
    sites
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_device_has_as_many_as_its_data_sheet_says() {
        let capacity = Target::Ecp5.capacity().unwrap_or_default();
        let number = |cell: &str| {
            let kind = kinds(Target::Ecp5).into_iter().find(|kind| kind.cell == cell);
            kind.map_or(0, |kind| kind.sites.len() as u64)
        };
        assert_eq!((number("MULT18X18D"), number("DP16KD")), (capacity.dsps, capacity.brams));
    }
}
