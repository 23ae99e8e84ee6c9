//! Faults of the shell `axi`.

use super::Rows;

const READS: Rows = &[
    (
        "an address does not wait to be taken",
        "arvalid <= burst_closes | (arvalid & ~arready);",
        "arvalid <= burst_closes;",
        5,
        "stable",
    ),
    (
        "a burst begins in the middle of a line",
        "araddr <= {burst_first, 6'd0};",
        "araddr <= {burst_first, 6'd32};",
        4,
        "whole_lines",
    ),
    ("bursts of reads cross 4 KB", " & |rd_address[5:0];", ";", 5, "within_a_page"),
    ("lines are taken without room", "wire line_ready = ~lines_expected[4] & ", "wire line_ready = ", 18, "never_more"),
    (
        "a line joins a burst twice",
        "burst_begins ? 2'd0 : (burst_more + 2'd1)",
        "burst_begins ? 2'd0 : (burst_more + 2'd2)",
        5,
        "in_order",
    ),
];

const WRITES: Rows = &[
    (
        "a write's address does not wait to be taken",
        "awvalid <= burst_closes | (awvalid & ~awready);",
        "awvalid <= burst_closes;",
        5,
        "address_is_stable",
    ),
    (
        "a beat does not wait to be taken",
        "wvalid <= beat_leaves | (wvalid & ~wready);",
        "wvalid <= beat_leaves;",
        7,
        "data_are_stable",
    ),
    (
        "a write burst begins in the middle of a line",
        "awaddr <= {burst_first, 6'd0};",
        "awaddr <= {burst_first, 6'd32};",
        4,
        "whole_lines",
    ),
    ("bursts of writes cross 4 KB", " & |wr_address[5:0];", ";", 5, "within_a_page"),
    (
        "a written line joins a burst twice",
        "burst_begins ? 2'd0 : (burst_more + 2'd1)",
        "burst_begins ? 2'd0 : (burst_more + 2'd2)",
        5,
        "in_order",
    ),
    (
        "a burst of one line always leaves",
        "next_burst_more <= burst_more;",
        "next_burst_more <= 2'd0;",
        6,
        "all_are_there",
    ),
    ("WLAST at the end of each line", "wlast <= burst_ends;", "wlast <= beat_number;", 9, "last_is_last"),
];

const LITE: Rows = &[
    (
        "a response does not wait to be taken",
        "write_answered <= register_written | (write_answered & ~s_axi_control_bready);",
        "write_answered <= register_written;",
        5,
        "response_is_stable",
    ),
    (
        "a register's value does not wait to be taken",
        "read_answered <= register_read | (read_answered & ~read_leaves);",
        "read_answered <= register_read;",
        5,
        "data_are_stable",
    ),
    (
        "a response without the data",
        "wire register_written = write_address_held & write_data_held & ~write_answered;",
        "wire register_written = write_address_held & ~write_answered;",
        4,
        "one_response",
    ),
    (
        "a read is taken during a read",
        "read_busy <= read_taken | (read_busy & ~read_leaves);",
        "read_busy <= read_taken;",
        4,
        "data_once",
    ),
    (
        "a response is an error",
        "assign s_axi_control_bresp = 2'd0;",
        "assign s_axi_control_bresp = 2'd2;",
        1,
        "is_okay",
    ),
];

pub const TABLES: &[(&str, &str, Rows)] =
    &[("axi_reads", "axi_read.v", READS), ("axi_writes", "axi_write.v", WRITES), ("axi_lite", "axi_control.v", LITE)];
