//! The records of an AFU as a table for people: the content of each word, computed from the layout.

use std::fmt::Write as _;

use crate::config::{Input, RecordFormat, Results};
use crate::query::{ContactRecord, DEPTH, FLAGS, Fields, Flow, GROUPS, Rule};

use super::spheres::SPHERE_BITS;
use super::{Afu, JobError};
use crate::spheres::ROW;

impl Afu {
    /// The section `Records` of PORTS.md.
    pub(super) fn records(&self) -> String {
        if self.spec().config.input == Input::Spheres {
            return self.spheres();
        }
        let (config, layout) = (&self.spec().config, self.layout());
        let word = layout.word_bits();
        let numbers = match config.record {
            RecordFormat::F32 => "IEEE 754 binary32",
            RecordFormat::F16 => "IEEE 754 binary16",
            RecordFormat::Bf16 => "bfloat16 (the upper half of binary32)",
        };
        let mut out =
            format!("## Records\n\nNumbers are {numbers}. Bits of a record are counted from its lowest bit.\n");
        let (bits, per_line) = (layout.pair_bits(), layout.pairs_per_line());
        let _ = write!(
            out,
            "\n**Pairs.** A pair is {bits} bits; a source line holds {per_line}. Pair p of the job is in line p / \
             {per_line} of the source, from bit {bits} · (p mod {per_line}) on. The job reads ⌈`count` / {per_line}⌉ \
             lines. What the last line holds after the last pair is ignored.\n\n| bits of a pair | word | meaning \
             |\n|---|---|---|\n"
        );
        let shape = config.query.shape();
        for (place, (_, input)) in (0..).zip(layout.inputs()) {
            let _ = writeln!(out, "| {} | `{}` | {} |", bits_of(place * word, word), input.name, input.meaning);
        }
        rest(&mut out, layout.inputs().count() as u32 * word, bits, "ignored");
        if let Some(radius) = config.radius {
            let _ = writeln!(out, "\nEvery sphere's radius is {radius}; it is part of the hardware.");
        }

        let (bits, per_line, number) = (layout.contact_bits(), layout.contacts_per_line(), layout.number_bits());
        let (which, all) = match config.results {
            Results::All => ("Every pair has a contact record, in the order of the pairs.", "count"),
            Results::Hits => ("Only pairs in contact have a record, in the order of the pairs.", "contacts"),
        };
        let _ = write!(
            out,
            "\n**Contacts.** {which} A record is {bits} bit{s}; a destination line holds {per_line}. Record i is in line i \
             / {per_line} of the destination, from bit {bits} · (i mod {per_line}) on. The job writes ⌈`{all}` / \
             {per_line}⌉ lines and nothing after them. What the last line holds after the last record is zero.\n\n| bits of \
             a record | word | meaning |\n|---|---|---|\n",
            s = if bits == 1 { "" } else { "s" }
        );
        if number > 0 {
            let _ = writeln!(out, "| {} | `number` | number of the pair, from 0 |", bits_of(0, number));
        }
        if layout.contact_words().is_empty() && number == 0 {
            out += "| 0 | `hit` | 1: contact |\n";
        }
        self.words(&mut out);
        rest(&mut out, layout.used_bits(), bits, "zero");
        if !layout.contact_words().is_empty() {
            out += &self.flags();
        }
        let has_lengths = shape.inputs.iter().any(|input| input.rule == Rule::NotNegative);
        let _ = write!(
            out,
            "\n**What is computed.** {} Without contact every word but the flags is zero. A pair with a NaN, an infinity{} is \
             invalid{}: it is counted, and is no contact.\n",
            shape.computes,
            if has_lengths { " or a negative radius" } else { "" },
            if has_lengths { " (−0 is a valid radius)" } else { "" },
        );
        out
    }

    /// Rows of a table: the words of a contact in its record.
    fn words(&self, out: &mut String) {
        let layout = self.layout();
        let (number, word) = (layout.number_bits(), layout.word_bits());
        let meanings: Vec<&str> =
            GROUPS.iter().flat_map(|group| group.words.iter().map(|_| group.meaning)).chain(["see below"]).collect();
        for (place, &index) in (0..).zip(&layout.contact_words()) {
            let (name, meaning) = (ContactRecord::NAMES[index], meanings[index]);
            let sign = index == DEPTH && layout.sign_is_flow();
            let sign = if sign { "; its sign bit is set if the centres coincide" } else { "" };
            let _ = writeln!(out, "| {} | `{name}` | {meaning}{sign} |", bits_of(number + place * word, word));
        }
    }

    /// The same for an AFU that takes spheres.
    fn spheres(&self) -> String {
        let (config, layout) = (&self.spec().config, self.layout());
        let search = config.search;
        let (bits, per_line) = (layout.contact_bits(), layout.contacts_per_line());
        let mut out = format!(
            "## Records\n\nNumbers are IEEE 754 binary32. Bits of a record are counted from its lowest bit.\n\n\
             **Spheres.** A sphere is {SPHERE_BITS} bits; a source line holds four. Sphere s of a set is in line s / 4 of the \
             set, from bit {SPHERE_BITS} · (s mod 4) on. A set takes a whole number of rows of {ROW} spheres, which are {} \
             lines: the first set begins at `source`, and the second behind the last row of the first. With mode 2 the \
             second set is at `source`. What a row holds after the last sphere of its set is ignored. The first set has \
             at most {} spheres and the second at most 65 536; otherwise the job ends with error {}.\n\n\
             | bits of a sphere | word | meaning |\n|---|---|---|\n\
             | 31:0 | `x` | x of the centre |\n| 63:32 | `y` | y of the centre |\n| 95:64 | `z` | z of the centre |\n\
             | 127:96 | `r` | radius, at least 0 |\n\n\
             A sphere with a NaN, an infinity or a negative radius is invalid (−0 is a valid radius): it is counted, and \
             touches none.\n\n\
             **Contacts.** Every two spheres that touch have a record: within one set each pair once, of two sets each \
             sphere of the first with each of the second. A record is {bits} bits; a destination line holds {per_line}. Record i \
             is in line i / {per_line} of the destination, from bit {bits} · (i mod {per_line}) on. The job writes ⌈`contacts` \
             / {per_line}⌉ lines and nothing after them. What the last line holds after the last record is zero. The order is: row of the second \
             sphere, row of the first, second sphere, first sphere.\n\n\
             | bits of a record | word | meaning |\n|---|---|---|\n\
             | 15:0 | `first` | number of the first sphere in its set, from 0; within one set the lower of both |\n\
             | 31:16 | `second` | number of the second sphere in its set |\n",
            ROW / 4,
            search.table,
            JobError::Table.code()
        );
        self.words(&mut out);
        rest(&mut out, layout.used_bits(), bits, "zero");
        let has_flags = layout.contact_words().contains(&FLAGS);
        if has_flags {
            out += &self.flags();
        }
        if config.contact != Fields::HIT {
            let _ = write!(out, "\n**What is computed.** {}\n", config.query.shape().computes);
        }
        out
    }

    /// The possible values of the word `flags`.
    fn flags(&self) -> String {
        let mut out = "\nOf the word `flags`, bit 0 is set for a contact, bits 2:1 say which way the pair went, bit 3 is set \
                       for an invalid pair, and bit 4 for one that the host must decide. The others are zero. It is one \
                       of:\n\n| `flags` | meaning |\n|---|---|\n"
            .to_owned();
        let hits = self.spec().config.results == Results::Hits;
        let flows = self.spec().config.query.shape().flows.iter().rev().copied().chain([Flow::Invalid]);
        let mut values: Vec<(u32, &str)> =
            flows.filter(|flow| !hits || flow.is_contact()).map(|flow| (flow.flags(), flow.meaning())).collect();
        if self.spec().config.profile.is_exact() {
            values.push((ContactRecord::UNSETTLED.flags(), "not decided: the host must compute this pair"));
        }
        for (value, meaning) in values {
            let _ = writeln!(out, "| {value} | {meaning} |");
        }
        out
    }
}

fn bits_of(low: u32, bits: u32) -> String {
    format!("{}:{low}", low + bits - 1)
}

fn rest(out: &mut String, used: u32, bits: u32, what: &str) {
    if used < bits {
        let _ = writeln!(out, "| {} | | {what} |", bits_of(used, bits - used));
    }
}
