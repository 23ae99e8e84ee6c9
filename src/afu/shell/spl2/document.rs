//! REGISTERS.md, from the map and the steps of a job.

use std::fmt::Write as _;

use super::map::{
    AFU_ID, CONTROL_LINE, CSRS, Csr, DATA_LINE, Field, IDENTITY_LINE, IDLE_POLL_CYCLES, LATENCY_LINE, LINES,
    PERFORMANCE_LINE, POINTERS_LINE, RUNNING_POLL_CYCLES, STATUS_LINE, VERSION,
};
use crate::afu::JobError;
use crate::config::{Input, Shell};
use crate::spheres::ROW;

/// The map as Markdown, for an accelerator with this input: tables of the registers, of the lines' fields, and of the
/// errors.
pub fn markdown(input: Input) -> String {
    let mut out = format!("AFU_ID `{AFU_ID:032x}`, version {VERSION} of this map.\n\n");
    out += "| CSR | name | meaning |\n|---|---|---|\n";
    for Csr { offset, name, meaning } in CSRS {
        let _ = writeln!(out, "| {offset:#06X} | `{name}` | {meaning} |");
    }
    out += "\n| line | written by | dword | bits | field | meaning |\n|---|---|---|---|---|---|\n";
    for (name, writer, fields) in LINES {
        let told = fields.iter().filter_map(|field| Some((field, field.meaning(input)?)));
        for (Field { low, bits, name: field, .. }, meaning) in told {
            let (dword, first) = (low / 32, low % 32);
            let last = first + bits - 1;
            let _ = writeln!(out, "| {name} | {writer} | {dword} | {last}:{first} | `{field}` | {meaning} |");
        }
    }
    out += "\n| error | what it is | what to do |\n|---|---|---|\n";
    for error in JobError::of(Shell::Spl2, input) {
        let _ = writeln!(out, "| {} | {} | {} |", error.code(), error.what(), error.advice(Shell::Spl2, input));
    }
    out
}

/// The steps of a job as Markdown, for an accelerator with this input.
pub fn job(input: Input) -> String {
    let (what, more) = match input {
        Input::Direct => ("pairs", String::new()),
        Input::Spheres => ("spheres", spheres()),
    };
    format!(
        "## A job

The records of {what} and contacts are in PORTS.md. Source line {DATA_LINE} is the first line of {what}; destination line 0 is the first line
of contacts.

1. Reset the AFU (`spl_reset`). Clear the DSM. Write its physical address to `dsm_base_high`, then to `dsm_base_low`: the AFU writes DSM
   line {IDENTITY_LINE}.
2. Write context line {POINTERS_LINE}, clear source line {CONTROL_LINE}, and write the context's virtual address to `context_base_high`, then to
   `context_base_low`. Raise `spl_enable`.
3. Write the {what}, then source line {CONTROL_LINE}, `start` last. The AFU reads that line {IDLE_POLL_CYCLES} cycles after its last answer, and every
   {RUNNING_POLL_CYCLES} cycles while a job runs.
4. Wait until context line {STATUS_LINE} has `done` and the job's `sequence`: the contacts and DSM lines {LATENCY_LINE} and {PERFORMANCE_LINE} were
   written before it.
5. For another job, clear `start` and go on with 3, with another `sequence`.
{more}"
    )
}

/// What a job of spheres has beyond the steps.
fn spheres() -> String {
    format!(
        "
With n = `count` and m = `others`: mode 0 has ⌈n / {ROW}⌉ rows of spheres from source line {DATA_LINE} on, mode 1 these and then ⌈m / {ROW}⌉
rows, mode 2 ⌈m / {ROW}⌉ rows. A row is {lines} lines. Error 6 says that the destination has no room for all contacts, of which
`contacts` has the number. Mode 2 needs a last job that ended with error 0.
",
        lines = ROW / 4
    )
}
