//! The register map of the `spl2` shell: one table, read by the hardware, the host, the generated `REGISTERS.md` and
//! the documentation.
//!
//! Lines are 64 bytes, sixteen little-endian dwords. Addresses in registers and lines are in bytes and must be those of
//! whole lines; their low six bits are ignored.

use crate::afu::JobError;
use crate::config::Input;
use crate::hdl::{Graph, Signal};

/// Identity of the accelerator, in DSM line 0 and in the status. It never changes.
pub const AFU_ID: u128 = 0xf885_f921_48fc_4b0b_8fd1_f127_a3a0_b8e2;
/// The version of this map. It changes with every change that affects software; `CHANGELOG.md` has the rule.
pub const VERSION: u32 = 2;
/// Dword 0 of the control memory, when a job is there.
pub const START_WORD: u32 = 0x406C_CCFF;

/// Cycles from an answer of the control memory to its next read, while no job runs.
pub const IDLE_POLL_CYCLES: u32 = 32;
/// The same while a job runs, when only an abort can be found.
pub(crate) const RUNNING_POLL_CYCLES: u32 = 512;
/// Cycles after which an unanswered read by the shell is repeated.
pub(crate) const RETRY_CYCLES: u32 = 1 << 16;

/// DSM line of the identity.
pub(crate) const IDENTITY_LINE: u32 = 0;
/// DSM line of latencies.
pub const LATENCY_LINE: u32 = 4;
/// DSM line of cycles and lines.
pub const PERFORMANCE_LINE: u32 = 5;
/// DSM line that repeats the scratch register.
pub const SCRATCH_LINE: u32 = 63;
/// Bytes of the DSM.
pub const DSM_BYTES: u64 = 4096;
/// Context line with the addresses of the buffers.
pub(crate) const POINTERS_LINE: u32 = 0;
/// Context line that the AFU writes when a job has ended.
pub(crate) const STATUS_LINE: u32 = 1;
/// Source line of the control memory.
pub(crate) const CONTROL_LINE: u32 = 0;
/// Source line of the first pairs.
pub(crate) const DATA_LINE: u32 = 1;

/// A 32-bit register, written by a CSR write. Of two halves, the high one is written first, and the low one commits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Csr {
    /// Byte offset.
    pub offset: u32,
    /// The name.
    pub name: &'static str,
    /// The purpose.
    pub meaning: &'static str,
}

const fn csr(offset: u32, name: &'static str, meaning: &'static str) -> Csr {
    Csr { offset, name, meaning }
}

/// High half of the DSM's address.
pub const DSM_BASE_HIGH: Csr = csr(0x8A00, "dsm_base_high", "physical byte address of the DSM, bits 63:32");
/// Low half of the DSM's address.
pub const DSM_BASE_LOW: Csr = csr(0x8A04, "dsm_base_low", "bits 31:0; the AFU answers with DSM line 0");
/// High half of the context's address.
pub const CONTEXT_BASE_HIGH: Csr = csr(0x8A08, "context_base_high", "virtual byte address of the context, bits 63:32");
/// Low half of the context's address.
pub const CONTEXT_BASE_LOW: Csr = csr(0x8A0C, "context_base_low", "bits 31:0; the context is read once SPL is enabled");
/// Scratch.
pub const SCRATCH: Csr = csr(0x8AFC, "scratch", "the AFU repeats it in DSM line 63");

/// All registers.
pub(crate) const CSRS: [Csr; 5] = [DSM_BASE_HIGH, DSM_BASE_LOW, CONTEXT_BASE_HIGH, CONTEXT_BASE_LOW, SCRATCH];

/// A field of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its lowest bit in the line.
    pub low: u32,
    /// Its width, up to 128 bits.
    pub bits: u32,
    /// The name.
    pub name: &'static str,
    /// The content.
    pub meaning: &'static str,
    /// The content if spheres come in, where it is another one.
    of_spheres: Option<&'static str>,
    /// The only input with which there is such a field; `None` if it is always there.
    only: Option<Input>,
}

impl Field {
    /// The field with another content if spheres come in.
    const fn of_spheres(self, meaning: &'static str) -> Self {
        Self { of_spheres: Some(meaning), ..self }
    }

    /// The field, if spheres come in.
    const fn only_of_spheres(self) -> Self {
        Self { only: Some(Input::Spheres), ..self }
    }

    /// What the field holds in an accelerator with this input; `None` if it has no such field.
    pub(super) fn meaning(&self, input: Input) -> Option<&'static str> {
        let meaning = self.of_spheres.filter(|_| input == Input::Spheres).unwrap_or(self.meaning);
        self.only.is_none_or(|only| only == input).then_some(meaning)
    }

    /// The field's value in a line.
    pub fn get(&self, line: &[u32; 16]) -> u128 {
        let bit = |index: u32| u128::from(line[(index / 32) as usize] >> (index % 32) & 1);
        (0..self.bits).fold(0, |value, index| value | bit(self.low + index) << index)
    }

    /// Puts the low bits of `value` into a line.
    pub fn set(&self, line: &mut [u32; 16], value: u128) {
        for index in 0..self.bits {
            let (word, bit) = (&mut line[((self.low + index) / 32) as usize], (self.low + index) % 32);
            *word = *word & !(1 << bit) | ((value >> index & 1) as u32) << bit;
        }
    }

    /// The field of a line in hardware.
    pub(super) fn of<'g>(&self, line: Signal<'g>) -> Signal<'g> {
        line.slice(self.low, self.bits)
    }
}

/// A line in hardware: fields in increasing order, with zeros between them. Values narrower than their field are
/// extended.
pub(super) fn line<'g>(graph: &'g Graph, line_bits: u32, fields: &[(Field, Signal<'g>)]) -> Signal<'g> {
    let mut parts = Vec::new();
    let mut end = 0;
    for (field, value) in fields {
        if field.low > end {
            parts.push(graph.constant(field.low - end, 0));
        }
        parts.push(value.extend(field.bits));
        end = field.low + field.bits;
    }
    parts.reverse();
    Signal::join(&parts).extend(line_bits)
}

/// A field of `bits` bits that begins at dword `dword`.
const fn field(dword: u32, bits: u32, name: &'static str, meaning: &'static str) -> Field {
    bits_of(32 * dword, bits, name, meaning)
}

/// A field of `bits` bits that begins at this bit.
const fn bits_of(low: u32, bits: u32, name: &'static str, meaning: &'static str) -> Field {
    Field { low, bits, name, meaning, of_spheres: None, only: None }
}

/// DSM line 0.
pub mod identity {
    use super::{Field, field};

    /// [`super::AFU_ID`].
    pub const AFU_ID: Field = field(0, 128, "afu_id", "says which accelerator this is");
    /// [`super::VERSION`].
    pub const VERSION: Field = field(4, 32, "version", "of this map");
    /// The core's capability word.
    pub const CAPABILITY: Field = field(6, 64, "capability", "as the core's port of that name");
    /// All fields.
    pub const FIELDS: [Field; 3] = [AFU_ID, VERSION, CAPABILITY];
}

/// DSM line 4, of the last job.
pub mod latency {
    use super::{Field, field};

    /// From the start of the job to the first source line.
    pub(crate) const FIRST_READ: Field =
        field(0, 32, "first_read", "cycles from the job's start to its first source line");
    /// From the start of the job to the first destination line.
    pub(crate) const FIRST_WRITE: Field =
        field(1, 32, "first_write", "cycles from the job's start to its first write request");
    /// The job.
    pub const SEQUENCE: Field = field(2, 32, "sequence", "of the job");
    /// All fields.
    pub const FIELDS: [Field; 3] = [FIRST_READ, FIRST_WRITE, SEQUENCE];
}

/// DSM line 5, of the last job.
pub mod performance {
    use super::{Field, field};

    /// Cycles of the job.
    pub(crate) const BUSY: Field =
        field(0, 64, "cycles_busy", "cycles of the job, from its start to its last acknowledgement");
    /// Cycles without pairs.
    pub(crate) const INPUT: Field =
        field(2, 64, "cycles_input", "of these, cycles in which the SCPUs waited for pairs")
            .of_spheres("of these, cycles in which no line of spheres was there");
    /// Cycles without room.
    pub(crate) const OUTPUT: Field =
        field(4, 64, "cycles_output", "of these, cycles in which pairs waited for room for their results")
            .of_spheres("of these, cycles in which hits waited for room in a line");
    /// The job.
    pub const SEQUENCE: Field = field(6, 32, "sequence", "of the job");
    /// All fields.
    pub const FIELDS: [Field; 4] = [BUSY, INPUT, OUTPUT, SEQUENCE];
}

/// DSM line 63.
pub mod scratch {
    use super::{Field, field};

    /// The last value written.
    pub const VALUE: Field = field(0, 32, "scratch", "what the scratch register was written with");
    /// All fields.
    pub const FIELDS: [Field; 1] = [VALUE];
}

/// Context line 0.
pub mod pointers {
    use super::{Field, field};

    /// Address of the control memory, which the pairs follow.
    pub const SOURCE: Field = field(2, 64, "source", "pSource: virtual byte address of the control memory");
    /// Address of the first result.
    pub const DESTINATION: Field = field(4, 64, "destination", "pDest: virtual byte address of the first result");
    /// Length of both buffers, in lines.
    pub const LINES: Field =
        field(6, 32, "lines", "lines from pSource on, and likewise from pDest on, that the AFU may touch");
    /// All fields.
    pub const FIELDS: [Field; 3] = [SOURCE, DESTINATION, LINES];
}

/// Source line 0.
pub mod control {
    use super::{Field, field};

    /// [`super::START_WORD`].
    pub const START: Field = field(0, 32, "start", "start word 0x406CCCFF: a job is here; written last");
    /// Pairs.
    pub const COUNT: Field = field(1, 32, "count", "nCol: pairs of the job; 0 is a job")
        .of_spheres("spheres of the first set, at most as many as the table holds; 0 is a job");
    /// Mode.
    pub const MODE: Field = field(2, 32, "mode", "0; anything else ends the job with error 5").of_spheres(
        "0: one set, each pair once; 1: the first set against the second; 2: the first set of the last job since SPL was \
         enabled, which is still in the table, against the second; anything else ends the job with error 5",
    );
    /// The job's number.
    pub const SEQUENCE: Field =
        field(3, 32, "sequence", "the job's number: one unlike the last job's makes it a new job");
    /// Abort.
    pub(crate) const ABORT: Field = field(4, 32, "abort", "anything but 0 ends the running job with error 1");
    /// Watchdog.
    pub const WATCHDOG: Field = field(
        5,
        32,
        "watchdog",
        "cycles without a response, while a request waits for one, that end the job with error 4; 0: never, but for an \
         aborted job, which ends after 65 536 such cycles",
    );
    /// The second set.
    pub const OTHERS: Field =
        field(6, 32, "others", "spheres of the second set, at most 65 536; used in modes 1 and 2").only_of_spheres();
    /// All fields.
    pub const FIELDS: [Field; 7] = [START, COUNT, MODE, SEQUENCE, ABORT, WATCHDOG, OTHERS];
}

/// Context line 1.
pub mod status {
    use super::{Field, JobError, bits_of, field};

    /// The job has ended.
    pub const DONE: Field = field(0, 1, "done", "the job has ended");
    /// The error code.
    pub const ERROR: Field = bits_of(8, JobError::BITS, "error", "how: 0 well, else one of the errors below");
    /// The job.
    pub const SEQUENCE: Field = field(1, 32, "sequence", "of the job that has ended");
    /// Contacts.
    pub(crate) const CONTACTS: Field = field(2, 32, "contacts", "contacts of the job");
    /// Invalid pairs.
    pub(crate) const INVALID: Field =
        field(3, 32, "invalid", "invalid pairs of the job").of_spheres("invalid spheres of the job");
    /// Number of the first invalid pair.
    pub(crate) const FIRST_INVALID: Field = field(
        4,
        32,
        "first_invalid",
        "number of the first invalid pair, all ones if there is none",
    )
    .of_spheres(
        "number of the first invalid sphere, counted through the sets that the job reads, all ones if there is none",
    );
    /// [`super::VERSION`].
    pub const VERSION: Field = field(5, 32, "version", "of this map");
    /// The core's capability word.
    pub const CAPABILITY: Field = field(6, 64, "capability", "as in DSM line 0");
    /// [`super::AFU_ID`].
    pub const AFU_ID: Field = field(8, 128, "afu_id", "as in DSM line 0");
    /// Candidates.
    pub(crate) const CANDIDATES: Field =
        field(12, 32, "candidates", "pairs of spheres of the job whose boxes meet").only_of_spheres();
    /// All fields.
    pub const FIELDS: [Field; 10] =
        [DONE, ERROR, SEQUENCE, CONTACTS, INVALID, FIRST_INVALID, VERSION, CAPABILITY, AFU_ID, CANDIDATES];
}

/// The lines: name, writer, fields.
pub const LINES: [(&str, &str, &[Field]); 7] = [
    ("DSM line 0: identity", "AFU", &identity::FIELDS),
    ("DSM line 4: latency", "AFU", &latency::FIELDS),
    ("DSM line 5: performance", "AFU", &performance::FIELDS),
    ("DSM line 63: scratch", "AFU", &scratch::FIELDS),
    ("Context line 0: pointers", "host", &pointers::FIELDS),
    ("Context line 1: status", "AFU", &status::FIELDS),
    ("Source line 0: control memory", "host", &control::FIELDS),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_lie_in_their_lines_in_order_and_apart() {
        for (name, _, fields) in LINES {
            let mut end = 0;
            for field in fields {
                assert!(field.low >= end && field.bits <= 128, "{name}: {}", field.name);
                end = field.low + field.bits;
            }
            assert!(end <= 512, "{name}");
        }
    }

    #[test]
    fn a_field_keeps_its_value_and_its_neighbours() {
        let mut line = [u32::MAX; 16];
        status::AFU_ID.set(&mut line, AFU_ID);
        status::ERROR.set(&mut line, 5);
        assert_eq!((status::AFU_ID.get(&line), status::ERROR.get(&line)), (AFU_ID, 5));
        assert_eq!((line[0], line[7], line[12]), (0xffff_f5ff, u32::MAX, u32::MAX));
        assert_eq!(line[8], AFU_ID as u32);
    }
}
