//! The parts of the search among spheres that are proven one by one. What boxes and kernels say is free in every cycle,
//! so the memories do not matter, and the table is as large as it can be.

use std::sync::OnceLock;

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Input, Results, Search, Shell};
use contact_afu::query::Fields;

use crate::design::{inputs, instance};

/// A part of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A row's box with those of groups of rows.
    Groups,
    /// A row's box with those of the rows of groups.
    GroupRows,
    /// Each sphere of a row with the box of another row.
    Near,
    /// Each of these spheres with 16 others.
    BoxPairs,
    /// A decider.
    Decider,
    /// The fork in front of two deciders and the queue of steps behind them, in the AFU.
    Undecided,
    /// The fork in front of two deciders and the join behind them, in the AFU.
    Join,
    /// What loads rows and launches them, in the AFU.
    Entry,
    /// What begins a job.
    Control,
}

use Part::{BoxPairs, Control, Decider, Entry, GroupRows, Groups, Join, Near, Undecided};

/// Parts of the AFU that neither join nor entry needs.
const OTHERS: &[&str] = &[
    "control",
    "collector",
    "groups",
    "group_rows",
    "near",
    "box_pairs",
    "packer",
    "dispatcher",
    "row_queue",
    "group_queue",
    "near_queue",
    "candidate_queue",
];
/// Parts of a decider whose outputs are free, if its queues are not.
const IN_DECIDER: &[&str] = &["kernel", "columns", "rows"];
/// The module of the queue of steps, the bits of a step and the number of places.
const STEPS: (&str, u32, u32) = ("queue_64x31_slack_8", 31, 64);

/// What Yosys makes free: these parts of a module.
fn free(module: &str, parts: &[&str]) -> String {
    parts.iter().map(|part| format!(" {module}/{part}")).collect()
}

impl Part {
    /// The name of its module.
    fn module(self) -> &'static str {
        match self {
            Groups => "contact_afu_groups",
            GroupRows => "contact_afu_group_rows",
            Near => "contact_afu_near",
            BoxPairs => "contact_afu_candidates",
            Decider => "contact_afu_decider",
            Undecided | Join | Entry => "contact_afu",
            Control => "contact_afu_control",
        }
    }

    /// Macros that describe it to its harness.
    pub fn defines(self) -> &'static [&'static str] {
        match self {
            Groups => &["STAGE_CYCLES=6", "FOUND=mask", "NUMBER=place[3:0]", "ABOUT_BITS=13", "ROW_AT=1"],
            GroupRows => &["STAGE_CYCLES=6", "FOUND=mask", "NUMBER=place[3:0]", "ABOUT_BITS=17", "ROW_AT=5"],
            Near => &["STAGE_CYCLES=7", "FOUND=spheres", "NUMBER=other[3:0]", "ABOUT_BITS=21", "ROW_AT=9", "NEAR"],
            BoxPairs => &["STAGE_CYCLES=8", "FOUND={share_1,share_0}", "ABOUT_BITS=41", "ROW_AT=13", "BOX_PAIRS"],
            Decider => &["TO_ANSWER=12", "UNDECIDED=64"],
            Undecided => &["UNDECIDED=64"],
            Join | Entry | Control => &[],
        }
    }

    /// Commands of Yosys that make free what does not matter.
    pub fn frees(self) -> String {
        let module = self.module();
        let free = match self {
            Control => return String::new(),
            // What its queues give is free, and when is not.
            Decider => [
                free(module, IN_DECIDER),
                free("queue_64x28_slack_8", &["w:oldest"]),
                free("queue_64x8_slack_8", &["w:oldest"]),
            ]
            .concat(),
            Undecided => {
                let others = [
                    free(module, OTHERS),
                    free(module, &["loader", "rows"]),
                    free("contact_afu_decider", IN_DECIDER),
                    free("contact_afu_decider", &["shares", "answers"]),
                    free("contact_afu_hits", &["hit_queue"]),
                ];
                // The harness looks into this memory.
                return format!("cutpoint{}; memory_map {};", others.concat(), STEPS.0);
            }
            Join => [
                free(module, OTHERS),
                free(module, &["loader", "rows"]),
                free("contact_afu_decider", IN_DECIDER),
                free("contact_afu_decider", &["shares", "answers"]),
                free("contact_afu_hits", &["step_queue", "hit_queue"]),
            ]
            .concat(),
            Entry => [
                free(module, OTHERS),
                free(module, &["decider_0", "decider_1", "hits"]),
                free("contact_afu_loader", &["unit"]),
            ]
            .concat(),
            Groups | GroupRows | Near | BoxPairs => free(module, &["w:meets_*"]),
        };
        format!("cutpoint{free};")
    }

    /// Verilog files (name and text) of it and of what is in it, and what its harness includes.
    pub fn files(self) -> Vec<(String, String)> {
        let (_, files) = files().iter().find(|(part, _)| *part == self).expect("one of all parts");
        files.clone()
    }

    fn files_in(self, afu: &Afu) -> Vec<(String, String)> {
        let modules = afu.top().hierarchy();
        let module = modules.iter().find(|module| module.name == self.module()).expect("the part");
        let own = module.hierarchy();
        let is_own = |file: &str| own.iter().any(|module| file == format!("{}.v", module.name));
        let verilog = afu.verilog().into_iter().filter(|(name, _)| is_own(name));
        let includes = [
            ("inputs.svh".to_owned(), inputs(module, "  input wire clk,\n  input wire rst")),
            ("dut.svh".to_owned(), instance(module, self.module())),
            ("words.svh".to_owned(), steps()),
        ];
        verilog.chain(includes).collect()
    }
}

/// Declares the words of the memory of the queue of steps, and the low bits of all, one for each decider.
fn steps() -> String {
    let (_, bits, depth) = STEPS;
    let names: Vec<_> = (0..depth).map(|place| format!("\\dut.hits.step_queue.words[{place}] ")).collect();
    let wires = names.iter().map(|name| format!("  (* hierconn *) wire [{}:0] {name};\n", bits - 1));
    let bits_of = |bit: u32| {
        let all: Vec<_> = names.iter().rev().map(|name| format!("{name}[{bit}]")).collect();
        format!("  wire [{}:0] steps_bit_{bit} = {{\n    {}\n  }};\n", depth - 1, all.join(",\n    "))
    };
    wires.chain([bits_of(0), bits_of(1)]).collect()
}

/// A part and its files.
type Files = (Part, Vec<(String, String)>);

/// The files of all parts. The AFU is generated once.
fn files() -> &'static [Files] {
    static ALL: OnceLock<Vec<Files>> = OnceLock::new();
    ALL.get_or_init(|| {
        let config = Config {
            input: Input::Spheres,
            results: Results::Hits,
            contact: Fields::HIT,
            shell: Shell::Line,
            clock_mhz: 20.0,
            search: Search { table: 65_536, box_bits: 10, lanes: 16, deciders: 2 },
            ..Config::default()
        };
        let afu = Afu::generate(Spec::from(config)).expect("a sound accelerator");
        let parts = [Groups, GroupRows, Near, BoxPairs, Decider, Undecided, Join, Entry, Control];
        parts.into_iter().map(|part| (part, part.files_in(&afu))).collect()
    })
}
