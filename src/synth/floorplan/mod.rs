//! A floorplan: the sites of multiplier blocks and block memories, chosen before nextpnr places the rest.
//!
//! nextpnr's static placer moves all cells freely and puts blocks onto their few sites late, one after another, each
//! onto the best that is still free. All that surrounds them then follows for a few steps only. Here any two blocks
//! have a weight, by how directly data flow from one to the other ([`flow`]), and [`anneal`] finds sites at which pairs
//! of great weight are close. nextpnr keeps a cell where its attribute `BEL` says.

mod anneal;
mod flow;
mod sites;

use std::fs;
use std::path::Path;

use serde_json::{Map, Value, json};

use super::yosys::Netlist;
use super::{SynthError, Target, wrapper};
use crate::store::{Key, Store};
use anneal::Block;
use flow::Wire;

/// The attribute by which nextpnr knows a cell's site.
const SITE: &str = "BEL";

/// True if the sites of the family's device are known.
pub(super) fn knows(target: Target) -> bool {
    !sites::kinds(target).is_empty()
}

/// The netlist with its floorplan, from the store if it is there.
pub(super) fn planned(netlist: &Netlist, target: Target, store: &Store) -> Result<Netlist, SynthError> {
    let key = Key::new("floorplan/1", &(&netlist.key, target.name()))?;
    let path = store.file(&key, "netlist");
    if !path.is_file() {
        let room = store.scratch()?;
        let file = room.path().join("netlist.json");
        plan(target, &netlist.path, &file)?;
        fs::rename(file, &path).map_err(|e| SynthError::io("create", &path, e))?;
    }
    Ok(Netlist { key, cells: netlist.cells.clone(), path })
}

/// Reads the netlist `from`, in Yosys's JSON, and writes it to `to`, with a site for each block. A netlist without
/// blocks stays as it is, and so does one with more blocks than the device has, for nextpnr to say so.
fn plan(target: Target, from: &Path, to: &Path) -> Result<(), SynthError> {
    let wrong = |what: &str| SynthError::io("read", from, std::io::Error::other(what.to_owned()));
    let text = fs::read(from).map_err(|e| SynthError::io("read", from, e))?;
    let mut netlist: Value = serde_json::from_slice(&text).map_err(|error| wrong(&error.to_string()))?;
    let cells = netlist.pointer_mut(&format!("/modules/{}/cells", wrapper::TOP)).and_then(Value::as_object_mut);
    let cells = cells.ok_or_else(|| wrong("no cells"))?;

    let kinds = sites::kinds(target);
    let kind = |cell: &Value| kinds.iter().position(|kind| cell["type"] == kind.cell);
    let blocks: Vec<Block> = (cells.values().enumerate())
        .filter_map(|(cell, value)| kind(value).map(|kind| Block { cell: cell as u32, kind }))
        .collect();
    let weights = flow::weights(cells.len(), &wires(cells), &blocks);
    let chosen = anneal::sites(&blocks, &kinds, &weights).unwrap_or_default();
    let mut all: Vec<&mut Value> = cells.values_mut().collect();
    for (block, site) in blocks.iter().zip(chosen) {
        all[block.cell as usize]["attributes"][SITE] = json!(site.name);
    }
    fs::write(to, netlist.to_string()).map_err(|e| SynthError::io("write", to, e))
}

/// The wires between cells, which are known by their places in the list.
fn wires(cells: &Map<String, Value>) -> Vec<Wire> {
    let mut wires: Vec<Wire> = Vec::new();
    for (cell, value) in (0..).zip(cells.values()) {
        let Some(ports) = value["connections"].as_object() else { continue };
        for (port, bits) in ports {
            let drives = value["port_directions"][port] == "output";
            // A constant is no number.
            for bit in bits.as_array().into_iter().flatten().filter_map(Value::as_u64) {
                let bit = bit as usize;
                if bit >= wires.len() {
                    wires.resize_with(bit + 1, Wire::default);
                }
                if drives {
                    wires[bit].driver = Some(cell);
                } else {
                    wires[bit].users.push(cell);
                }
            }
        }
    }
    wires
}
