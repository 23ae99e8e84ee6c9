//! Translates a path of cells into the names of the Verilog source.

use std::collections::HashMap;
use std::sync::Arc;

use super::figures::Hop;
use super::route::Segment;
use super::wrapper::UNIT;
use crate::hdl::Module;

/// What Yosys appends to a signal's name to name a cell at that signal.
const CELLS: [&str; 12] = [
    "_TRELLIS_",
    "_LUT4",
    "_CCU2C",
    "_PFUMX",
    "_L6MUX21",
    "_MULT18X18D",
    "_DP16KD",
    "_PDPW16KD",
    "_ALU54B",
    "_SB_",
    "$",
    "_VCC",
];

/// The stages of signals, and the signals of lines, in the Verilog of a design.
pub(super) struct Source<'a> {
    top: &'a Arc<Module>,
    /// By file: the signal and the stage that each line declares.
    lines: HashMap<&'a str, Vec<Line>>,
}

#[derive(Clone, Default)]
struct Line {
    signal: Option<String>,
    stage: Option<u32>,
}

impl<'a> Source<'a> {
    /// The names of a design, from its top module and its files.
    pub fn new(top: &'a Arc<Module>, files: &'a [(String, String)]) -> Self {
        let lines = files.iter().map(|(name, text)| (name.as_str(), lines(text))).collect();
        Self { top, lines }
    }

    /// A path, cell by cell. Neighbours with the same name are one hop.
    pub fn tell(&self, path: &[Segment]) -> Vec<Hop> {
        let mut hops: Vec<Hop> = Vec::new();
        for (index, segment) in path.iter().enumerate().filter(|(_, segment)| segment.delay > 0.0) {
            let is_routing = segment.kind == "routing";
            // The net that leaves the cell has its place in the source.
            let leaving = path[index + 1..].iter().take(2).find(|next| next.kind == "routing");
            let sources = leaving.map_or(&[][..], |net| &net.sources);
            let mut hop = self.name(&segment.to.cell, sources);
            // Inside a carry chain, names are known only at its ends, and some cells have no name in the source.
            let is_inside = segment.to.cell.contains("CCU2_COMB") && sources.is_empty();
            if let Some(last) = hops.last().filter(|_| is_inside || hop.signal.is_empty()) {
                hop.signal.clone_from(&last.signal);
                hop.stage = last.stage;
            }
            if is_routing {
                hop.routing_ns = segment.delay;
            } else {
                hop.logic_ns = segment.delay;
            }
            match hops.last_mut() {
                Some(last) if last.signal == hop.signal => {
                    last.routing_ns += hop.routing_ns;
                    last.logic_ns += hop.logic_ns;
                }
                _ => hops.push(hop),
            }
        }
        hops
    }

    /// What a cell belongs to: the signal in whose line it was written, where Yosys still knows that, else the signal
    /// that its name begins with.
    fn name(&self, cell: &str, sources: &[String]) -> Hop {
        let end = CELLS.iter().filter_map(|mark| cell.find(mark)).min().unwrap_or(cell.len());
        let path = without_bit(&cell[..end]);
        let written = sources.iter().find_map(|source| self.written(source));
        let path = match (written, path.rsplit_once('.')) {
            (Some(signal), Some((instance, _))) => format!("{instance}.{signal}"),
            _ => path.to_owned(),
        };
        let stage = self.stage(&path);
        let signal = path.strip_prefix(UNIT).and_then(|rest| rest.strip_prefix('.')).unwrap_or(&path).to_owned();
        Hop { signal, stage, routing_ns: 0.0, logic_ns: 0.0 }
    }

    /// The signal declared at a place such as `fp_add.v:83.36-83.73`.
    fn written(&self, source: &str) -> Option<&str> {
        let (file, place) = source.rsplit_once(':')?;
        let line: usize = place.split('.').next()?.parse().ok()?;
        self.lines.get(file)?.get(line.checked_sub(1)?)?.signal.as_deref()
    }

    /// The stage of a signal given by its path through instances.
    fn stage(&self, path: &str) -> Option<u32> {
        let mut parts: Vec<&str> = path.split('.').collect();
        let signal = parts.pop()?;
        let mut module = self.top;
        let mut parts = parts.into_iter();
        while let Some(part) = parts.next() {
            let array = part.split_once('[').map(|(name, _)| name);
            if array.is_some() {
                parts.next(); // The copy itself: `unit`.
            }
            let name = array.unwrap_or(part);
            module = &module.instances.iter().find(|instance| instance.name == name)?.module;
        }
        let lines = self.lines.get(format!("{}.v", module.name).as_str())?;
        lines.iter().find(|line| line.signal.as_deref() == Some(signal))?.stage
    }
}

/// A path without the bit at its end, or the place in a generated block; an array's copy is `slots[3].unit`, and stays.
fn without_bit(path: &str) -> &str {
    let of_a_copy = |at: usize| path[at..].split_once(']').is_some_and(|(_, rest)| rest.starts_with(".unit."));
    let end = path.match_indices('[').map(|(at, _)| at).find(|&at| !of_a_copy(at));
    &path[..end.unwrap_or(path.len())]
}

/// What each line of a file declares, and the stage whose banner it stands under.
fn lines(text: &str) -> Vec<Line> {
    let mut stage = None;
    let line = |text: &str| {
        if let Some(banner) = text.trim().strip_prefix("// ---- ") {
            stage = banner.strip_prefix("stage ").and_then(|rest| rest.split(' ').next()?.parse().ok());
        }
        let declared = ["wire ", "reg "].iter().find_map(|word| text.trim().strip_prefix(word));
        let signal = declared.and_then(|rest| {
            let rest = if rest.starts_with('[') { rest.split_once(']')?.1.trim_start() } else { rest };
            rest.split([' ', ';']).next().map(str::to_owned)
        });
        Line { signal, stage }
    };
    text.lines().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hdl::Graph;
    use crate::synth::route::Pin;

    fn segment(delay: f64, kind: &str, cell: &str) -> Segment {
        Segment { delay, kind: kind.to_owned(), to: Pin { cell: cell.to_owned() }, sources: Vec::new() }
    }

    #[test]
    fn a_signal_in_a_chain_has_its_name_and_stage() {
        let slot = Graph::new("slot");
        let own = slot.input("index", 1) & slot.input("turn_in", 1);
        slot.output("turn_out", own.named("in_turn").delay(1));
        let graph = Graph::new("afu");
        let count = graph.parameter("SCPUS", 2, 1..=2, 2);
        let slots =
            graph.chain("slots", &slot.finish().expect("a module"), count, &[("turn_in", graph.constant(1, 1))]);
        graph.output("out", slots.output("turn_out"));
        let core = graph.finish().expect("a module");
        let bench = Graph::new("bench");
        bench.output("out", bench.instance(UNIT, &core, &[]).output("out"));
        let top = bench.finish().expect("a module");
        let files = [("slot.v".to_owned(), "  // ---- stage 4 ----\n  wire in_turn = index;\n".to_owned())];
        let path = [
            segment(0.5, "clk-to-q", "unit.core_turn[3]_TRELLIS_FF_Q"),
            segment(0.25, "routing", "unit.slots[1].unit.in_turn[2]_LUT4_C_1"),
            segment(0.5, "routing", "unit.sum_block.two_bits[2].cell_TRELLIS_FF_Q"),
        ];
        let hops = Source::new(&top, &files).tell(&path);
        let told: Vec<_> = hops.iter().map(|hop| (hop.signal.as_str(), hop.stage)).collect();
        assert_eq!(told, [("core_turn", None), ("slots[1].unit.in_turn", Some(4)), ("sum_block.two_bits", None)]);
    }

    #[test]
    fn a_cell_without_a_name_belongs_to_the_hop_before_it() {
        let graph = Graph::new("bench");
        graph.output("out", graph.input("in", 1));
        let top = graph.finish().expect("a module");
        let path = [
            segment(0.5, "clk-to-q", "unit.a_s1_TRELLIS_FF_Q"),
            segment(0.25, "routing", "$nextpnr_CCU2C_1$CCU2_FCI_INT"),
            segment(1.0, "logic", "$nextpnr_CCU2C_1$CCU2_FCI_INT"),
            segment(0.5, "routing", "unit.b_s2_TRELLIS_FF_Q"),
        ];
        let hops = Source::new(&top, &[]).tell(&path);
        let told: Vec<_> = hops.iter().map(|hop| (hop.signal.as_str(), hop.routing_ns, hop.logic_ns)).collect();
        assert_eq!(told, [("a_s1", 0.25, 1.5), ("b_s2", 0.5, 0.0)]);
    }
}
