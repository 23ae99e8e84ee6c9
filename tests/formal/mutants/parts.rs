//! Faults that the parts alone show.

use super::Rows;

const COLLECTOR: Rows = &[
    ("reads without a free slot", "wire slot_free = ~reserved[2];", "wire slot_free = 1'b1;", 11, "never_more"),
    (
        "slots begin anywhere",
        "next_slot <= start ? 2'd0 : (next_slot + {1'b0, issue});",
        "next_slot <= next_slot + {1'b0, issue};",
        9,
        "slots_in_order",
    ),
    (
        "responses to earlier jobs fill slots",
        "wire [3:0] arrived = response ?",
        "wire [3:0] arrived = rd_rsp_valid ?",
        9,
        "one_of_three",
    ),
    ("slots stay filled", "((filled | arrived) & ~left)", "(filled | arrived)", 10, "none_lost"),
    (
        "responses to earlier jobs count",
        "assign response = rd_rsp_valid & (response_epoch == epoch);",
        "assign response = rd_rsp_valid;",
        9,
        "counted",
    ),
    ("idle with responses to come", "assign idle = ~|outstanding & ", "assign idle = ", 9, "idle_is_right"),
    (
        "lines go out before they came",
        "line_valid <= ~start & |(filled & (4'd1 << next_head));",
        "line_valid <= ~start & |(filled & (4'd1 << head));",
        11,
        "only_filled",
    ),
    ("no epoch in tags", "rd_req_tag <= {epoch, next_slot};", "rd_req_tag <= {4'd0, next_slot};", 9, "of_this_job"),
    ("every other line is read", "(next_address + 58'd1)", "(next_address + 58'd2)", 9, "in_order"),
    (
        "an address that is too new",
        "if (issue) rd_req_address <= next_address;",
        "if (run) rd_req_address <= next_address;",
        9,
        "address",
    ),
    ("lines counted twice", "(lines_to_request - 32'd1)", "(lines_to_request - 32'd2)", 9, "each_once"),
    (
        "requests do not wait",
        "rd_req_valid <= issue | (rd_req_valid & ~rd_req_ready);",
        "rd_req_valid <= issue;",
        9,
        "stable",
    ),
];

const DISPATCHER: Rows = &[
    (
        "a line counts as five",
        "stored <= start ? 3'd0 : (left + {2'd0, line_valid});",
        "stored <= start ? 3'd0 : (left + {line_valid, 1'b0, line_valid});",
        9,
        "fifo_fits",
    ),
    (
        "stored but not counted",
        "stored <= start ? 3'd0 : (left + {2'd0, line_valid});",
        "stored <= start ? 3'd0 : left;",
        9,
        "fifo_counts",
    ),
    ("ready for a line that has left", "ready <= ~start & |left;", "ready <= ~start & |stored;", 9, "ready_is_right"),
    (
        "tags are used again",
        "wire slot_free = ~|(busy_slots & next_slot_one_hot);",
        "wire slot_free = 1'b1;",
        14,
        "tag_free",
    ),
    (
        "slots are freed by earlier jobs",
        "wire [3:0] freed = response ?",
        "wire [3:0] freed = wr_rsp_valid ?",
        10,
        "slots_are_right",
    ),
    (
        "acknowledgements to earlier jobs count",
        "assign response = wr_rsp_valid & (response_epoch == epoch);",
        "assign response = wr_rsp_valid;",
        10,
        "none_lost",
    ),
    ("idle with acknowledgements to come", "assign idle = ~|outstanding & ", "assign idle = ", 10, "idle_is_right"),
    ("every other line is written", "(next_address + 58'd1)", "(next_address + 58'd2)", 10, "in_order"),
    (
        "an address that is too new",
        "if (take) wr_req_address <= next_address;",
        "if (run) wr_req_address <= next_address;",
        10,
        "address",
    ),
    (
        "requests do not wait",
        "wr_req_valid <= take | (wr_req_valid & ~wr_req_ready);",
        "wr_req_valid <= take;",
        10,
        "stable",
    ),
];

pub const TABLES: &[(&str, &str, Rows)] =
    &[("collector", "contact_afu_collector.v", COLLECTOR), ("dispatcher", "contact_afu_dispatcher.v", DISPATCHER)];
