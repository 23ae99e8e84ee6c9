//! Faults that show only in the whole accelerator.

use super::Rows;

const CONTROL: Rows = &[
    (
        "pairs that came out are still inside",
        "(pairs_inside + entered_wide) - {3'd0, emerged};",
        "pairs_inside + entered_wide;",
        16,
        "inside_is_right",
    ),
    ("gives up as it completes", "busy & expired & ~completes;", "busy & expired;", 18, "complete_is_good"),
    ("goes on while it drains", "(running & ~completes & ~failing)", "(running & ~completes)", 3, "one_or_other"),
    ("begins while it runs", "wire accept = start & ~busy;", "wire accept = start & ~draining;", 3, "begins_rested"),
    ("a refused job does not begin", "begin_job <= accept;", "begin_job <= accept & ~refuses;", 2, "begins_first"),
    ("a job begins again", "begin_job <= accept;", "begin_job <= accept | (start & running);", 6, "begins_empty"),
    ("ends with pairs inside", "wire none_inside = ~|pairs_inside & ", "wire none_inside = ", 13, "idle_is_empty"),
    (
        "room is never used up",
        "(line_left ? 5'd2 : 5'd0) - entered_wide",
        "line_left ? 5'd2 : 5'd0",
        12,
        "places_add_up",
    ),
    ("enters while any room is left", "run & |next_room[4:3];", "run & |next_room;", 20, "room_is_seen"),
    (
        "half a line is none",
        "rounded_count = {1'b0, count} + 33'd1;",
        "rounded_count = {1'b0, count};",
        3,
        "lines_are_right",
    ),
];

const FEEDER: Rows = &[
    ("pairs enter after an abort", "wire go_0 = may_enter & ", "wire go_0 = ", 11, "only_in_a_job"),
    ("takes a line that is not there", "wire line_comes = line_valid & ", "wire line_comes = ", 3, "takes_a_line"),
    ("a turn too many", "turn_after_2 >= scpus_wide;", "turn_after_2 > scpus_wide;", 11, "turn_is_an_scpu"),
    ("two pairs count as one", "go_1 ? 2'd2 : go_0", "go_1 ? 2'd1 : go_0", 11, "each_once"),
    ("counts no line that it takes", "if (start | take) lines_left", "if (start) lines_left", 10, "flags_are_right"),
    ("every line is short", "one_lines_left ? last_place : 1'b1", "last_place", 10, "only_last_is_short"),
];

const FEEDER_IN_CONTROL: Rows =
    &[("a pair enters without room", "may_enter <= run & |next_room[4:3];", "may_enter <= run;", 28, "never_negative")];

const PACKER: Rows = &[(
    "the last line goes out twice",
    "wire start_or_flushes = start | flushes;",
    "wire start_or_flushes = start;",
    18,
    "last_line_once",
)];

const STORE: Rows = &[
    (
        "a line counts as nine",
        "line_valid ? (stored + 4'd1) : (stored - 4'd1)",
        "line_valid ? (stored + 4'd9) : (stored - 4'd1)",
        19,
        "fits",
    ),
    ("sends a line that has left", "(stored[0] & ~take)", "stored[0]", 20, "sends_a_line"),
];

const TOP: Rows =
    &[("results are early", "group_done <= group_out;", "group_done <= feeder_issue_group;", 13, "comes_out")];

const PORT_CONTROL: Rows = &[
    ("ends with a request on the port", "none_inside & (link_idle_heard | given_up);", "none_inside;", 6, "rd_in_job"),
    (
        "done with a write on the port",
        "packer_done & dispatched & link_idle;",
        "packer_done & dispatched;",
        23,
        "wr_in_job",
    ),
    ("done and still running", "(running & ~completes & ~failing)", "(running & ~failing)", 6, "done_known"),
    (
        "a response that nobody waits for is no error",
        "(unexpected_heard & ~begin_job) ? 4'd7",
        "1'b0 ? 4'd7",
        26,
        "surprise_is_told",
    ),
    ("done at once", "complete <= run & packer_done & dispatched & link_idle;", "complete <= run;", 5, "done_all"),
];

const PORT_COLLECTOR: Rows = &[
    ("every other line is read", "(next_address + 58'd1)", "(next_address + 58'd2)", 6, "rd_in_order"),
    (
        "the first line is asked for again",
        "rd_req_tag <= {epoch, next_slot};",
        "rd_req_tag <= {epoch, 2'd0};",
        6,
        "rd_tag_free",
    ),
    ("ends while a read is out", "assign idle = ~|outstanding & ", "assign idle = ", 8, "done_acknowledged"),
    ("read requests do not wait", "rd_req_valid <= issue | request_stays;", "rd_req_valid <= issue;", 6, "rd_stable"),
];

const PORT_DISPATCHER: Rows = &[
    ("every other line is written", "(next_address + 58'd1)", "(next_address + 58'd2)", 24, "wr_in_order"),
    ("all writes have one tag", "wr_req_tag <= {epoch, next_slot};", "wr_req_tag <= {epoch, 2'd0};", 24, "wr_tag_free"),
    ("write requests do not wait", "wr_req_valid <= goes | request_stays;", "wr_req_valid <= goes;", 22, "wr_stable"),
];

const PORT_TOP: Rows = &[(
    "each pair gets its neighbour's result",
    "slots_record_0_d1 <= slots_record_0;",
    "slots_record_0_d1 <= slots_record_1;",
    21,
    "wr_data",
)];

const PORT_PACKER: Rows = &[
    (
        "contacts in one lane only",
        "{30'd0, {1'b0, contact_0} + {1'b0, contact_1}}",
        "{31'd0, contact_1}",
        26,
        "done_counts",
    ),
    (
        "invalid pairs in one lane only",
        "{30'd0, {1'b0, invalid_0} + {1'b0, invalid_1}}",
        "{31'd0, invalid_1}",
        26,
        "done_invalid",
    ),
    (
        "the wrong invalid pair",
        "(invalid_0 ? emerged_before : (emerged_before + 32'd1))",
        "emerged_before",
        26,
        "done_first",
    ),
];

const ENDS: Rows = &[("acknowledgements are not counted", "(goes ^ answered)", "goes", 36, "ends")];

pub const TABLES: &[(&str, &str, Rows)] = &[
    ("credits", "contact_afu_control.v", CONTROL),
    ("credits", "contact_afu_feeder.v", FEEDER),
    ("credits", "contact_afu_control.v", FEEDER_IN_CONTROL),
    ("credits", "contact_afu_packer.v", PACKER),
    ("credits", "contact_afu_dispatcher.v", STORE),
    ("credits", "contact_afu.v", TOP),
    ("one job", "contact_afu_control.v", PORT_CONTROL),
    ("one job", "contact_afu_collector.v", PORT_COLLECTOR),
    ("one job", "contact_afu_dispatcher.v", PORT_DISPATCHER),
    ("one job", "contact_afu.v", PORT_TOP),
    ("one job", "contact_afu_packer.v", PORT_PACKER),
    ("a job ends", "contact_afu_dispatcher.v", ENDS),
];
