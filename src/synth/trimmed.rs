//! Finds the wrapper's registers that synthesis removed: a unit with removed outputs would look small.

use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{SynthError, wrapper};
use crate::hdl::Module;

/// The wrapper's registers that synthesis removed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trimmed {
    /// Input bits that the unit does not read.
    pub inputs: u64,
    /// Output bits that the unit drives with a constant, or with the value of another one.
    pub outputs: u64,
}

#[derive(Deserialize)]
struct Netlist {
    modules: BTreeMap<String, Top>,
}

#[derive(Deserialize)]
struct Top {
    netnames: BTreeMap<String, Net>,
    cells: BTreeMap<String, Cell>,
}

#[derive(Deserialize)]
struct Net {
    bits: Vec<Bit>,
}

#[derive(Deserialize)]
struct Cell {
    connections: BTreeMap<String, Vec<Bit>>,
}

/// A wire by its number, or a constant.
#[derive(Deserialize, PartialEq, Eq, Hash)]
#[serde(untagged)]
enum Bit {
    Wire(u64),
    Constant(String),
}

impl Trimmed {
    /// Finds them in a netlist in Yosys's JSON, of a wrapper around `unit`.
    pub(super) fn of(path: &Path, unit: &Module) -> Result<Self, SynthError> {
        let text = fs::read(path).map_err(|e| SynthError::io("read", path, e))?;
        let mut netlist: Netlist = serde_json::from_slice(&text)
            .map_err(|error| SynthError::io("read", path, std::io::Error::other(error)))?;
        let Some(top) = netlist.modules.remove(wrapper::TOP) else { return Ok(Self::default()) };
        // Flip-flops of every family have their output at Q.
        let registers: HashSet<&Bit> =
            top.cells.values().filter_map(|cell| cell.connections.get("Q")?.first()).collect();
        let kept = |names: &[String]| -> u64 {
            let bits = names.iter().filter_map(|name| top.netnames.get(name)).flat_map(|net| &net.bits);
            bits.filter(|bit| registers.contains(bit)).collect::<HashSet<_>>().len() as u64
        };
        // If a wire has two names, Yosys may drop one.
        let inputs = unit.ports.iter().filter(|port| !port.output);
        let inputs = inputs.map(|port| format!("{}.{}", wrapper::UNIT, port.name));
        let operands: Vec<String> = inputs.chain([wrapper::OPERANDS.to_owned()]).collect();
        let bits = |outputs| u64::from(wrapper::bits(unit, outputs));
        Ok(Self {
            inputs: bits(false).saturating_sub(kept(&operands)),
            outputs: bits(true).saturating_sub(kept(&[wrapper::RESULTS.to_owned()])),
        })
    }
}
