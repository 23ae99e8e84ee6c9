//! Faults that the parts alone show.

use super::Rows;

const COLLECTOR: Rows = &[
    ("reads without a free slot", "wire slot_free = ~reserved[2];", "wire slot_free = 1'b1;", 7, "never_more"),
    (
        "slots begin anywhere",
        "next_slot <= start ? 2'd0 : (next_slot + {1'b0, issue});",
        "next_slot <= next_slot + {1'b0, issue};",
        5,
        "slots_in_order",
    ),
    (
        "filled when asked for",
        "wire [3:0] arrived = response ? (4'd1 << response_slot) : 4'd0;",
        "wire [3:0] arrived = rd_req_valid ? (4'd1 << rd_req_tag[1:0]) : 4'd0;",
        4,
        "one_of_three",
    ),
    ("slots stay filled", "((filled | arrived) & ~left)", "(filled | arrived)", 7, "none_lost"),
    (
        "responses to earlier jobs count",
        "assign response = rd_rsp_valid & (response_epoch == epoch);",
        "assign response = rd_rsp_valid;",
        3,
        "counted",
    ),
    ("idle with responses to come", "assign idle = ~|outstanding & ", "assign idle = ", 4, "idle_is_right"),
    (
        "lines go out before they came",
        "line_valid <= ~start & |(filled & (4'd1 << next_head));",
        "line_valid <= ~start & |(filled & (4'd1 << head));",
        8,
        "only_filled",
    ),
    ("no epoch in tags", "rd_req_tag <= {epoch, next_slot};", "rd_req_tag <= {4'd0, next_slot};", 3, "of_this_job"),
    ("every other line is read", "(next_address + 58'd1)", "(next_address + 58'd2)", 4, "in_order"),
    (
        "an address that is too new",
        "if (issue) rd_req_address <= next_address;",
        "if (run) rd_req_address <= next_address;",
        4,
        "address",
    ),
    ("lines counted twice", "(lines_to_request - 32'd1)", "(lines_to_request - 32'd2)", 4, "each_once"),
    (
        "requests do not wait",
        "rd_req_valid <= issue | (rd_req_valid & ~rd_req_ready);",
        "rd_req_valid <= issue;",
        4,
        "stable",
    ),
];

const DISPATCHER: Rows = &[
    (
        "a line counts as five",
        "stored <= start ? 3'd0 : (left + {2'd0, line_valid});",
        "stored <= start ? 3'd0 : (left + {line_valid, 1'b0, line_valid});",
        3,
        "fifo_fits",
    ),
    (
        "stored but not counted",
        "stored <= start ? 3'd0 : (left + {2'd0, line_valid});",
        "stored <= start ? 3'd0 : left;",
        3,
        "fifo_counts",
    ),
    ("ready for a line that has left", "ready <= ~start & |left;", "ready <= ~start & |stored;", 5, "ready_is_right"),
    (
        "tags are used again",
        "wire slot_free = ~|(busy_slots & next_slot_one_hot);",
        "wire slot_free = 1'b1;",
        9,
        "tag_free",
    ),
    (
        "slots are freed by earlier jobs",
        "wire [3:0] freed = response ?",
        "wire [3:0] freed = wr_rsp_valid ?",
        5,
        "slots_are_right",
    ),
    (
        "acknowledgements to earlier jobs count",
        "assign response = wr_rsp_valid & (response_epoch == epoch);",
        "assign response = wr_rsp_valid;",
        3,
        "none_lost",
    ),
    ("idle with acknowledgements to come", "assign idle = ~|outstanding & ", "assign idle = ", 6, "idle_is_right"),
    ("every other line is written", "(next_address + 58'd1)", "(next_address + 58'd2)", 6, "in_order"),
    (
        "an address that is too new",
        "if (take) wr_req_address <= next_address;",
        "if (run) wr_req_address <= next_address;",
        6,
        "address",
    ),
    (
        "requests do not wait",
        "wr_req_valid <= take | (wr_req_valid & ~wr_req_ready);",
        "wr_req_valid <= take;",
        6,
        "stable",
    ),
];

pub const TABLES: &[(&str, &str, Rows)] =
    &[("collector", "contact_afu_collector.v", COLLECTOR), ("dispatcher", "contact_afu_dispatcher.v", DISPATCHER)];
