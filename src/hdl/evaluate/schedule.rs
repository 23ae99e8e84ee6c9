//! Orders steps so that operands come first and steps of one kind are together, and gives every word its place:
//! constants, pins, state, then the results of the steps in their order.

use super::lower::{Lowered, Source, Word};
use super::tape::{KINDS, Kind, Step, Tape};

/// The places of the words.
#[derive(Debug)]
pub(super) struct Layout {
    pub tape: Tape,
    /// All words at the start: constants set, the rest zero.
    pub words: Vec<u64>,
    /// By word before scheduling: its place.
    pub place: Vec<u32>,
    /// Index of the first word of state.
    pub state: usize,
}

/// `state` are the words of state elements in the order in which they shall lie.
pub(super) fn schedule(lowered: &Lowered, state: &[Word]) -> Layout {
    let mut place = vec![0; lowered.sources.len()];
    let mut words = Vec::with_capacity(lowered.sources.len());
    for (index, source) in lowered.sources.iter().enumerate() {
        if let Source::Constant(value) = source {
            place[index] = words.len() as u32;
            words.push(*value);
        }
    }
    for (index, source) in lowered.sources.iter().enumerate() {
        if let Source::Pin = source {
            place[index] = words.len() as u32;
            words.push(0);
        }
    }
    let first_state = words.len();
    for &word in state {
        place[word as usize] = words.len() as u32;
        words.push(0);
    }

    let order = order(lowered);
    let mut tape = Tape { first: words.len(), ..Tape::default() };
    for (kind, word) in order {
        let Source::Step(_, step) = lowered.sources[word as usize] else { continue };
        place[word as usize] = words.len() as u32;
        words.push(0);
        let at = |word: Word| place[word as usize];
        let index = tape.steps.len();
        tape.steps.push(Step { a: at(step.a), b: at(step.b), c: at(step.c), immediate: step.immediate });
        match tape.runs.last_mut() {
            Some((last, range)) if *last == kind => range.end = index + 1,
            _ => tape.runs.push((kind, index..index + 1)),
        }
    }
    Layout { tape, words, place, state: first_state }
}

/// Greedy: chooses the kind with the most ready steps, and continues with it until none is ready.
fn order(lowered: &Lowered) -> Vec<(Kind, Word)> {
    let count = lowered.sources.len();
    let is_step = |word: Word| matches!(lowered.sources[word as usize], Source::Step(..));
    let operands = |word: Word| match lowered.sources[word as usize] {
        Source::Step(_, step) => [step.a, step.b, step.c],
        _ => [word; 3],
    };
    // Users of each step, in one array: those of word w are users[start[w]..start[w + 1]].
    let mut waiting = vec![0_u8; count];
    let mut start = vec![0_u32; count + 1];
    let steps = || (0..count as Word).filter(|&word| is_step(word));
    for word in steps() {
        for operand in operands(word) {
            if is_step(operand) {
                waiting[word as usize] += 1;
                start[operand as usize + 1] += 1;
            }
        }
    }
    for index in 0..count {
        start[index + 1] += start[index];
    }
    let mut fill = start.clone();
    let mut users = vec![0; start[count] as usize];
    for word in steps() {
        for operand in operands(word) {
            if is_step(operand) {
                users[fill[operand as usize] as usize] = word;
                fill[operand as usize] += 1;
            }
        }
    }

    let mut ready: [Vec<(Kind, Word)>; KINDS] = std::array::from_fn(|_| Vec::new());
    let enqueue = |ready: &mut [Vec<(Kind, Word)>; KINDS], word: Word| {
        if let Source::Step(kind, _) = lowered.sources[word as usize] {
            ready[kind as usize].push((kind, word));
        }
    };
    for word in steps().filter(|&word| waiting[word as usize] == 0) {
        enqueue(&mut ready, word);
    }
    let mut order = Vec::new();
    while let Some(most) = (0..KINDS).max_by_key(|&kind| ready[kind].len()).filter(|&kind| !ready[kind].is_empty()) {
        let mut next = 0;
        while next < ready[most].len() {
            let (kind, word) = ready[most][next];
            next += 1;
            order.push((kind, word));
            for &user in &users[start[word as usize] as usize..start[word as usize + 1] as usize] {
                waiting[user as usize] -= 1;
                if waiting[user as usize] == 0 {
                    enqueue(&mut ready, user);
                }
            }
        }
        ready[most].clear();
    }
    order
}
