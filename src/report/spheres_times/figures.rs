//! The pictures: time per sphere over the number of spheres. Solid lines are measured, dashed ones are simulated.

use super::{Row, Simulated, Times};
use crate::plot::{Axis, Line, Marker, Plot, Scale, Series};

/// Sets that differ in their number of spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    /// The paper's diamond.
    Diamond,
    /// A gas that fills 0.3 of its cube.
    Gas,
}

impl Family {
    pub(super) const ALL: [Self; 2] = [Self::Diamond, Self::Gas];

    /// The file of the picture.
    pub(super) const fn file(self) -> &'static str {
        match self {
            Self::Diamond => "diamond.svg",
            Self::Gas => "gas.svg",
        }
    }

    const fn title(self) -> &'static str {
        match self {
            Self::Diamond => "Diamonds: time to find what touches",
            Self::Gas => "Gas filled to 0.3: time to find what touches",
        }
    }

    fn holds(self, set: &str) -> bool {
        match self {
            Self::Diamond => set.starts_with("diamond:") && !set.contains('+'),
            Self::Gas => set.starts_with("gas:") && set.ends_with(":0.3"),
        }
    }
}

/// The picture of the sets of one family; `None` if there are none.
pub(super) fn figure(times: &Times, family: Family) -> Option<Plot> {
    let rows: Vec<&Row> = times.rows.iter().filter(|row| family.holds(&row.set)).collect();
    let (x, y) = (Axis::new("spheres", Scale::Log), Axis::new("ns per sphere", Scale::Log));
    let of = |name: &str, colour, line, value: fn(&Row) -> Option<f64>| {
        // A point without a value has no place on a logarithmic axis.
        let points = rows.iter().map(|row| (row.spheres as f64, value(row).unwrap_or(f64::NAN)));
        Series::new(name, colour, points).line(line)
    };
    let measured = |name: &str, colour, value| of(&format!("{name}: measured"), colour, Line::Solid, value);
    let how = format!(": simulated, {} at {} MHz", times.settings.link, times.settings.clock_mhz);
    let simulated = |name: &str, value| of(&format!("{name}{how}"), 1, Line::Dashed, value);
    fn jobs(row: &Row) -> Option<&Simulated> {
        row.simulated.as_ref()
    }
    let series = [
        measured("ODE, hash space", 3, |row| row.measured.ode_hash).marker(Marker::Circle),
        measured("ODE, sweep and prune", 4, |row| row.measured.ode_sweep).marker(Marker::Square),
        measured("parry3d, tree of boxes", 5, |row| row.measured.parry).marker(Marker::Triangle),
        measured("this crate's search, contacts", 0, |row| row.measured.search_contacts).marker(Marker::Circle),
        measured("SIMD cell list, contacts", 2, |row| row.measured.cells_contacts).marker(Marker::Circle),
        measured("SIMD cell list, numbers", 2, |row| row.measured.cells_numbers).hollow(Marker::Circle),
        simulated("AFU sent pairs", |row| Some(jobs(row)?.pairs.ns)).marker(Marker::Triangle),
        simulated("AFU, contacts", |row| Some(jobs(row)?.contacts.ns)).marker(Marker::Circle),
        simulated("AFU, numbers", |row| Some(jobs(row)?.numbers.ns)).hollow(Marker::Circle),
    ];
    let plot = series.into_iter().fold(Plot::new(family.title(), x, y), Plot::with);
    (!rows.is_empty()).then_some(plot)
}

#[cfg(test)]
mod tests {
    use super::super::tests::example;
    use super::*;

    #[test]
    fn measured_and_simulated_are_told_apart() {
        for family in Family::ALL {
            let plot = figure(&example(), family).expect("there are such sets");
            let svg = plot.svg();
            crate::plot::overlap::check(&svg);
            crate::plot::overlap::check(&plot.narrow().svg());
            assert!(svg.contains("AFU, numbers: simulated, harp1 at 200 MHz") && svg.contains("numbers: measured"));
            for (kind, count) in [("Solid", 6), ("Dashed", 3)] {
                // A line in the plot and one in the legend.
                assert_eq!(svg.matches(&format!("{kind}\" d=")).count(), 2 * count, "{kind}");
            }
        }
    }

    #[test]
    fn a_moved_set_and_a_missing_peer_have_no_point() {
        let signs =
            |times: &Times| figure(times, Family::Diamond).expect("two diamonds").svg().matches("sign ").count();
        let times = example();
        assert_eq!(signs(&times), 8 * 2 + 9, "two diamonds, without parry3d, and the legend");
        let mut fewer = times.clone();
        fewer.rows.remove(1);
        assert_eq!(signs(&times) - signs(&fewer), 8);
        fewer.rows.clear();
        assert_eq!(figure(&fewer, Family::Gas), None);
    }
}
