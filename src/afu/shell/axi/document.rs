//! REGISTERS.md and the C header, from the table of registers.

use std::fmt::Write as _;

use super::map::{self, AFU_ID, Access, VERSION, registers};
use crate::afu::JobError;
use crate::config::{Input, Shell};
use crate::record::Layout;
use crate::spheres::ROW;

/// The map as Markdown, of an accelerator with this input: tables of the registers, of their fields, and of the errors.
pub fn markdown(input: Input) -> String {
    let mut out = format!("AFU_ID `{AFU_ID:032x}`, version {VERSION} of this map.\n\n");
    out += "| offset | bits | name | access | meaning |\n|---|---|---|---|---|\n";
    for register in registers(input) {
        let (offset, bits, access) = (register.offset, 32 * register.words, access(register.access));
        let _ = writeln!(out, "| {offset:#04X} | {bits} | `{}` | {access} | {} |", register.name, register.meaning);
    }
    out += "\n| register | bits | field | meaning |\n|---|---|---|---|\n";
    for register in registers(input) {
        for field in register.fields {
            let (first, last) = (field.low, field.low + field.bits - 1);
            let _ = writeln!(out, "| `{}` | {last}:{first} | `{}` | {} |", register.name, field.name, field.meaning);
        }
    }
    out += "\n| error | what it is | what to do |\n|---|---|---|\n";
    for error in JobError::of(Shell::Axi, input) {
        let _ = writeln!(out, "| {} | {} | {} |", error.code(), error.what(), error.advice(Shell::Axi, input));
    }
    out
}

fn access(access: Access) -> &'static str {
    match access {
        Access::Read => "R",
        Access::ReadWrite => "R/W",
        Access::Toggle => "R, toggle",
    }
}

/// The steps of a job as Markdown.
pub fn job(input: Input, layout: &Layout) -> String {
    let at = |register: map::Register| format!("`{}` ({:#04X})", register.name, register.offset);
    let what = match input {
        Input::Direct => "pairs",
        Input::Spheres => "spheres",
    };
    let arguments = match input {
        Input::Direct if layout.number_bits() == 0 => [map::COUNT, map::MODE].map(at).join(", "),
        // The number of contacts is not known before, so the AFU must know how many it may write.
        Input::Direct => [map::DESTINATION_LINES, map::COUNT, map::MODE].map(at).join(", "),
        Input::Spheres => [map::DESTINATION_LINES, map::COUNT, map::OTHERS, map::MODE].map(at).join(", "),
    };
    format!(
        "## A job

The records of {what} and contacts are in PORTS.md. Offsets between registers, and behind them, read 0; writes there
change nothing. A register of 64 or 128 bits is words of 32 bits, the least significant first.

1. Hold `ap_rst_n` low for 16 cycles. Read {identity}: it is the AFU_ID above.
2. Put the {what} into memory, from a byte address on that is a multiple of 64. A multiple of 4096 gives the longest
   bursts. If the CPU's caches are not coherent with the port, flush the {what} from the CPU's caches, and invalidate the
   lines of the contacts.
3. Write {source}, {destination}, {arguments} and {watchdog}.
4. Write 1 to {control}. The job has what the registers hold now. What is written while it runs is for the next job,
   and another start is ignored until it has ended.
5. Read {status} until `done` is 1. Or set bit 0 of {enable} and of {global}, and wait for the port `interrupt`; then
   write 1 to {events}.
6. If `error` is 0, the contacts are in memory from `destination` on. Otherwise {failure} and {address} say which access
   of memory failed, if one did.
7. For another job, go on with 2. After error 4, wait until `outstanding` is 0 before memory is used for anything else.

Memory that answers what nobody asked for ends the job that runs with error 7, and is counted in {unasked}. That register
should stay 0. If it does not, the interconnect is faulty, or was not reset with the accelerator.

To stop a job, write 1 to {reset}, and wait until it reads 0. The job ends with error 1. If it still reads 1 after the
watchdog's time, memory owes a response that will not come: reset the interconnect and the accelerator together.
{more}",
        identity = at(map::IDENTITY),
        source = at(map::SOURCE),
        destination = at(map::DESTINATION),
        watchdog = at(map::WATCHDOG),
        control = at(map::CONTROL),
        status = at(map::STATUS),
        enable = at(map::INTERRUPT_ENABLE),
        global = at(map::GLOBAL_INTERRUPT_ENABLE),
        events = at(map::INTERRUPT_STATUS),
        failure = at(map::FAILURE),
        address = at(map::FAILURE_ADDRESS),
        reset = at(map::SOFT_RESET),
        unasked = at(map::UNASKED),
        more = if input == Input::Spheres { spheres(layout) } else { String::new() },
    )
}

/// What a job of spheres has beyond the steps.
fn spheres(layout: &Layout) -> String {
    let at = |register: map::Register| format!("`{}` ({:#04X})", register.name, register.offset);
    format!(
        "
## Jobs of spheres

Each set takes whole rows of {ROW} spheres, which are {lines} lines each. With n = `count` and m = `others`:

| `mode` | the job | in memory, from `source` on |
|---|---|---|
| 0 | which of n spheres touch | ⌈n / {ROW}⌉ rows |
| 1 | which of n spheres touch which of m others | ⌈n / {ROW}⌉ rows, then ⌈m / {ROW}⌉ rows |
| 2 | which of the first set of the last job touch which of m others | ⌈m / {ROW}⌉ rows |

For 20 spheres at 0x10000 with room for {room} contacts at 0x20000: write 0x10000 to {source}, 0x20000 to {destination}, 10
to {lines_of_results}, 20 to {count} and 0 to {mode}, and start the job. It reads 8 lines. When it has ended, `contacts`
({contacts:#04X}) records are at 0x20000, {per_line} in a line of 64 bytes.

- {candidates} has the pairs whose boxes met, and {invalid} the spheres that touch nothing because they are no spheres.
- Error 6 says that there was no room for all contacts. `contacts` has counted all: give `destination` room for them, and
  start the job again.
- Mode 2 needs a last job that ended with error 0.
",
        lines = ROW / 4,
        per_line = layout.contacts_per_line(),
        room = 10 * layout.contacts_per_line(),
        source = at(map::SOURCE),
        destination = at(map::DESTINATION),
        lines_of_results = at(map::DESTINATION_LINES),
        count = at(map::COUNT),
        mode = at(map::MODE),
        contacts = map::CONTACTS.offset,
        candidates = at(map::CANDIDATES),
        invalid = at(map::INVALID),
    )
}

/// The map as a C header. `prefix` begins its names.
pub(super) fn header(prefix: &str, input: Input, about: &str) -> String {
    let upper = prefix.to_uppercase();
    let mut out = format!(
        "/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Registers of the AXI4-Lite slave s_axi_control, as in REGISTERS.md.
 * A register of more than 32 bits is words of 32 bits, the least significant first.
 * {about}
 */
#ifndef {upper}_REGS_H
#define {upper}_REGS_H

/* The identity, the least significant word first. */
"
    );
    for word in 0..4 {
        let value = (AFU_ID >> (32 * word)) as u32;
        let _ = writeln!(out, "#define {upper}_AFU_ID_{word} {value:#010x}u");
    }
    let _ = writeln!(out, "#define {upper}_VERSION_OF_MAP {VERSION}u");
    for register in registers(input) {
        let name = register.name.to_uppercase();
        let (bits, access) = (32 * register.words, access(register.access));
        let _ = writeln!(out, "\n/* {bits} bits, {access}: {} */", register.meaning.replace('`', ""));
        let _ = writeln!(out, "#define {upper}_{name} {:#04x}u", register.offset);
        for field in register.fields {
            let mask = field.put(u32::MAX);
            let part = field.name.to_uppercase();
            let _ = writeln!(out, "#define {upper}_{name}_{part} {mask:#x}u /* {} */", field.meaning.replace('`', ""));
            if field.bits > 1 {
                let _ = writeln!(out, "#define {upper}_{name}_{part}_SHIFT {}u", field.low);
            }
        }
    }
    out += "\n/* Errors of a job, in the field error of the status. */\n";
    for error in JobError::of(Shell::Axi, input) {
        let name: String = format!("{error:?}").to_uppercase();
        let _ = writeln!(out, "#define {upper}_ERROR_{name} {}u /* {} */", error.code(), error.what());
    }
    let _ = writeln!(out, "\n#endif /* {upper}_REGS_H */");
    out
}
