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

pub const TABLES: &[(&str, &str, Rows)] = &[("queue", FILE, QUEUE), ("order in a queue", FILE, ORDER)];
