//! The test bench beside the Verilog, for simulators without this crate: a job with its pairs, and the lines that the
//! reference kernel computes for them. Each shell has its own bench, and `shared.v` has the common parts.

use crate::query::{Flow, PairRecord};

use super::shell::BenchText;
use super::{Afu, COUNT_BITS};
use crate::record::{Line, pack, pack_contacts, unpack_pairs};

impl Afu {
    /// The name of the test bench's module.
    pub fn bench_name(&self) -> String {
        format!("{}_bench", self.top_name())
    }

    /// The text of the test bench.
    pub(super) fn bench(&self) -> String {
        let (config, layout) = (&self.spec().config, self.layout());
        let examples = config.query.shape().examples.iter();
        let pairs: Vec<_> = examples.map(|values| PairRecord::of_values(values.iter().copied())).collect();
        let source = pack(&layout, &pairs);
        // As the AFU reads them: rounded to the record format, with the hardware's radius.
        let records = config.reference().run_all(&unpack_pairs(&layout, &source, pairs.len()));
        let expected = pack_contacts(&layout, &records);
        let invalid: Vec<usize> = (0..records.len()).filter(|&i| records[i].flow() == Some(Flow::Invalid)).collect();
        let first_invalid = invalid.first().map_or(u32::MAX >> (u32::BITS - COUNT_BITS), |&number| number as u32);
        let contacts = records.iter().filter(|record| record.is_contact()).count();

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
            ("@SCPUS@", config.scpus.to_string()),
            ("@COUNT@", pairs.len().to_string()),
            ("@PER_LINE@", layout.pairs_per_line().to_string()),
            ("@EXPECTED_LINES@", expected.len().to_string()),
            ("@CONTACTS@", contacts.to_string()),
            ("@INVALID@", invalid.len().to_string()),
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
