//! Deleting a line of an example changes exactly the rows of its plan that name this line.

use contact_afu::scene::{Plan, Row, Scene};

use super::{EXAMPLES, path};

/// The contents of a row that do not depend on line numbers.
fn content(row: &Row) -> (bool, String, Vec<String>) {
    (row.on, row.value.clone(), row.calls.iter().map(|call| call.text.clone()).collect())
}

/// Groups of bodies are named by their line, so they are compared by their order.
fn rows(plan: &Plan) -> Vec<(String, Row)> {
    let mut groups = 0;
    let name = |row: &Row| match row.name.split_once(" of line ") {
        Some((kind, _)) => {
            groups += 1;
            format!("{kind} {groups}")
        }
        None => row.name.clone(),
    };
    let names: Vec<String> = plan.rows.iter().map(name).collect();
    names.into_iter().zip(plan.rows.iter().cloned()).collect()
}

/// Lines that a scene requires: its version, the headings of its tables, a shape and its parameters.
fn is_structure(line: &str) -> bool {
    let keys = ["scene", "shape", "layers", "count", "corners", "centres", "want"];
    line.starts_with('[') || line == "]" || keys.iter().any(|key| line.starts_with(&format!("{key} = ")))
}

#[test]
fn a_line_less_changes_the_rows_that_name_it_and_no_other() {
    let (mut changed_rows, mut refused) = (0, 0);
    for example in EXAMPLES {
        let file = path(example);
        let text = std::fs::read_to_string(&file).unwrap();
        let whole = Plan::of(&Scene::parse(example, &text).unwrap()).unwrap();
        for (index, line) in text.lines().enumerate() {
            let line = line.trim();
            let number = index + 1;
            let rest: Vec<&str> = text.lines().enumerate().filter(|(i, _)| *i != index).map(|(_, line)| line).collect();
            let scene = match Scene::parse(example, &rest.join("\n")) {
                Ok(scene) => scene,
                Err(error) => {
                    let last_wish = text.lines().filter(|line| line.trim_start().starts_with('"')).count() == 1;
                    let is_needed =
                        is_structure(line) || last_wish && line.starts_with('"') || is_only_motion(example, line);
                    assert!(is_needed, "{example}:{number} `{line}` is not needed, yet: {error}");
                    assert!(error.to_string().starts_with(&format!("{example}:")), "{error}");
                    refused += 1;
                    continue;
                }
            };
            let then = Plan::of(&scene).unwrap();
            let (before, after) = (rows(&whole), rows(&then));
            for (name, row) in &before {
                let other = after.iter().find(|(other, _)| other == name).map(|(_, row)| content(row));
                let changes = other != Some(content(row));
                let is_named = row.calls.iter().any(|call| call.line == number);
                assert_eq!(changes, is_named, "{example}:{number} `{line}`, row {name}: {row:?} became {other:?}");
                changed_rows += usize::from(changes);
            }
            assert!(after.iter().all(|(name, _)| before.iter().any(|(other, _)| other == name)));
        }
    }
    assert!(changed_rows > 60 && refused > 20, "{changed_rows} rows changed, {refused} lines were needed");
}

/// Lines that cannot be deleted: trajectories are wanted and only this line moves bodies, or another line depends on
/// it.
fn is_only_motion(example: &str, line: &str) -> bool {
    matches!(
        (example, line.split(' ').next()),
        ("diamond", Some("pull")) | ("column", Some("gravity")) | ("billiards", Some("spin"))
    )
}
