//! Faults of parts that only some accelerators have: turns at an interval of 2; sieve, backlog and overflow if only
//! hits come back.

use super::Rows;

const CONTROL: Rows = &[(
    "a job begins with the last one's error",
    "error <= accept ? 4'd0 : ended;",
    "error <= ended;",
    13,
    "runs_without_error",
)];

const ROUNDS: Rows = &[
    ("every SCPU has phase 0", "1'b0 : ends_block ? ", "1'b0 : 1'b0 ? ", 22, "phase_is_the_block_s"),
    (
        "a single pair does not count",
        "(entered == 2'd1) ? turn_after_1",
        "(entered == 2'd1) ? turn",
        23,
        "turn_is_the_block_s",
    ),
    (
        "a group crosses its block",
        "wire unit_1 = uses_lane_1 & (turn_within_plus_1 < block_size);",
        "wire unit_1 = uses_lane_1;",
        25,
        "every_other_cycle",
    ),
];

const PHASE: Rows = &[
    ("any phase will do", "wire may_go = phase == turn_phase;", "wire may_go = 1'b1;", 23, "every_other_cycle"),
    (
        "a pair on both lanes",
        "carries_rank_0 <= {go_1, go_0};",
        "carries_rank_0 <= {2{go_0}};",
        23,
        "one_lane_serves_two",
    ),
    (
        "two pairs where one lane serves",
        "uses_lane_1 = 7'd2 < scpus;",
        "uses_lane_1 = 1'b1;",
        23,
        "phase_is_the_block_s",
    ),
];

const SIEVE: Rows = &[
    (
        "hits are dropped too",
        "dropped_pairs <= start ? 2'd0 : (group_here - hits_to_1);",
        "dropped_pairs <= start ? 2'd0 : group_here;",
        29,
        "each_is_sifted",
    ),
    (
        "a hit is counted and lost",
        "hits_rank_0 <= start ? 2'd0 : hits_to_1;",
        "hits_rank_0 <= start ? 2'd0 : hits_to_0;",
        29,
        "no_hit_is_lost",
    ),
];

const HITS_CREDITS: Rows =
    &[("room is never used up", "({3'd0, places_freed} - {4'd0, entered})", "{3'd0, places_freed}", 22, "hits_add_up")];

const BACKLOG: Rows = &[
    ("a hit counts as nine", "(left + {4'd0, put})", "(left + (|put ? 6'd17 : 6'd0))", 31, "backlog_fits"),
    ("a hit takes two rows", "(tail_row_0 + 4'd1)", "(tail_row_0 + 4'd2)", 30, "backlog_counts"),
    ("the next hit in the same bank", "(tail_bank + put[0])", "tail_bank", 30, "banks_in_turn"),
    ("a row too far", "(row_after_head_0 + 4'd1)", "(row_after_head_0 + 4'd2)", 32, "rows_in_turn"),
    (
        "what has left is read again",
        "readable <= start ? 6'd0 : left;",
        "readable <= start ? 6'd0 : stored;",
        32,
        "reads_what_is_there",
    ),
];

const STORE: Rows = &[("a line counts as nine", "comes ? (stored + 5'd1)", "comes ? (stored + 5'd9)", 37, "lines_fit")];

const JOB_DISPATCHER: Rows = &[
    ("every other line is written", "(wr_req_address + 58'd1)", "(wr_req_address + 58'd2)", 40, "in_order"),
    (
        "lines without room are written",
        "wire comes = line_valid & any_lines_of_room;",
        "wire comes = line_valid;",
        38,
        "has_room",
    ),
];

const JOB_PACKER: Rows = &[
    ("a last line without hits", "wire flushes = all_out & place & ", "wire flushes = all_out & ", 39, "only_hits"),
    (
        "the last line keeps the one before",
        "entering_1 : enters_0_place_1 ? entering_0 : 32'd0,",
        "entering_1 : enters_0_place_1 ? entering_0 : filling_0,",
        39,
        "rest_is_zero",
    ),
];

const JOB_SIEVE: Rows = &[
    (
        "a hit has its neighbour's number",
        "wire [31:0] number_1 = emerged + 32'd1;",
        "wire [31:0] number_1 = emerged;",
        38,
        "is_its_record",
    ),
    (
        "hits in one lane only are counted",
        "contacts_now <= hits_to_1;",
        "contacts_now <= hits_to_0;",
        39,
        "all_counted",
    ),
    (
        "invalid pairs in one lane only are counted",
        "invalid_now <= {1'b0, invalid_here_0} + {1'b0, invalid_here_1};",
        "invalid_now <= {1'b0, invalid_here_1};",
        33,
        "invalid_counted",
    ),
    (
        "the wrong invalid pair",
        "(emerged_before + {31'd0, first_invalid_lane})",
        "emerged_before",
        33,
        "first_is_right",
    ),
];

const JOB_CONTROL: Rows = &[
    (
        "done with a write on its way",
        "completes <= run & packer_done & dispatched & link_idle & goes_on;",
        "completes <= run & packer_done & dispatched & goes_on;",
        41,
        "done_acknowledged",
    ),
    (
        "done at once",
        "completes <= run & packer_done & dispatched & link_idle & goes_on;",
        "completes <= run & goes_on;",
        14,
        "all_written",
    ),
    ("hits beyond the room are no error", "(completes & overflowed) ? 4'd6", "1'b0 ? 4'd6", 39, "overflow_is_told"),
];

pub const TABLES: &[(&str, &str, Rows)] = &[
    ("credits", "contact_afu_control.v", CONTROL),
    ("credits of three at interval 2", "contact_afu_feeder.v", ROUNDS),
    ("credits at interval 2", "contact_afu_feeder.v", PHASE),
    ("credits of hits", "contact_afu_sieve.v", SIEVE),
    ("credits of hits", "contact_afu_credits.v", HITS_CREDITS),
    ("credits of hits", "contact_afu_backlog.v", BACKLOG),
    ("credits of hits", "contact_afu_dispatcher.v", STORE),
    ("one job of hits", "contact_afu_dispatcher.v", JOB_DISPATCHER),
    ("one job of hits", "contact_afu_packer.v", JOB_PACKER),
    ("one job of hits", "contact_afu_sieve.v", JOB_SIEVE),
    ("one job of hits", "contact_afu_control.v", JOB_CONTROL),
];
