//! The register map of the shell `axi`: one table, read by the hardware, the host, the generated REGISTERS.md, the C
//! header and the documentation.
//!
//! The registers up to offset 0x0C are those of the protocol `ap_ctrl_hs`, as XRT and Vitis read them. Registers of 64
//! and 128 bits are words of 32 bits, the least significant first.

pub use super::super::spl2::map::AFU_ID;
use crate::afu::JobError;
use crate::config::Input;

/// The version of this map. It changes with every change that affects software; `CHANGELOG.md` has the rule.
pub const VERSION: u32 = 1;

/// How software may use a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// It can be read.
    Read,
    /// It can be read and written.
    ReadWrite,
    /// A 1 that is written to a bit toggles it.
    Toggle,
}

/// Bits of a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// The lowest bit.
    pub low: u32,
    /// The number of bits.
    pub bits: u32,
    /// The name.
    pub name: &'static str,
    /// The purpose.
    pub meaning: &'static str,
}

impl Field {
    /// The field's value in a register's.
    pub const fn get(&self, register: u32) -> u32 {
        register >> self.low & self.mask()
    }

    /// A register with this value of the field, and zeros elsewhere.
    pub const fn put(&self, value: u32) -> u32 {
        (value & self.mask()) << self.low
    }

    const fn mask(&self) -> u32 {
        u32::MAX >> (32 - self.bits)
    }
}

const fn field(low: u32, bits: u32, name: &'static str, meaning: &'static str) -> Field {
    Field { low, bits, name, meaning }
}

/// A register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Register {
    /// Byte offset of its first word.
    pub offset: u32,
    /// Words of 32 bits.
    pub words: u32,
    /// The name.
    pub name: &'static str,
    /// How it may be used.
    pub access: Access,
    /// The purpose.
    pub meaning: &'static str,
    /// Its parts, if it has any.
    pub fields: &'static [Field],
    /// The purpose if spheres come in, where it is another one.
    pub(super) of_spheres: Option<&'static str>,
    /// The only input with which there is such a register; `None` if it is always there.
    pub(super) only: Option<Input>,
}

impl Register {
    /// The register with another purpose if spheres come in.
    const fn of_spheres(self, meaning: &'static str) -> Self {
        Self { of_spheres: Some(meaning), ..self }
    }

    /// The register, if spheres come in.
    const fn only_of_spheres(self) -> Self {
        Self { only: Some(Input::Spheres), ..self }
    }

    /// The register of an accelerator with this input; `None` if it has no such register.
    fn of(self, input: Input) -> Option<Self> {
        let meaning = self.of_spheres.filter(|_| input == Input::Spheres).unwrap_or(self.meaning);
        self.only.is_none_or(|only| only == input).then_some(Self { meaning, ..self })
    }

    /// The register with these parts.
    const fn with(self, fields: &'static [Field]) -> Self {
        Self { fields, ..self }
    }

    /// The register with two words, or four.
    const fn of_words(self, words: u32) -> Self {
        Self { words, ..self }
    }
}

const fn register(offset: u32, name: &'static str, access: Access, meaning: &'static str) -> Register {
    Register { offset, words: 1, name, access, meaning, fields: &[], of_spheres: None, only: None }
}

use Access::{Read, ReadWrite, Toggle};

/// Bit 0 of [`CONTROL`].
pub const START: Field = field(0, 1, "ap_start", "write 1 to start a job; reads 1 until the job has ended");
/// Bit 1 of [`CONTROL`].
pub const DONE: Field =
    field(1, 1, "ap_done", "a job has ended since the last read of this register; a read clears it");
/// Bit 2 of [`CONTROL`].
pub const IDLE: Field = field(2, 1, "ap_idle", "no job runs");
/// Bit 3 of [`CONTROL`].
pub const READY: Field = field(3, 1, "ap_ready", "as `ap_done`: a new job can be started once this one has ended");
/// The control register of `ap_ctrl_hs`.
pub const CONTROL: Register =
    register(0x00, "control", ReadWrite, "`ap_ctrl_hs`; `auto_restart` (bit 7) is not implemented and reads 0")
        .with(&[START, DONE, IDLE, READY]);

/// Bit 0 of [`GLOBAL_INTERRUPT_ENABLE`].
pub const ENABLE: Field = field(0, 1, "enable", "`interrupt` may rise");
/// Enables the port `interrupt`.
pub const GLOBAL_INTERRUPT_ENABLE: Register =
    register(0x04, "global_interrupt_enable", ReadWrite, "enables the port `interrupt`").with(&[ENABLE]);
/// Bit 0 of the interrupt registers.
pub const DONE_EVENT: Field = field(0, 1, "done", "a job has ended");
/// Bit 1 of the interrupt registers.
pub const READY_EVENT: Field = field(1, 1, "ready", "a new job can be started; in the same cycle");
/// Which events are recorded.
pub const INTERRUPT_ENABLE: Register =
    register(0x08, "interrupt_enable", ReadWrite, "the events that are recorded in `interrupt_status`")
        .with(&[DONE_EVENT, READY_EVENT]);
/// Events that happened.
pub const INTERRUPT_STATUS: Register = register(
    0x0C,
    "interrupt_status",
    Toggle,
    "recorded events; `interrupt` is high while one is set. A written 1 toggles a bit: write back what was read",
)
.with(&[DONE_EVENT, READY_EVENT]);

/// Where the pairs lie.
pub const SOURCE: Register =
    register(0x10, "source", ReadWrite, "byte address of the first line of pairs; its low six bits are ignored")
        .of_spheres("byte address of the first line of spheres; its low six bits are ignored")
        .of_words(2);
/// Where the contacts go.
pub const DESTINATION: Register = register(
    0x18,
    "destination",
    ReadWrite,
    "byte address of the first line of contacts; its low six bits are ignored",
)
.of_words(2);
/// The number of pairs.
pub const COUNT: Register = register(0x20, "count", ReadWrite, "pairs of the job; 0 is a job")
    .of_spheres("spheres of the first set, at most as many as the table holds; 0 is a job");
/// The room for results.
pub const DESTINATION_LINES: Register = register(
    0x24,
    "destination_lines",
    ReadWrite,
    "lines of 64 bytes that there is room for at `destination`; used with `--results hits` only",
)
.of_spheres("lines of 64 bytes that there is room for at `destination`; what does not fit ends the job with error 6");
/// The mode.
pub const MODE: Register = register(0x28, "mode", ReadWrite, "0; anything else ends the job with error 5").of_spheres(
    "0: one set, each pair once; 1: the first set against the second; 2: the first set of the last job, which is \
         still in the table, against the second; anything else ends the job with error 5",
);
/// The watchdog.
pub const WATCHDOG: Register = register(
    0x2C,
    "watchdog",
    ReadWrite,
    "cycles without a response, while one is outstanding, that end the job with error 4; 0: never, but for an aborted \
     or failed job, which ends after 65 536 such cycles",
);

/// The second set.
pub const OTHERS: Register =
    register(0x30, "others", ReadWrite, "spheres of the second set, at most 65 536; used in modes 1 and 2")
        .only_of_spheres();

/// Bit 0 of [`STATUS`].
pub const BUSY: Field = field(0, 1, "busy", "a job runs");
/// Bit 1 of [`STATUS`].
pub const ENDED: Field =
    field(1, 1, "done", "the last job has ended; 0 from the next start on; a read does not clear it");
/// Bit 2 of [`STATUS`].
pub const OUTSTANDING: Field =
    field(2, 1, "outstanding", "a read or write of memory has no response yet: memory may still be written");
/// Bits 15:8 of [`STATUS`].
pub const ERROR: Field = Field {
    low: 8,
    bits: JobError::BITS,
    name: "error",
    meaning: "how the last job has ended: 0 well, else one of the errors below",
};
/// The status of the last job.
pub const STATUS: Register =
    register(0x40, "status", Read, "the job; a read changes nothing").with(&[BUSY, ENDED, OUTSTANDING, ERROR]);
/// Bits 1:0 of [`FAILURE`].
pub const CHANNEL: Field = field(0, 2, "channel", "0 no failure, 1 read (R), 2 write (B)");
/// Bits 5:4 of [`FAILURE`].
pub const RESPONSE: Field = field(4, 2, "response", "2 SLVERR, 3 DECERR");
/// The first error response of the last job.
pub const FAILURE: Register =
    register(0x44, "failure", Read, "the first error response of the last job").with(&[CHANNEL, RESPONSE]);
/// Its address.
pub const FAILURE_ADDRESS: Register = register(
    0x48,
    "failure_address",
    Read,
    "byte address of the line that could not be read, or of the burst that could not be written",
)
.of_words(2);
/// Contacts.
pub const CONTACTS: Register = register(0x50, "contacts", Read, "contacts of the job so far");
/// Invalid pairs.
pub const INVALID: Register =
    register(0x54, "invalid", Read, "invalid pairs of the job so far").of_spheres("invalid spheres of the job so far");
/// The first invalid pair.
pub const FIRST_INVALID: Register =
    register(0x58, "first_invalid", Read, "number of the first invalid pair, all ones if there is none").of_spheres(
        "number of the first invalid sphere, counted through the sets that the job reads, all ones if there is none",
    );
/// Jobs.
pub const JOBS: Register = register(0x5C, "jobs", Read, "jobs that were started since `ap_rst_n`, modulo 2^32");
/// Cycles of the job.
pub const CYCLES_BUSY: Register =
    register(0x60, "cycles_busy", Read, "cycles of the job; read it when the job has ended").of_words(2);
/// Cycles without pairs.
pub const CYCLES_INPUT: Register =
    register(0x68, "cycles_input", Read, "of these, cycles in which the SCPUs waited for pairs")
        .of_spheres("of these, cycles in which no line of spheres was there")
        .of_words(2);
/// Cycles without room.
pub const CYCLES_OUTPUT: Register =
    register(0x70, "cycles_output", Read, "of these, cycles in which pairs waited for room for their results")
        .of_spheres("of these, cycles in which hits waited for room in a line")
        .of_words(2);
/// When the first line came.
pub const FIRST_READ: Register =
    register(0x78, "first_read", Read, "cycles from the job's start to its first source line");
/// When the first line was ready.
pub const FIRST_WRITE: Register =
    register(0x7C, "first_write", Read, "cycles from the job's start to its first written line");
/// The accelerator.
pub const IDENTITY: Register = register(0x80, "afu_id", Read, "says which accelerator this is").of_words(4);
/// The version.
pub const MAP_VERSION: Register = register(0x90, "version", Read, "of this map");
/// Responses that nothing waits for.
pub const UNASKED: Register = register(
    0x94,
    "unasked",
    Read,
    "cycles since `ap_rst_n` in which memory answered what nobody had asked for, modulo 2^32; a job that runs in such a \
     cycle ends with error 7",
);
/// The capability word.
pub const CAPABILITY: Register =
    register(0x98, "capability", Read, "what this accelerator is: see PORTS.md").of_words(2);
/// Bit 0 of [`SOFT_RESET`].
pub const RESET: Field =
    field(0, 1, "reset", "write 1 to abort the job and wait for every response; reads 1 until then");
/// The soft reset.
pub const SOFT_RESET: Register =
    register(0xA0, "soft_reset", ReadWrite, "ends what runs; what has ended stays recorded").with(&[RESET]);
/// Scratch.
pub const SCRATCH: Register = register(0xA4, "scratch", ReadWrite, "no effect: for a first test of the bus");

/// Candidates.
pub const CANDIDATES: Register =
    register(0xA8, "candidates", Read, "pairs of spheres of the job so far whose boxes meet").only_of_spheres();

/// The registers of an accelerator with this input, in the order of their offsets.
pub fn registers(input: Input) -> impl Iterator<Item = Register> {
    REGISTERS.into_iter().filter_map(move |register| register.of(input))
}

/// All registers, in the order of their offsets, those included that not every accelerator has.
pub const REGISTERS: [Register; 30] = [
    CONTROL,
    GLOBAL_INTERRUPT_ENABLE,
    INTERRUPT_ENABLE,
    INTERRUPT_STATUS,
    SOURCE,
    DESTINATION,
    COUNT,
    DESTINATION_LINES,
    MODE,
    WATCHDOG,
    OTHERS,
    STATUS,
    FAILURE,
    FAILURE_ADDRESS,
    CONTACTS,
    INVALID,
    FIRST_INVALID,
    JOBS,
    CYCLES_BUSY,
    CYCLES_INPUT,
    CYCLES_OUTPUT,
    FIRST_READ,
    FIRST_WRITE,
    IDENTITY,
    MAP_VERSION,
    UNASKED,
    CAPABILITY,
    SOFT_RESET,
    SCRATCH,
    CANDIDATES,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_lie_in_their_page_in_order_and_apart() {
        let mut end = 0;
        for register in REGISTERS {
            assert!(register.offset >= end && register.offset % 4 == 0, "{}", register.name);
            assert!(register.words == 1 || register.offset % 8 == 0, "{}", register.name);
            end = register.offset + 4 * register.words;
            let mut bit = 0;
            for field in register.fields {
                assert!(field.low >= bit, "{}.{}", register.name, field.name);
                bit = field.low + field.bits;
            }
            assert!(bit <= 32);
        }
        assert!(end <= 1 << super::super::port::REGISTER_ADDRESS_BITS);
    }

    /// An accelerator of pairs has neither the registers of one of spheres nor their words.
    #[test]
    fn registers_are_those_of_the_input() {
        let [pairs, spheres] = [Input::Direct, Input::Spheres].map(|input| registers(input).collect::<Vec<_>>());
        let names = |all: &[Register]| all.iter().map(|register| register.name).collect::<Vec<_>>();
        let more: Vec<_> = names(&spheres).into_iter().filter(|name| !names(&pairs).contains(name)).collect();
        assert_eq!((more, spheres.len()), (vec!["others", "candidates"], pairs.len() + 2));
        let says = |all: &[Register], word: &str| all.iter().filter(|it| it.meaning.contains(word)).count();
        assert!(says(&pairs, "pair") > 5 && says(&pairs, "sphere") == 0 && says(&spheres, "sphere") > 5);
        let of_pairs: Vec<_> = spheres.iter().filter(|it| it.meaning.contains("pair")).map(|it| it.name).collect();
        assert_eq!(of_pairs, ["mode", "candidates"], "pairs of spheres");
    }

    /// What XRT and drivers of Vitis' kernels know.
    #[test]
    fn the_first_registers_are_those_of_ap_ctrl_hs() {
        let offsets = [CONTROL, GLOBAL_INTERRUPT_ENABLE, INTERRUPT_ENABLE, INTERRUPT_STATUS, SOURCE].map(|r| r.offset);
        assert_eq!(offsets, [0x00, 0x04, 0x08, 0x0C, 0x10]);
        assert_eq!([START, DONE, IDLE, READY].map(|field| field.low), [0, 1, 2, 3]);
        assert_eq!((ERROR.get(0xffff_f5ff), ERROR.put(5)), (5, 0x500));
    }
}
