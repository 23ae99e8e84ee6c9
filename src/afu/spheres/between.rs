//! What goes from one stage of the search to the next one, through a queue.

use super::{ROW, ROW_NUMBER_BITS, SLACK};
use crate::afu::queue::queue;
use crate::hdl::{BuildErrors, Graph, Instantiated, Signal};

/// Inputs, with names that live long enough.
pub(super) fn named<'n, 'g>(inputs: &'n [(String, Signal<'g>)]) -> impl Iterator<Item = (&'n str, Signal<'g>)> {
    inputs.iter().map(|(name, signal)| (name.as_str(), *signal))
}

/// A queue between two stages.
pub(super) fn stage_queue<'g>(
    graph: &'g Graph,
    start: Signal<'g>,
    (name, depth): (&str, u32),
    put: Signal<'g>,
    parts: &[Signal<'g>],
    take: Signal<'g>,
) -> Result<Instantiated<'g>, BuildErrors> {
    let word = Signal::join(parts);
    let module = queue(depth, word.width(), SLACK)?;
    Ok(graph.instance(name, &module, &[("start", start), ("put", put), ("word", word), ("take", take)]))
}

/// What a stage puts into its queue: the row that is searched, a place of these parts, a mask, and whether it is the
/// last of its row.
pub(super) fn parts<'g>(stage: &Instantiated<'g>, place: &[&str]) -> Vec<Signal<'g>> {
    ["row"].iter().chain(place).chain(&["mask", "last"]).map(|part| stage.output(part)).collect()
}

/// What stands at the output of a queue between two stages.
pub(super) struct Parts<'g> {
    pub(super) valid: Signal<'g>,
    pub(super) row: Signal<'g>,
    pub(super) place: Option<Signal<'g>>,
    pub(super) mask: Signal<'g>,
    pub(super) last: Signal<'g>,
}

impl<'g> Parts<'g> {
    pub(super) fn of(queue: &Instantiated<'g>) -> Self {
        Self::new(queue, ROW)
    }

    /// With a mask of so many bits.
    pub(super) fn new(queue: &Instantiated<'g>, mask_bits: u32) -> Self {
        let word = queue.output("oldest");
        let place_bits = word.width() - 1 - mask_bits - ROW_NUMBER_BITS;
        Self {
            valid: queue.output("valid"),
            row: word.high(ROW_NUMBER_BITS),
            place: (place_bits > 0).then(|| word.slice(1 + mask_bits, place_bits)),
            mask: word.slice(1, mask_bits),
            last: word.bit(0),
        }
    }
}
