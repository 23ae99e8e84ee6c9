//! The test bench beside the Verilog, for simulators without this crate: a job with its pairs, and the lines that the
//! reference kernel computes for them. Each shell has its own bench, and `shared.v` has the common parts.

mod example;

use super::shell::BenchText;
use super::{Afu, COUNT_BITS};
use crate::config::Input;
use crate::record::Line;
use example::Example;

impl Afu {
    /// The name of the test bench's module.
    pub fn bench_name(&self) -> String {
        format!("{}_bench", self.top_name())
    }

    /// The text of the test bench.
    pub(super) fn bench(&self) -> String {
        let config = &self.spec().config;
        let Example { source, expected, count, contacts, candidates, invalid, first_invalid, last_line } =
            Example::of(self);
        let first_invalid = first_invalid.map_or(u32::MAX >> (u32::BITS - COUNT_BITS), |number| number as u32);
        let what = match config.input {
            Input::Direct => "pairs",
            Input::Spheres => "spheres",
        };
        // Behind deciders the number of SCPUs is fixed.
        let (parameter, passed) = if config.has_deciders() {
            ("", "")
        } else {
            ("  parameter [31:0] SCPUS = 32'd@SCPUS@;\n", " #(\n    .SCPUS(SCPUS)\n  )")
        };
        let BenchText { text, first_line } = self.shell().bench(self);
        let lines = |lines: &[Line], text: &dyn Fn(usize, &str) -> String| {
            let lines = lines.iter().enumerate().map(|(number, line)| text(number, &hex(line)));
            lines.collect::<Vec<_>>().join("\n")
        };
        let values = [
            ("@BENCH@", self.bench_name()),
            ("@TOP@", self.top_name()),
            ("@VERSION@", env!("CARGO_PKG_VERSION").to_owned()),
            ("@COMMAND@", self.command()),
            ("@PARAMETER@\n", parameter.to_owned()),
            ("@PARAMETERS@", passed.to_owned()),
            ("@SCPUS@", config.scpus.to_string()),
            ("@COUNT@", count.to_string()),
            ("@WHAT@", what.to_owned()),
            ("@LAST_LINE@", last_line),
            ("@EXPECTED_LINES@", expected.len().to_string()),
            ("@CONTACTS@", contacts.to_string()),
            ("@CANDIDATES@", candidates.to_string()),
            ("@INVALID@", invalid.to_string()),
            ("@FIRST_INVALID@", first_invalid.to_string()),
            (
                "@SOURCE@",
                lines(&source, &|number, hex| format!("      source_lines[{}] = 512'h{hex};", number + first_line)),
            ),
            ("@EXPECTED@", lines(&expected, &|number, hex| format!("      expect_line({number}, 512'h{hex});"))),
        ];
        values.into_iter().fold(with_shared(text), |text, (name, value)| text.replace(name, &value))
    }
}

/// The text with the parts that the benches of all shells share in place of their names.
fn with_shared(text: String) -> String {
    let parts = include_str!("shared.v").split("@@ ").filter_map(|part| part.split_once('\n'));
    parts.fold(text, |text, (name, part)| text.replace(&format!("@{name}@\n"), part))
}

fn hex(line: &Line) -> String {
    line.iter().rev().map(|word| format!("{word:08x}")).collect::<Vec<_>>().join("_")
}
