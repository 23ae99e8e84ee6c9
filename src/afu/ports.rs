//! PORTS.md: everything that is needed to drive the AFU.

use std::fmt::Write as _;

use super::port::{Declaration, Ports};
use super::{Afu, MAX_SCPUS};

impl Afu {
    /// All ports, the clock first.
    pub(super) fn ports(&self) -> Ports {
        self.shell().ports(self.spec())
    }

    /// The text of PORTS.md.
    pub(super) fn ports_page(&self) -> String {
        let spec = self.spec();
        let mut out = format!(
            "# Ports of `{}`\n\nOne clock. {}All outputs are registered or functions of registers.\nA line is {} bits; word i \
             of a line is bits 32·i+31 to 32·i; addresses count {}.\n\n| port | direction | bits | in reset | meaning \
             |\n|---|---|---|---|---|\n",
            self.top_name(),
            self.scpus(),
            spec.line_bits,
            self.shell().addresses_count()
        );
        let Ports { inputs, outputs } = self.ports();
        for Declaration { name, bits, meaning } in inputs {
            let _ = writeln!(out, "| `{name}` | in | {bits} |  | {meaning} |");
        }
        for Declaration { name, bits, meaning } in outputs {
            let level = match self.top().at_reset(name, self.shell().held()) {
                _ if name == "capability" => String::new(),
                Some(value) if bits > 4 && value == u128::MAX >> (128 - bits) => "all ones".to_owned(),
                Some(value) => value.to_string(),
                None => "any".to_owned(),
            };
            let _ = writeln!(out, "| `{name}` | out | {bits} | {level} | {meaning} |");
        }
        out + &self.shell().protocol(self) + "\n" + &self.records()
    }

    /// The possible numbers of SCPUs, in words.
    fn scpus(&self) -> String {
        let spec = self.spec();
        if spec.config.has_deciders() {
            return String::new();
        }
        let mut out = format!("`SCPUS` (1 to {MAX_SCPUS}) is a Verilog parameter. ");
        if let Some(multiple) = spec.full_rate().filter(|multiple| *multiple < MAX_SCPUS) {
            let _ = write!(
                out,
                "{multiple} SCPUs at interval {} take a full line of pairs per cycle; above {multiple} the number built is \
                 rounded down to a multiple of {multiple}. ",
                spec.config.interval
            );
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use crate::afu::{Afu, Spec};
    use crate::config::{Config, Input, Results, Shell};
    use crate::query::Fields;

    #[test]
    fn the_top_has_the_ports_that_are_declared() {
        let shells = [Shell::Line, Shell::Spl2, Shell::Axi];
        let direct = shells.into_iter().flat_map(|s| [(s, Results::All), (s, Results::Hits)]);
        let direct = direct.map(|(shell, results)| Config { shell, results, ..Config::default() });
        let spheres = shells.map(|shell| Config {
            shell,
            results: Results::Hits,
            contact: Fields::HIT,
            input: Input::Spheres,
            ..Config::default()
        });
        for config in direct.chain(spheres) {
            let what = format!("{}, {}, {}", config.shell, config.results, config.input);
            let afu = Afu::generate(Spec::from(config)).expect("an AFU");
            let declared = afu.ports();
            let of = |output: bool| {
                let ports = afu.top().ports.iter().filter(move |port| port.output == output);
                ports.map(|port| (port.name.as_str(), port.width)).collect::<Vec<_>>()
            };
            let [inputs, outputs] = [&declared.inputs, &declared.outputs]
                .map(|ports| ports.iter().map(|p| (p.name, p.bits)).collect::<Vec<_>>());
            let implied = 1 + usize::from(afu.top().has_reset_port());
            assert_eq!((&inputs[implied..], outputs), (&of(false)[..], of(true)), "{what}");
        }
    }
}
