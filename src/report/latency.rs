//! Where the cycles of a small job go: the sum of the parts beside the measured cycles of the Verilog.

use super::table::{counted, table};
use crate::afu::{Afu, Spec};
use crate::link::LinkModel;
use crate::pairs::Set;
use crate::verify::{Bench, Part, VerifyError, account};

/// The parts of a job, and its measured cycles.
type Column = (Vec<Part>, u64);

/// A table of the parts of jobs with these numbers of pairs and seed 1. `None` if [`account`] cannot split one of them.
///
/// # Errors
/// Returns an error if the AFU cannot be generated or run.
pub fn text(bench: &Bench, link: &LinkModel, numbers: &[u32]) -> Result<Option<String>, VerifyError> {
    let afu = Afu::generate(Spec::from(bench.config().clone()))?;
    let mut columns: Vec<Column> = Vec::new();
    for &pairs in numbers {
        let Some(parts) = account(&afu, link, pairs) else { return Ok(None) };
        let measured = bench.run(&Set::Random(pairs.into()).pairs(1), link, 1)?.outcome.cycles;
        columns.push((parts, measured));
    }
    let row = |name: &str, cycles: &dyn Fn(&Column) -> u64| -> Vec<String> {
        std::iter::once(name.to_owned()).chain(columns.iter().map(|column| cycles(column).to_string())).collect()
    };
    let of = |parts: &[Part], name: &str| parts.iter().find(|part| part.name == name).map_or(0, |part| part.cycles);
    let named = columns.iter().map(|(parts, _)| parts).max_by_key(|parts| parts.len());
    let named = named.into_iter().flatten().map(|part| part.name);
    let mut rows: Vec<Vec<String>> = named.map(|name| row(name, &|(parts, _)| of(parts, name))).collect();
    rows.push(row("sum", &|(parts, _)| parts.iter().map(|part| part.cycles).sum()));
    rows.push(row("measured", &|(_, measured)| *measured));
    let heading: Vec<String> = std::iter::once("cycles".to_owned())
        .chain(numbers.iter().map(|&pairs| counted(pairs.into(), "pair")))
        .collect();
    Ok(Some(table(&heading.iter().map(String::as_str).collect::<Vec<_>>(), rows)))
}
