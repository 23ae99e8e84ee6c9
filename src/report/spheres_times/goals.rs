//! What was to be reached, and whether it was.

use serde::Serialize;

use super::{Row, Times};

/// A goal for one set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Goal {
    /// The set.
    pub set: String,
    /// What is limited.
    pub what: &'static str,
    /// At most this.
    pub most: f64,
    /// What this run gives.
    pub found: f64,
    /// Whether it is not more.
    pub met: bool,
}

/// The sets that have goals, with the most ns per sphere.
const SETS: [(&str, f64); 2] = [("diamond:30", 8.5), ("gas:32768:0.3", 5.0)];

type Limit = (&'static str, f64, fn(&Row) -> Option<f64>);

/// The other goals of each of these sets.
const LIMITS: [Limit; 3] = [
    ("numbers, time over the cell list's", 0.2, Row::numbers_over_cells),
    ("numbers, time over that of ODE's best space", 0.02, Row::numbers_over_ode),
    ("contacts, time over the link limit", 1.15, |row| {
        let share = row.simulated.as_ref()?.contacts.link_share;
        (share > 0.0).then(|| 1.0 / share)
    }),
];

impl Times {
    /// The goals of the sets of this run.
    pub fn goals(&self) -> Vec<Goal> {
        let mut goals = Vec::new();
        for (set, most) in SETS {
            let Some(row) = self.rows.iter().find(|row| row.set == set) else { continue };
            let own: Limit = ("numbers, ns per sphere", most, |row| Some(row.simulated.as_ref()?.numbers.ns));
            for (what, most, found) in [own].into_iter().chain(LIMITS) {
                let goal = |found| Goal { set: set.to_owned(), what, most, found, met: found <= most };
                goals.extend(found(row).map(goal));
            }
        }
        goals
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::example;

    #[test]
    fn a_goal_that_is_missed_is_said_to_be() {
        let goals = example().goals();
        assert_eq!(goals.len(), 8);
        let missed: Vec<_> = goals.iter().filter(|goal| !goal.met).map(|goal| (goal.set.as_str(), goal.what)).collect();
        assert_eq!(missed, [("gas:32768:0.3", "numbers, ns per sphere")]);
        assert_eq!((goals[4].most, goals[4].found), (5.0, 6.0));
        let mut later = example();
        later.rows.remove(1);
        assert_eq!(later.goals().len(), 4, "a set moved off the origin is another set");
    }
}
