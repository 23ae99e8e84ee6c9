//! Faults of the shell `axi`.

use super::Rows;

const READS: Rows = &[
    (
        "an address does not wait to be taken",
        "arvalid <= burst_closes | (arvalid & ~arready);",
        "arvalid <= burst_closes;",
        7,
        "stable",
    ),
    (
        "a burst begins in the middle of a line",
        "araddr <= {burst_first, 6'd0};",
        "araddr <= {burst_first, 6'd32};",
        6,
        "whole_lines",
    ),
    ("bursts of reads cross 4 KB", " & |rd_address[5:0];", ";", 5, "within_a_page"),
    ("lines are taken without room", " & (complete | ~&lines_expected[3:0])", "", 18, "never_more"),
    (
        "a line joins a burst twice",
        "burst_begins ? 2'd0 : (burst_more + 2'd1)",
        "burst_begins ? 2'd0 : (burst_more + 2'd2)",
        5,
        "in_order",
    ),
];

const READ_LINES: Rows = &[
    (
        "the beats of a line are exchanged",
        "{rdata_heard, beats_before}",
        "{beats_before, rdata_heard}",
        10,
        "right_line",
    ),
    (
        "a failure has the address of a line that waits",
        "failed_address <= oldest[65:8];",
        "failed_address <= waiting_line[58:1];",
        10,
        "right_failure",
    ),
    (
        "a line is complete with its first beat",
        "wire complete = beat & beat_number;",
        "wire complete = beat;",
        9,
        "after_its_beats",
    ),
    (
        "a line that is asked for is not expected",
        "any_lines_expected <= line_accepted | ",
        "any_lines_expected <= ",
        9,
        "nothing_unasked",
    ),
];

const WRITES: Rows = &[
    (
        "a write's address does not wait to be taken",
        "awvalid <= burst_closes | (awvalid & ~awready);",
        "awvalid <= burst_closes;",
        7,
        "address_is_stable",
    ),
    (
        "a beat does not wait to be taken",
        "wvalid <= beat_leaves | (wvalid & ~wready);",
        "wvalid <= beat_leaves;",
        10,
        "data_are_stable",
    ),
    (
        "a write burst begins in the middle of a line",
        "awaddr <= {burst_first, 6'd0};",
        "awaddr <= {burst_first, 6'd32};",
        6,
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
    (
        "WLAST at the end of each line",
        "wlast <= beat_number & leaving_is_last;",
        "wlast <= beat_number;",
        10,
        "last_is_last",
    ),
    (
        "a line is replaced before its last beat has left",
        "burst_leaves & (~line_present | line_leaves)",
        "burst_leaves & (~line_present | beat_leaves)",
        10,
        "every_beat_leaves",
    ),
];

const WRITE_LINES: Rows = &[
    (
        "the second beat is of the next line",
        "if (line_fetched) leaving <= oldest_line;",
        "leaving <= oldest_line;",
        10,
        "right_beats",
    ),
    (
        "an acknowledgement has the tag of the one before",
        "oldest <= taken[next_tag_head];",
        "oldest <= taken[tag_head];",
        19,
        "right_acknowledgement",
    ),
    (
        "a failure is reported with every line of its burst",
        "burst_failed <= first_line & failure_any;",
        "burst_failed <= acknowledged & failure_any;",
        17,
        "right_failure",
    ),
    (
        "a response acknowledges four lines",
        "response_turns ? burst[1:0]",
        "response_turns ? 2'd3",
        18,
        "answered_before",
    ),
    (
        "a burst that leaves is not in flight",
        "any_bursts_in_flight <= burst_closes | ",
        "any_bursts_in_flight <= ",
        13,
        "nothing_unasked",
    ),
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

pub const TABLES: &[(&str, &str, Rows)] = &[
    ("axi_reads", "axi_read.v", READS),
    ("a read's whole way", "axi_read.v", READ_LINES),
    ("axi_writes", "axi_write.v", WRITES),
    ("a write's whole way", "axi_write.v", WRITE_LINES),
    ("axi_lite", "axi_control.v", LITE),
];
