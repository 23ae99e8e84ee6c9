//! A queue: a memory, whose oldest word stands at its output. It is never full when a word comes, because whoever
//! puts words in asked for room first.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, fits_luts};

/// A queue of `depth` (a power of two) words of `width` bits.
///
/// Inputs: `start` empties it, `put` stores `word`, `take` removes the oldest one and may be set only with `valid`.
/// Outputs: `valid`, `oldest`, and `has_room`, a register that is set if at least `slack` more words fit, whatever
/// was put in or taken since. It counts words that left as inside for a cycle.
pub(super) fn queue(depth: u32, width: u32, slack: u32) -> Result<Arc<Module>, BuildErrors> {
    steering_queue(depth, (width, 0), slack)
}

/// As [`queue`]; so many of the lowest bits of the oldest word decide in the same cycle whether it is taken. A block
/// RAM would give these too late in the cycle, so they stand in look-up tables.
pub(super) fn steering_queue(
    depth: u32,
    (width, steering): (u32, u32),
    slack: u32,
) -> Result<Arc<Module>, BuildErrors> {
    let steering = if fits_luts(depth, width) { 0 } else { steering };
    let (apart, early) = match steering {
        0 => (String::new(), String::new()),
        _ => (format!("_steering_{steering}"), format!("; the lowest {steering} bits come early")),
    };
    let graph = Graph::new(format!("queue_{depth}x{width}{apart}_slack_{slack}"));
    graph.about(format!("a queue of {depth} words; has_room: {slack} more fit{early}"));
    let bits = depth.ilog2();
    let start = graph.input("start", 1);
    let put = graph.input("put", 1);
    let take = graph.input("take", 1);
    let tail = graph.register("tail", bits, 0);
    let head = graph.register("head", bits, 0);
    // Words in the memory that were written in earlier cycles; the oldest may stand at the output besides.
    let waiting = graph.register("waiting", bits + 1, 0);
    let valid = graph.register("oldest_valid", 1, 0);
    let reads = (waiting.any() & (!*valid | take)).named("reads");
    let word = graph.input("word", width);
    let words = graph.memory("words", depth, width - steering);
    words.write(put, tail.value(), word.drop_low(steering));
    let mut oldest = words.read_if(reads, head.value());
    if steering > 0 {
        let steers = graph.memory("steering", depth, steering).in_luts();
        steers.write(put, tail.value(), word.low(steering));
        oldest = oldest.concat(steers.read_if(reads, head.value()));
    }
    let oldest = oldest.named("oldest");
    tail.next_if(start | put, start.select(tail.same(0), tail.plus(1)));
    head.next_if(start | reads, start.select(head.same(0), head.plus(1)));
    let [more, fewer] = [put, reads].map(|bit| bit.extend(bits + 1));
    waiting.next(start.select(waiting.same(0), waiting.value() + more - fewer));
    valid.next(!start & (reads | (*valid & !take)));
    // The word at the output counts as inside. A word that is put in this cycle and one that was in the last are not
    // counted yet, so they are part of the slack.
    let inside = (waiting.value() + valid.extend(bits + 1)).named("words_inside");
    let room = inside.less_than(inside.same(u128::from(depth - slack - 1)));
    graph.output("valid", valid.value());
    graph.output("oldest", oldest);
    graph.output("has_room", (room & !start).registered("has_room"));
    graph.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Read from block RAM they would come 4 ns late on an ECP5: the steps of 32 lanes left at 104 MHz.
    #[test]
    fn bits_that_steer_stand_in_look_up_tables() {
        let in_luts = |depth| {
            let queue = steering_queue(depth, (37, 9), 8).unwrap();
            queue.memories.iter().map(|memory| (memory.width, memory.in_luts)).collect::<Vec<_>>()
        };
        assert_eq!(in_luts(64), [(37, true)], "a small queue is one memory");
        assert_eq!(in_luts(128), [(28, false), (9, true)]);
    }
}
