//! Faults where rows enter the search, in its deciders, and where their answers are joined.

use super::Rows;

const DECIDER: Rows = &[
    (
        "a candidate is decided again",
        "takes ? item_bit : next_bit;",
        "takes ? item_bit : walked_bit;",
        5,
        "share_in_hand",
    ),
    (
        "the next step's bit is another one's",
        "takes ? item_rest : next_rest;",
        "takes ? item_rest : rest;",
        5,
        "rest_in_hand",
    ),
    ("there is one step more", "takes ? |item_rest : |next_rest", "takes ? |item_rest : |rest", 5, "last_in_hand"),
    ("a share is decided for ever", "takes ? item_rest : next_rest;", "takes ? item_rest : rest;", 6, "oldest_leaves"),
    ("the places of the next share", "if (takes) about", "if (shares_valid) about", 5, "places_in_hand"),
    (
        "a decider takes a share that is not there",
        "takes = shares_valid & (~active | ends)",
        "takes = ~active | (shares_valid & ends)",
        2,
        "some_are_left",
    ),
    ("another column's sphere", "{about[11:0], candidate}", "{about[11:0], ~candidate}", 4, "first_sphere"),
    ("another sphere of the row", "place_in_row = about[15:12]", "place_in_row = about[14:11]", 4, "second_sphere"),
    (
        "an answer for each candidate",
        "answer_comes <= share_ends & ~start;",
        "answer_comes <= decided[11] & ~start;",
        17,
        "answered_once",
    ),
    (
        "more answers than shares",
        "answer_comes <= share_ends & ~start;",
        "answer_comes <= decided[11] & ~start;",
        18,
        "conserved",
    ),
    (
        "only the last candidate is answered",
        "answer_put <= answer_now;",
        "answer_put <= candidate_then_if_kernel_hit;",
        18,
        "answer_is_right",
    ),
    (
        "the hits of the share before",
        "start | (decided[11] ? is_last_then : is_fresh)",
        "start | (is_fresh & ~decided[11])",
        17,
        "fresh_is_right",
    ),
    (
        "a share waits for a cycle",
        "takes = shares_valid & (~active | ends)",
        "takes = shares_valid & ~active",
        4,
        "takes_at_once",
    ),
    (
        "a decider forgets the share in hand",
        "takes = shares_valid & (~active | ends)",
        "takes = shares_valid",
        5,
        "none_is_lost",
    ),
    (
        "an answer for each candidate fills the queue",
        "answer_comes <= share_ends & ~start;",
        "answer_comes <= decided[11] & ~start;",
        82,
        "answers_fit",
    ),
];

const SHARES: Rows = &[
    (
        "a share is lost as the next one comes",
        "(reads | (oldest_valid & ~take))",
        "(reads & ~put | (oldest_valid & ~take))",
        3,
        "none_is_lost",
    ),
    ("a share counts twice", "(waiting + {6'd0, put})", "(waiting + {5'd0, put, 1'd0})", 36, "shares_fit"),
    ("half as many places for shares", "(tail + 6'd1)", "{1'b0, tail[4:0] + 5'd1}", 33, "shares_in_place"),
];

const ANSWERS: Rows =
    &[("places for eight answers", "(tail + 6'd1)", "{3'd0, tail[2:0] + 3'd1}", 25, "answers_in_place")];

const STEPS: Rows = &[
    ("steps have room for one too many", "words_inside < 7'd55", "words_inside < 7'd56", 66, "room_is_right"),
    ("a step counts twice", "(waiting + {6'd0, put})", "(waiting + {5'd0, put, 1'd0})", 11, "bounded"),
    (
        "a step counts twice, and there is room",
        "(waiting + {6'd0, put})",
        "(waiting + {5'd0, put, 1'd0})",
        39,
        "enough",
    ),
    ("a step counts twice, and is put", "(waiting + {6'd0, put})", "(waiting + {5'd0, put, 1'd0})", 43, "steps_fit"),
    ("places for eight steps", "(tail + 6'd1)", "{3'd0, tail[2:0] + 3'd1}", 18, "in_place"),
];

const ASKED: Rows =
    &[("a decider gets a share without a step", "(box_pairs_put & asked_0)", "(asked_0)", 2, "oldest_first")];

const ASKED_SINCE: Rows =
    &[("more shares than steps", "(box_pairs_put & asked_0)", "(asked_0)", 13, "no_more_than_steps")];

const ANSWERED: Rows = &[(
    "an answer is taken for a step that did not ask",
    "take_answer_0 = step_leaves & asked[0]",
    "take_answer_0 = step_leaves",
    13,
    "few_shares",
)];

const TOLD: Rows =
    &[("a step remembers the other decider", "last, asks_1, asks_0}", "last, asks_0, asks_1}", 11, "step_for_step")];

const FORK: Rows = &[
    (
        "the end of a row is not told to the join",
        ".put            (box_pairs_put)",
        ".put            (box_pairs_put & ~box_pairs_last)",
        1,
        "step_is_told",
    ),
    ("a decider is asked about nothing", "(box_pairs_put & asked_0)", "(box_pairs_put)", 1, "first_is_asked"),
    (
        "only one decider is asked",
        "(box_pairs_put & asked_1)",
        "(box_pairs_put & asked_1 & ~asked_0)",
        1,
        "second_is_asked",
    ),
    (
        "the join waits for the wrong decider",
        ".asks_1         (asked_1)",
        ".asks_1         (asked_0)",
        1,
        "asked_is_told",
    ),
];

const JOIN: Rows = &[
    ("a step does not wait for an answer", "answer_valid_1 | ~asked[1]", "1'b1", 1, "all_have_answered"),
    (
        "a step waits for an answer that it did not ask for",
        "answer_valid_1 | ~asked[1]",
        "answer_valid_1",
        1,
        "leaves_at_once",
    ),
    (
        "the answer to a later step is taken",
        "take_answer_0 = step_leaves & asked[0]",
        "take_answer_0 = step_leaves",
        1,
        "first_is_taken",
    ),
    (
        "an answer is taken before its step leaves",
        "take_answer_1 = step_leaves & asked[1]",
        "take_answer_1 = step_queue_valid & asked[1]",
        1,
        "second_is_taken",
    ),
    ("the hits of a later step", "asked[0] ? answer_0 : 8'd0", "answer_0", 1, "answers_are_joined"),
    (
        "the second of two steps with hits is lost",
        "{step_put[1:0], step_matters}",
        "{step_put[1:0], step_matters & ~step_put[0]}",
        5,
        "put_once",
    ),
    (
        "a step gets the hits of the next one",
        "hits_put <= hits_of_step_d2;",
        "hits_put <= hits_counted;",
        4,
        "put_is_right",
    ),
    ("the same hits leave again", "takes ? item_bit : next_bit;", "takes ? item_bit : walked_bit;", 3, "step_in_hand"),
    (
        "the next step's bit is another one's",
        "takes ? item_rest : next_rest;",
        "takes ? item_rest : rest;",
        3,
        "rest_in_hand",
    ),
    ("there is one step more", "takes ? |item_rest : |next_rest", "takes ? |item_rest : |rest", 3, "last_in_hand"),
    ("hits leave for ever", "takes ? item_rest : next_rest;", "takes ? item_rest : rest;", 4, "hits_leave"),
    (
        "the end of a row is lost behind the join",
        "about <= hit_queue_oldest[53:4]",
        "about <= {hit_queue_oldest[53:26], 1'b0, hit_queue_oldest[24:4]}",
        2,
        "about_step",
    ),
    (
        "a step that is not there has hits",
        "takes = hit_queue_valid & (~active | ends)",
        "takes = ~active | (hit_queue_valid & ends)",
        2,
        "hits_in_hand",
    ),
    (
        "a step with hits waits for a cycle",
        "takes = hit_queue_valid & (~active | ends)",
        "takes = hit_queue_valid & ~active",
        2,
        "takes_at_once",
    ),
    ("a hit too many", "{1'b0, beat_shifted_2} < step", "{1'b0, beat_shifted_2} <= step", 7, "each_hit_once"),
    (
        "a hit has the number of a sphere that does not touch",
        "step_numbered[11:0], hit_0_unit_number}",
        "step_numbered[11:0], ~hit_0_unit_number}",
        8,
        "hit_is_in_step",
    ),
    (
        "a hit in the place of another",
        "step_numbered[11:0], hit_0_unit_number}",
        "step_numbered[11:0], hit_1_unit_number}",
        8,
        "hits_in_order",
    ),
    (
        "a hit with another step's rows",
        "step_numbered <= step_numbered_line[oldest_of_3];",
        "step_numbered <= step_numbered_line[newest_of_3];",
        8,
        "numbers_are_right",
    ),
    (
        "a row ends with each four hits",
        "ends_row <= steps & (is_last & about[21])",
        "ends_row <= steps & about[21]",
        3,
        "row_ends_once",
    ),
    (
        "more rows end than came",
        "ends_row <= steps & (is_last & about[21])",
        "ends_row <= steps & about[21]",
        4,
        "conserved",
    ),
    (
        "four hits count as one",
        "run ? count_of_hits : 3'd0",
        "run ? {2'd0, |count_of_hits} : 3'd0",
        9,
        "contacts_counted_once",
    ),
];

const LOADER: Rows = &[
    (
        "a column passes without a sphere",
        "if (start | goes) column_now",
        "if (start | any_lines_waiting) column_now",
        4,
        "row_is_whole",
    ),
    ("a row counts as nine", "rows_inside + 5'd1", "rows_inside + 5'd9", 20, "never_more"),
    (
        "a row that ends as another begins",
        "(row_begins ^ row_ends) ?",
        "(row_begins | row_ends) ?",
        29,
        "inside_is_right",
    ),
    ("every other row", "row_now + 12'd1", "row_now + 12'd2", 19, "row_is_right"),
    (
        "rows of the table count as searched",
        "row_begins = goes & is_searched & ~column_now_any",
        "row_begins = goes & ~column_now_any",
        4,
        "none_before",
    ),
    (
        "a row of eight spheres",
        "row_loaded = goes & column_now_all;",
        "row_loaded = goes & &column_now[2:0];",
        11,
        "whole_rows",
    ),
    (
        "a row waits for the one before",
        "~rows_inside[4] | row_ends",
        "~rows_inside[0] | row_ends",
        28,
        "rows_let_it_go",
    ),
    ("an empty set has a row", "counts_spheres      ? |spheres_left", "counts_spheres      ? 1'b1", 5, "some_are_left"),
    ("a line of the job before", " any_lines_waiting <= ~start & ", " any_lines_waiting <= ", 8, "no_line_yet"),
    ("the end before the last row", "set_ended & ~|rows_inside &", "set_ended &", 30, "all_are_out"),
];

const ROWS: Rows = &[
    (
        "a row is launched as the next one",
        "launched_row <= group_row;",
        "launched_row <= complete_row;",
        27,
        "launched_in_order",
    ),
    (
        "a row is launched again and again",
        "{launching[0], row_of_search}",
        "{|launching, row_of_search}",
        28,
        "launched_once",
    ),
    (
        "a row is complete too early",
        "row_complete <= box_comes & &column_in_hand & ~start",
        "row_complete <= box_comes & &column_in_hand[3:1] & ~start",
        27,
        "conserved",
    ),
    ("a row is launched in each cycle", "{launching[0], row_of_search}", "2'd3", 20, "none_ends_early"),
];

const CONTROL: Rows = &[
    ("a job begins while another runs", "accept = start & ~busy_copy_0", "accept = start", 4, "not_while_another_runs"),
    ("the join begins later", "begin_job_copy_3 <= begins;", "begin_job_copy_3 <= begin_job;", 3, "together"),
    (
        "a start while a job runs changes its sets",
        "if (takes_values) has_others",
        "if (start) has_others",
        4,
        "sets_stay",
    ),
    (
        "a refused job begins in part",
        "begin_job <= begins;",
        "begin_job <= begins & ~has_unknown_mode;",
        3,
        "begins_as_one",
    ),
    ("a copy of busy is none", "busy_copy_1 <= is_busy;", "busy_copy_1 <= running;", 2, "busy_as_one"),
    (
        "idle before the last line has left",
        "(busy_copy_0 & ~completes & ~drained)",
        "(busy_copy_0 & ~packer_done & ~drained)",
        3,
        "runs_while_busy",
    ),
    (
        "a job runs on as it ends",
        "goes_on = running & ~completes & ~failing",
        "goes_on = running & ~completes",
        3,
        "runs_or_drains",
    ),
    (
        "a job that failed waits to begin",
        "keeps_waiting = waits_to_begin & ~failing",
        "keeps_waiting = waits_to_begin",
        3,
        "waits_before",
    ),
    (
        "a job completes that did not run",
        "completes <= run & packer_done",
        "completes <= packer_done",
        3,
        "completes_at_the_end",
    ),
    (
        "a job runs that was refused",
        "run <= (run | begin_job) & goes_on;",
        "run <= begin_job | (run & goes_on);",
        4,
        "runs_to_its_end",
    ),
];

pub const TABLES: &[(&str, &str, Rows)] = &[
    ("decider", "contact_afu_decider.v", DECIDER),
    ("decider", "queue_64x28_slack_8.v", SHARES),
    ("decider", "queue_64x8_slack_8.v", ANSWERS),
    ("shares of a decider", "queue_64x31_slack_8.v", STEPS),
    ("shares of a decider", "contact_afu.v", ASKED),
    ("shares of a decider", "contact_afu_hits.v", ANSWERED),
    ("shares of any step", "contact_afu.v", ASKED_SINCE),
    ("shares of any step", "contact_afu_hits.v", TOLD),
    ("join of deciders", "contact_afu.v", FORK),
    ("join of deciders", "contact_afu_hits.v", JOIN),
    ("entry of rows", "contact_afu_loader.v", LOADER),
    ("entry of rows", "contact_afu_rows.v", ROWS),
    ("begin of a job", "contact_afu_control.v", CONTROL),
];
