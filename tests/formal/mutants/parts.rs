//! Faults that show in a single part.

use super::Rows;

const COLLECTOR: Rows = &[
    ("reads without a free slot", " & ~(~taken & (reserved[2] | (&reserved[1:0] & issue)));", ";", 8, "never_more"),
    (
        "slots begin anywhere",
        "next_slot <= start ? 2'd0 : (next_slot + 2'd1);",
        "next_slot <= next_slot + 2'd1;",
        2,
        "slots_in_order",
    ),
    ("offers two lines for one", "two_valid <= ~start & ~take & ", "two_valid <= ~start & ", 9, "offered_in_order"),
    (
        "come when asked for",
        "answered ? (4'd1 << arrived_age) : 4'd0",
        "rd_req_valid ? (4'd1 << (rd_req_tag[1:0] - oldest)) : 4'd0",
        5,
        "one_of_three",
    ),
    ("lines come again", "{1'b0, marked[3:1]} : marked", "{marked[0], marked[3:1]} : marked", 8, "come_once"),
    ("lines are forgotten", "oldest_goes ? {1'b0, marked[3:1]}", "oldest_goes ? {2'b0, marked[3:2]}", 8, "none_lost"),
    ("a slot is free before its line", "taken <= take & ~start;", "taken <= take | start;", 2, "taken_is_reserved"),
    (
        "asks for a line too many",
        "(issue ? |lines_to_request[31:1] : |lines_to_request)",
        "|lines_to_request",
        4,
        "asks_while_any",
    ),
    (
        "responses to earlier jobs count",
        "wire is_current = rd_rsp_valid & (response_epoch == epoch);",
        "wire is_current = rd_rsp_valid;",
        6,
        "awaited_is_right",
    ),
    ("any response counts", "answered <= is_awaited & ~start;", "answered <= is_current & ~start;", 3, "counted"),
    (
        "a response that nobody waits for is no error",
        "unexpected <= run & is_current & ~is_awaited & ~start;",
        "unexpected <= 1'b0;",
        4,
        "surprise_is_told",
    ),
    (
        "an earlier job's request is this one's",
        "leftover_request <= request_stays & (start | leftover_request);",
        "leftover_request <= request_stays & leftover_request;",
        6,
        "leftover_is_right",
    ),
    ("idle with responses to come", "assign idle = ~|outstanding & ", "assign idle = ", 5, "idle_is_right"),
    ("lines go out before they came", "came[0] & ~two_valid;", "~two_valid;", 4, "only_filled"),
    ("no epoch in tags", "rd_req_tag <= {epoch, next_slot};", "rd_req_tag <= {4'd0, next_slot};", 4, "of_this_job"),
    ("every other line is read", "(next_address + 58'd1)", "(next_address + 58'd2)", 4, "in_order"),
    (
        "an address that is too new",
        "if (issue) rd_req_address <= next_address;",
        "if (run) rd_req_address <= next_address;",
        5,
        "address",
    ),
    ("lines counted twice", "(lines_to_request - 32'd1)", "(lines_to_request - 32'd2)", 4, "each_once"),
    ("requests do not wait", "rd_req_valid <= issue | request_stays;", "rd_req_valid <= issue;", 5, "stable"),
];

const DISPATCHER: Rows = &[
    (
        "a line counts as nine",
        "line_valid ? (stored + 4'd1) : (stored - 4'd1)",
        "line_valid ? (stored + 4'd9) : (stored - 4'd1)",
        3,
        "fifo_fits",
    ),
    ("stored but not counted", "if (start | (line_valid ^ take)) stored", "if (start | take) stored", 3, "fifo_counts"),
    ("ready for a line that has left", "(stored[0] & ~take)", "stored[0]", 4, "ready_is_right"),
    (
        "requests without a free slot",
        "run & ~(~oldest_goes & (reserved[2] | (&reserved[1:0] & goes)));",
        "run;",
        9,
        "never_more",
    ),
    (
        "sends as the last slot is taken",
        "(reserved[2] | (&reserved[1:0] & goes))",
        "reserved[2]",
        8,
        "sends_a_free_slot",
    ),
    ("tags are used again", "next_slot <= start ? 2'd0 : (next_slot + 2'd1);", "next_slot <= 2'd0;", 6, "tag_free"),
    (
        "slots begin anywhere",
        "next_slot <= start ? 2'd0 : (next_slot + 2'd1);",
        "next_slot <= next_slot + 2'd1;",
        2,
        "slots_in_order",
    ),
    (
        "slots are freed by earlier jobs",
        "answered <= is_awaited & ~start;",
        "answered <= wr_rsp_valid & ~start;",
        3,
        "slots_are_right",
    ),
    ("freed when asked for", "answered ? (4'd1 << arrived_age) : 4'd0", "wr_req_valid ? 4'd1 : 4'd0", 6, "come_once"),
    (
        "acknowledgements to earlier jobs count",
        "wire is_current = wr_rsp_valid & (response_epoch == epoch);",
        "wire is_current = wr_rsp_valid;",
        7,
        "awaited_is_right",
    ),
    ("acknowledgements are not counted", "(goes ^ answered)", "goes", 8, "none_lost"),
    (
        "an acknowledgement that nobody waits for is no error",
        "unexpected <= run & is_current & ~is_awaited & ~start;",
        "unexpected <= 1'b0;",
        4,
        "surprise_is_told",
    ),
    (
        "an earlier job's request is this one's",
        "leftover_request <= request_stays & (start | leftover_request);",
        "leftover_request <= request_stays & leftover_request;",
        7,
        "leftover_is_right",
    ),
    ("idle with acknowledgements to come", "assign idle = ~|outstanding & ", "assign idle = ", 6, "idle_is_right"),
    ("every other line is written", "(next_address + 58'd1)", "(next_address + 58'd2)", 5, "in_order"),
    (
        "an address that is too new",
        "if (goes) wr_req_address <= next_address;",
        "if (run) wr_req_address <= next_address;",
        6,
        "address",
    ),
    ("requests do not wait", "wr_req_valid <= goes | request_stays;", "wr_req_valid <= goes;", 6, "stable"),
];

pub const TABLES: &[(&str, &str, Rows)] =
    &[("collector", "contact_afu_collector.v", COLLECTOR), ("dispatcher", "contact_afu_dispatcher.v", DISPATCHER)];
