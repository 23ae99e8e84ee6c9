//! Faults that show only in the whole accelerator.

use super::Rows;

const CONTROL: Rows = &[
    (
        "gives up as it completes",
        "busy_copy_0 & expired & ~completes;",
        "busy_copy_0 & expired;",
        25,
        "complete_is_good",
    ),
    (
        "goes on while it drains",
        "wire goes_on = running & ~completes & ~failing;",
        "wire goes_on = running & ~completes;",
        4,
        "one_or_other",
    ),
    (
        "begins while it runs",
        "wire accept = start & ~busy_copy_0;",
        "wire accept = start & ~draining;",
        11,
        "begins_rested",
    ),
    ("runs before it begins", "run <= (run | begin_job)", "run <= (run | accept | waits_to_begin)", 3, "begins_first"),
    (
        "a job begins again",
        "wire begins = (accept | ",
        "wire begins = ((start & running) | accept | ",
        14,
        "begins_empty",
    ),
    (
        "begins without waiting for the delay lines",
        "(accept | still_waits) & filled_heard;",
        "accept;",
        3,
        "nothing_before_it_is_filled",
    ),
    (
        "waits for the delay lines after it began",
        "(accept | keeps_waiting) & ~filled_heard;",
        "accept | keeps_waiting;",
        10,
        "waits_or_runs",
    ),
    (
        "a part is not told of the beginning",
        "begin_job_copy_1 <= begins;",
        "begin_job_copy_1 <= 1'b0;",
        9,
        "begins_everywhere",
    ),
    (
        "is not busy with a job that it refuses",
        "wire is_busy = accept | (busy_copy_0",
        "wire is_busy = (accept & ~|mode) | (busy_copy_0",
        2,
        "busy_is_right",
    ),
    ("a copy of a flag is none", "busy_copy_2 <= is_busy;", "busy_copy_2 <= 1'b0;", 2, "busy_is_right"),
    (
        "request ports are not told of the end",
        "drops_requests <= begins | is_given_up;",
        "drops_requests <= begins;",
        17,
        "drops_in_time",
    ),
    ("ends with pairs inside", "draining & stopped & none_inside_heard & ", "draining & ", 21, "idle_is_empty"),
    (
        "runs on when the watchdog expires",
        "fails <= (running & (abort_job | read_failed | write_failed)) | expires;",
        "fails <= running & (abort_job | read_failed | write_failed);",
        17,
        "nothing_runs",
    ),
    (
        "half a line is none",
        "rounded_count = {1'b0, count} + 33'd1;",
        "rounded_count = {1'b0, count};",
        2,
        "lines_are_right",
    ),
    (
        "the destination of the next job",
        "if (~busy_copy_2) job_destination <= destination;",
        "job_destination <= destination;",
        3,
        "job_stays",
    ),
    ("the last line is full", "last_place <= count[0] - 1'b1;", "last_place <= 1'b1;", 2, "last_is_right"),
];

const FEEDER: Rows = &[
    ("pairs enter after an abort", "wire go_0 = may_go_on & ", "wire go_0 = ", 21, "only_in_a_job"),
    (
        "a line is ready that is not there",
        "= any_lines_waiting_without_step & any_lines_left",
        "= any_lines_left",
        16,
        "takes_a_line",
    ),
    ("takes a line that is not ready", "wire take = line_ready & ", "wire take = ", 16, "enters_once"),
    ("a turn too many", "(turn >= turns_before_2)", "(turn > turns_before_2)", 22, "turn_is_an_scpu"),
    ("two pairs count as one", "entered <= go_1 ? 2'd2 : ", "entered <= go_1 ? 2'd1 : ", 21, "enters_once"),
    ("a ready line counts as two", "(lines_left - 32'd1)", "(lines_left - 32'd2)", 20, "readies_once"),
    (
        "counts no line that it takes",
        "if (start | lines_left_step) lines_left",
        "if (start) lines_left",
        20,
        "flags_are_right",
    ),
    ("every line is short", "last_is_next ? last_place : 1'b1", "last_place", 20, "only_last_is_short"),
    (
        "the last line is known late",
        "last_line_ready & ~two_lines_ready",
        "last_line_ready & two_lines_ready",
        20,
        "enters_once",
    ),
    (
        "the last line is any line",
        "line_readies & one_lines_left",
        "line_readies & any_lines_left",
        19,
        "knows_the_last",
    ),
    ("a short line holds two", "next_last >= 1'b1", "1'b1", 20, "knows_what_it_holds"),
    ("a job with lines has no pairs", "all_given <= start ? ~|lines : ", "all_given <= start | ", 11, "all_come_out"),
];

const CREDITS: Rows = &[
    (
        "what leaves counts before the delay lines are filled",
        "counts_emerged <= filled;",
        "counts_emerged <= 1'b1;",
        4,
        "inside_is_right",
    ),
    (
        "pairs that came out are still inside",
        "((pairs_inside + {4'd0, entered}) - {4'd0, emerged_now})",
        "(pairs_inside + {4'd0, entered})",
        29,
        "inside_is_right",
    ),
    (
        "room is never used up",
        "(line_left ? 6'd2 : 6'd0) - {4'd0, entered}",
        "line_left ? 6'd2 : 6'd0",
        22,
        "places_add_up",
    ),
    (
        "room is forgotten when a pair enters",
        "room <= start ? 6'd32 : room_now;",
        "room <= start ? 6'd32 : |entered ? 6'd0 : room_now;",
        22,
        "room_is_seen",
    ),
    (
        "a pair takes eight places",
        "(line_left ? 6'd2 : 6'd0) - {4'd0, entered}",
        "(line_left ? 6'd2 : 6'd0) - {1'b0, entered, 3'd0}",
        23,
        "never_negative",
    ),
    (
        "a job is complete with pairs inside",
        "all_emerged <= ~start & all_given & is_empty;",
        "all_emerged <= ~start & all_given;",
        23,
        "all_come_out",
    ),
];

const PACKER: Rows = &[
    (
        "the last line goes out twice",
        "wire start_or_flushes = start | flushes;",
        "wire start_or_flushes = start;",
        31,
        "last_line_once",
    ),
    (
        "two pairs come out as one",
        "emerged + {30'd0, group_before}",
        "emerged + {31'd0, |group_before}",
        30,
        "comes_out_once",
    ),
];

const STORE: Rows = &[
    (
        "a line counts as nine",
        "line_valid ? (stored + 5'd1) : (stored - 5'd1)",
        "line_valid ? (stored + 5'd17) : (stored - 5'd1)",
        31,
        "fits",
    ),
    ("sends a line that has left", "take ? any_stored_after_step", "1'b0 ? any_stored_after_step", 32, "sends_a_line"),
    (
        "a line that comes last is not known",
        "take ? any_stored_after_step : any_stored_without_step",
        "take ? any_stored_after_step : any_stored",
        31,
        "knows_what_is_stored",
    ),
];

const SLOT: Rows = &[(
    "results are early",
    "leaves <= leaves_in | answers_soon;",
    "leaves <= leaves_in | {takes_lane_1, takes_lane_0};",
    25,
    "comes_out",
)];

const PORT_CONTROL: Rows = &[
    (
        "ends with a request on the port",
        "none_inside_heard & (link_idle_heard | given_up);",
        "none_inside_heard;",
        19,
        "rd_in_job",
    ),
    ("done with a write on the port", "dispatched & link_idle & goes_on;", "dispatched & goes_on;", 36, "wr_in_job"),
    ("done and still busy", "(busy_copy_0 & ~completes & ~drained)", "(busy_copy_0 & ~drained)", 14, "done_known"),
    (
        "a response that nobody waits for is no error",
        "unexpected_heard <= unexpected & ~begins;",
        "unexpected_heard <= 1'b0;",
        41,
        "surprise_is_told",
    ),
    (
        "done at once",
        "completes <= run & packer_done & dispatched & link_idle & goes_on;",
        "completes <= run & goes_on;",
        12,
        "done_all",
    ),
];

const PORT_COLLECTOR: Rows = &[
    ("every other line is read", "(next_address + 58'd1)", "(next_address + 58'd2)", 13, "rd_in_order"),
    ("the first line is asked for again", "= {epoch, next_slot};", "= {epoch, 2'd0};", 13, "rd_tag_free"),
    ("ends while a read is out", "~|outstanding & ", "", 19, "done_acknowledged"),
    (
        "read requests do not wait",
        "rd_req_valid <= rd_req_next_valid | ~rd_req_moves;",
        "rd_req_valid <= rd_req_next_valid;",
        13,
        "rd_stable",
    ),
];

const PORT_DISPATCHER: Rows = &[
    ("every other line is written", "(wr_req_address + 58'd1)", "(wr_req_address + 58'd2)", 37, "wr_in_order"),
    ("all writes have one tag", "= {wr_req_epoch, wr_req_slot};", "= {wr_req_epoch, 2'd0};", 37, "wr_tag_free"),
    (
        "write requests do not wait",
        "wr_req_valid <= (goes & ~drops_requests) | ~wr_req_moves;",
        "wr_req_valid <= goes & ~drops_requests;",
        34,
        "wr_stable",
    ),
];

const PORT_SLOT: Rows = &[(
    "every result is the complement",
    "record_0 <= answers_lane_0 ? unit_record : record_0_in;",
    "record_0 <= answers_lane_0 ? ~unit_record : record_0_in;",
    33,
    "wr_data",
)];

const PORT_PACKER: Rows = &[
    (
        "contacts in one lane only",
        "contacts_now <= {1'b0, contact_here_0} + {1'b0, contact_here_1};",
        "contacts_now <= {1'b0, contact_here_1};",
        41,
        "done_counts",
    ),
    (
        "invalid pairs in one lane only",
        "invalid_now <= {1'b0, invalid_here_0} + {1'b0, invalid_here_1};",
        "invalid_now <= {1'b0, invalid_here_1};",
        41,
        "done_invalid",
    ),
    ("the wrong invalid pair", "(emerged + {31'd0, first_invalid_lane})", "emerged", 41, "done_first"),
];

const ANY_COLLECTOR: Rows = &[(
    "a request follows one that was given up",
    "wire rd_req_next_valid = ~drops_requests & (",
    "wire rd_req_next_valid = (",
    20,
    "rd_in_order",
)];

const ENDS: Rows = &[("acknowledgements are not counted", "(free_step ^ answered)", "free_step", 57, "ends")];

pub const TABLES: &[(&str, &str, Rows)] = &[
    ("credits", "contact_afu_control.v", CONTROL),
    ("credits", "contact_afu_feeder.v", FEEDER),
    ("credits", "contact_afu_credits.v", CREDITS),
    ("credits", "contact_afu_packer.v", PACKER),
    ("credits", "contact_afu_dispatcher.v", STORE),
    ("credits", "scpu_slot.v", SLOT),
    ("one job", "contact_afu_control.v", PORT_CONTROL),
    ("one job", "contact_afu_collector.v", PORT_COLLECTOR),
    ("one job", "contact_afu_dispatcher.v", PORT_DISPATCHER),
    ("one job", "scpu_slot.v", PORT_SLOT),
    ("one job", "contact_afu_packer.v", PORT_PACKER),
    ("any link, any host", "contact_afu_collector.v", ANY_COLLECTOR),
    ("a job ends", "contact_afu_dispatcher.v", ENDS),
];
