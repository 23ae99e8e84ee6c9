//! Faults that the whole accelerator shows.

use super::Rows;

const CONTROL: Rows = &[
    (
        "pairs that came out are still inside",
        "(pairs_inside + entered_wide) - {2'd0, emerged};",
        "pairs_inside + entered_wide;",
        11,
        "inside_is_right",
    ),
    ("goes on while it drains", "(running & ~complete & ~failing)", "(running & ~complete)", 3, "one_or_other"),
    ("a refused job does not begin", "begin_job <= accept;", "begin_job <= accept & ~failing;", 2, "begins_first"),
    ("a job begins again", "begin_job <= accept;", "begin_job <= accept | (start & running);", 6, "begins_empty"),
    ("ends with pairs inside", "draining & ~|pairs_inside & ", "draining & ", 8, "idle_is_empty"),
    ("room is never used up", "((room - entered_wide) + ", "(room + ", 7, "places_add_up"),
];

const FEEDER: Rows = &[
    ("pairs enter after an abort", "wire go_0 = run & present_0", "wire go_0 = present_0", 6, "only_in_a_job"),
    ("takes a line that is not there", "assign take = line_valid & ", "assign take = ", 1, "takes_a_line"),
    (
        "a turn too many",
        "wire turn_wraps = next_turn >= scpus_wide;",
        "wire turn_wraps = next_turn > scpus_wide;",
        7,
        "turn_is_an_scpu",
    ),
    (
        "two pairs count as one",
        "remaining <= start ? count : (remaining - {30'd0, group});",
        "remaining <= start ? count : (remaining - {31'd0, go_0});",
        7,
        "each_once",
    ),
    ("a pair enters without room", "wire roomy_0 = |room;", "wire roomy_0 = 1'b1;", 10, "never_negative"),
];

const PACKER: Rows =
    &[("the last line goes out twice", "wire emptied = start | flush;", "wire emptied = start;", 12, "last_line_once")];

const STORE: Rows = &[
    (
        "a line counts as five",
        "stored <= start ? 3'd0 : (left + {2'd0, line_valid});",
        "stored <= start ? 3'd0 : (left + {line_valid, 1'b0, line_valid});",
        12,
        "fits",
    ),
    ("sends a line that has left", "ready <= ~start & |left;", "ready <= ~start & |stored;", 14, "sends_a_line"),
];

const TOP: Rows =
    &[("results are early", "group_answered <= group_out;", "group_answered <= feeder_issue_group;", 9, "comes_out")];

const PORT_CONTROL: Rows = &[
    (
        "ends with a request on the port",
        "~|pairs_inside & (link_idle | (given_up & ~asking));",
        "~|pairs_inside;",
        5,
        "rd_in_job",
    ),
    (
        "done with a write on the port",
        "packer_done & dispatched & link_idle;",
        "packer_done & dispatched;",
        18,
        "wr_in_job",
    ),
    ("done and still running", "(running & ~complete & ~failing)", "(running & ~failing)", 4, "done_known"),
    (
        "done at once",
        "wire complete = run & packer_done & dispatched & link_idle;",
        "wire complete = run;",
        4,
        "done_all",
    ),
];

const PORT_COLLECTOR: Rows = &[
    ("every other line is read", "(next_address + 58'd1)", "(next_address + 58'd2)", 5, "rd_in_order"),
    (
        "the first line is asked for again",
        "rd_req_tag <= {epoch, next_slot};",
        "rd_req_tag <= {epoch, 2'd0};",
        5,
        "rd_tag_free",
    ),
    ("ends while a read is out", "assign idle = ~|outstanding & ", "assign idle = ", 6, "done_acknowledged"),
    (
        "read requests do not wait",
        "rd_req_valid <= issue | (rd_req_valid & ~rd_req_ready);",
        "rd_req_valid <= issue;",
        5,
        "rd_stable",
    ),
];

const PORT_DISPATCHER: Rows = &[
    ("every other line is written", "(next_address + 58'd1)", "(next_address + 58'd2)", 19, "wr_in_order"),
    ("all writes have one tag", "wr_req_tag <= {epoch, next_slot};", "wr_req_tag <= {epoch, 2'd0};", 19, "wr_tag_free"),
    (
        "write requests do not wait",
        "wr_req_valid <= take | (wr_req_valid & ~wr_req_ready);",
        "wr_req_valid <= take;",
        18,
        "wr_stable",
    ),
];

const PORT_TOP: Rows = &[(
    "each pair gets its neighbour's result",
    "slots_record_0_d1 <= slots_record_0;",
    "slots_record_0_d1 <= slots_record_1;",
    17,
    "wr_data",
)];

const PORT_PACKER: Rows = &[
    (
        "contacts in one lane only",
        "{30'd0, {1'b0, contact_0} + {1'b0, contact_1}}",
        "{31'd0, contact_1}",
        20,
        "done_counts",
    ),
    (
        "invalid pairs in one lane only",
        "{30'd0, {1'b0, invalid_0} + {1'b0, invalid_1}}",
        "{31'd0, invalid_1}",
        20,
        "done_invalid",
    ),
    ("the wrong invalid pair", "(invalid_0 ? emerged : (emerged + 32'd1))", "emerged", 20, "done_first"),
];

const ENDS: Rows = &[("acknowledgements are not counted", " - {2'd0, response});", ");", 25, "ends")];

pub const TABLES: &[(&str, &str, Rows)] = &[
    ("credits", "contact_afu_control.v", CONTROL),
    ("credits", "contact_afu_feeder.v", FEEDER),
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
