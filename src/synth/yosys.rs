//! Yosys: Verilog to cells.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde::Deserialize;

use super::cells::Cells;
use super::run::sha256_of;
use super::{SynthError, Target};
use crate::store::{Key, Store};
use crate::tools::Program;

/// A netlist in the store.
pub(super) struct Netlist {
    /// The hash of its inputs.
    pub key: Key,
    /// Its cells by type.
    pub cells: Cells,
    /// The netlist, in Yosys's JSON.
    pub path: PathBuf,
}

/// The modules to synthesise.
pub(super) struct Design<'a> {
    /// The name of the design, for messages.
    pub unit: &'a str,
    /// File names and texts.
    pub files: &'a [(String, String)],
    /// The module at the top.
    pub top: &'a str,
}

#[derive(Deserialize)]
struct Stat {
    design: Counts,
}

#[derive(Deserialize)]
struct Counts {
    num_cells_by_type: Cells,
}

/// Synthesises a design for a target, or finds its netlist in the store.
pub(super) fn synthesise(
    yosys: &Program,
    design: &Design<'_>,
    target: Target,
    store: &Store,
) -> Result<Netlist, SynthError> {
    let mut script: Vec<String> = design.files.iter().map(|(name, _)| format!("read_verilog {name}")).collect();
    script.push(format!("{} -top {}", target.synthesis(), design.top));
    script.push("tee -q -o stat.json stat -json".to_owned());
    script.push("write_json netlist.json".to_owned());
    let script = script.join("; ");

    let key = Key::new("netlist/1", &(yosys.version(), &script, sha256_of(design.files)))?;
    let path = store.file(&key, "netlist");
    if let Some(cells) = store.get(&key)?
        && path.is_file()
    {
        return Ok(Netlist { key, cells, path });
    }
    let room = store.scratch()?;
    for (name, text) in design.files {
        let file = room.path().join(name);
        fs::write(&file, text).map_err(|e| SynthError::io("write into", store.folder(), e))?;
    }
    run(yosys, yosys.command().args(["-q", "-p", &script]).current_dir(room.path()), design.unit)?;
    let cells = read::<Stat>(yosys, &room.path().join("stat.json"), design.unit)?.design.num_cells_by_type;
    fs::rename(room.path().join("netlist.json"), &path).map_err(|e| SynthError::io("create", &path, e))?;
    store.put(&key, &cells)?;
    Ok(Netlist { key, cells, path })
}

/// Runs a program; if it fails, its last messages are the error.
pub(super) fn run(program: &Program, command: &mut Command, unit: &str) -> Result<Output, SynthError> {
    const LINES: usize = 12;
    let output = command.output().map_err(|e| SynthError::io("run", Path::new(program.name()), e))?;
    if output.status.success() {
        return Ok(output);
    }
    let text = [&output.stdout[..], &output.stderr[..]].map(String::from_utf8_lossy).concat();
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    let text = match lines.len() {
        0 => format!("no message ({})", output.status),
        count => lines[count.saturating_sub(LINES)..].join("\n"),
    };
    Err(SynthError::Failed { program: program.name().to_owned(), unit: unit.to_owned(), text })
}

/// Reads JSON that a program wrote.
pub(super) fn read<T: for<'de> Deserialize<'de>>(program: &Program, path: &Path, unit: &str) -> Result<T, SynthError> {
    let bytes = fs::read(path).map_err(|e| SynthError::io("read", path, e))?;
    serde_json::from_slice(&bytes).map_err(|error| SynthError::Unexpected {
        program: program.name().to_owned(),
        unit: unit.to_owned(),
        what: error.to_string(),
    })
}
