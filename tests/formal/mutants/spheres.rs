//! Faults of the search among spheres.

use super::Rows;

const FILE: &str = "queue_16x29_slack_8.v";

const QUEUE: Rows = &[
    ("a queue tells of room that it has not", "words_inside < 5'd7", "words_inside < 5'd8", 18, "room_is_right"),
    ("a queue forgets the word at its output", "waiting + {4'd0, oldest_valid};", "waiting;", 18, "room_is_right"),
    (
        "a queue has room while it is full",
        "has_room <= (words_inside < 5'd7) & ~start;",
        "has_room <= ~start;",
        27,
        "never_full",
    ),
    (
        "a queue has room for more than comes",
        "has_room <= (words_inside < 5'd7) & ~start;",
        "has_room <= ~start;",
        19,
        "enough",
    ),
    ("a word is written twice", "tail + 4'd1", "tail + 4'd2", 11, "counted"),
    ("a word counts twice", "(waiting + {4'd0, put})", "(waiting + {3'd0, put, 1'd0})", 11, "bounded"),
];

const ORDER: Rows = &[
    ("a queue gives the newest word", "oldest <= words[head];", "oldest <= words[tail];", 12, "in_order"),
    (
        "a word is lost as the next one comes",
        "(reads | (oldest_valid & ~take))",
        "(reads & ~put | (oldest_valid & ~take))",
        12,
        "none_lost",
    ),
];

const GROUPS: Rows = &[
    ("a row's number comes early", "row <= row_line[oldest_of_5];", "row <= row_line[newest_of_5];", 8, "in_order"),
    ("a token leaves with each step", "is_last & about[0]}", "about[0]}", 9, "conserved"),
    (
        "the same word is looked at again",
        "takes ? item_bit : next_bit;",
        "takes ? item_bit : walked_bit;",
        3,
        "hand_is_right",
    ),
    (
        "the next step's bit is another one's",
        "takes ? item_rest : next_rest;",
        "takes ? item_rest : rest;",
        3,
        "rest_in_hand",
    ),
    ("there is one step more", "takes ? |item_rest : |next_rest", "takes ? |item_rest : |rest", 3, "last_in_hand"),
    ("a row never ends", "takes ? item_rest : next_rest;", "takes ? item_rest : rest;", 4, "oldest_leaves"),
    ("a token is dropped", "about <= {item_row, item_last}", "about <= {item_row, 1'b0}", 2, "token_in_hand"),
    (
        "an item changes its row",
        "about <= {item_row, item_last}",
        "about <= {item_row + 12'd1, item_last}",
        2,
        "row_in_hand",
    ),
    (
        "takes an item that is not there",
        "takes = item_valid & (~active | ends)",
        "takes = ~active | (item_valid & ends)",
        1,
        "takes_what_is_there",
    ),
    (
        "the item that is not there has a row",
        "takes = item_valid & (~active | ends)",
        "takes = ~active | (item_valid & ends)",
        2,
        "hand_row_is_right",
    ),
    (
        "an item waits for a cycle",
        "takes = item_valid & (~active | ends)",
        "takes = item_valid & ~active",
        2,
        "takes_at_once",
    ),
    (
        "what is found right after another is lost",
        "put <= puts & ~start;",
        "put <= puts & ~put & ~start;",
        9,
        "each_step_once",
    ),
    (
        "only a step that finds something ends a row",
        "last <= ends_row;",
        "last <= ends_row & |found_in_word;",
        8,
        "token_is_last",
    ),
    ("a row without words finds something", "had_bit <= had_bit_line[3];", "had_bit <= 1'b1;", 8, "none_without_bit"),
    (
        "the number of the next word",
        "word_then <= word_then_line[11:8];",
        "word_then <= word_then_line[7:4];",
        8,
        "bits_in_order",
    ),
];

const NEAR: Rows = &[("a turn too few", "mask <= turns;", "mask <= {1'b0, turns[15:1]};", 9, "turns_are_right")];

const BOX_PAIRS: Rows = &[
    ("a sphere is left out", "about <= {item_near,", "about <= {item_near[15:1], 1'b0,", 2, "near_in_hand"),
    (
        "the place of the next sphere",
        "places <= place_compared_0;",
        "places <= place_compared_0_line[11:8];",
        10,
        "next_near",
    ),
    ("what was not put is counted", "(put & run) ? count_0", "run ? count_0", 6, "counted_once"),
];

pub const TABLES: &[(&str, &str, Rows)] = &[
    ("queue", FILE, QUEUE),
    ("order in a queue", FILE, ORDER),
    ("groups", "contact_afu_groups.v", GROUPS),
    ("near", "contact_afu_near.v", NEAR),
    ("box against box", "contact_afu_candidates.v", BOX_PAIRS),
];
