//! Instances in the body of a module: one, or a chain of as many as a parameter gives.

use super::super::instance::{Instance, InstanceCount, next_in_chain};
use super::super::module::{NodeId, Op, Size};
use super::expression::range;
use super::sections::Sections;
use super::unused::unconnected;

impl Sections<'_> {
    pub(super) fn instance_outputs(&self, index: usize) -> String {
        let instance = &self.module.instances[index];
        let mut out = String::new();
        if let InstanceCount::Parameter(parameter) = instance.count {
            let count = &self.module.parameters[parameter].name;
            for port in instance.module.ports.iter().filter(|port| port.output) {
                out += &format!("  wire [({count}+1)*{}-1:0] {};\n", port.width, chained(&instance.name, &port.name));
            }
        } else {
            for (port, name) in unconnected(self.module, index) {
                out += &format!("  wire {}{name};\n", range(instance.module.ports[port].width));
            }
        }
        for (port, id) in self.outputs_of(index) {
            let Some(name) = &self.text.names.declared[id.index()] else { continue };
            if !self.text.names.is_port[id.index()] {
                out += &format!("  wire {}{name};\n", range(instance.module.ports[port].width));
            }
        }
        out
    }

    /// The outputs of an instance that something uses: port index and node.
    fn outputs_of(&self, index: usize) -> Vec<(usize, NodeId)> {
        let of = |id: NodeId| match self.module.node(id).op {
            Op::InstanceOutput { instance, port } if instance == index => Some((port, id)),
            _ => None,
        };
        let mut found: Vec<_> = self.module.ids().filter_map(of).collect();
        found.sort_unstable();
        found
    }

    /// The connections of an instance. `chain` gives those of chained ports, by port.
    fn connections(&self, instance: &Instance, chain: impl Fn(usize) -> Option<String>) -> String {
        let position = self.module.instances.iter().position(|i| std::ptr::eq(i, instance)).unwrap_or(0);
        let outputs = self.outputs_of(position);
        let mut list = Vec::new();
        if instance.module.is_clocked() {
            list.push((instance.module.clock().to_owned(), self.module.clock().to_owned()));
        }
        if instance.module.has_reset_port() {
            let level = if self.style.reset.active_low { "~" } else { "" };
            let own = |id: NodeId| format!("{level}{}", self.text.term(id));
            let reset = instance.reset.map_or_else(|| self.style.reset_port().to_owned(), own);
            list.push((self.style.reset_port().to_owned(), reset));
        }
        for (index, port) in instance.module.ports.iter().enumerate() {
            let value = if let Some(value) = chain(index) {
                value
            } else if port.output {
                let used = outputs.iter().find(|(number, _)| *number == index);
                let name = used.and_then(|(_, id)| self.text.names.declared[id.index()].clone());
                name.unwrap_or_else(|| format!("{}_{}_unused", instance.name, port.name))
            } else {
                match instance.inputs[index] {
                    Some(id) => self.text.value(id),
                    None => format!("NUMBER[{}:0]", port.width - 1),
                }
            };
            list.push((port.name.clone(), value));
        }
        let widest = list.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        let lines: Vec<_> = list.iter().map(|(name, value)| format!(".{name:<widest$} ({value})")).collect();
        lines.join(",\n")
    }

    /// The size of a memory, or the parameters that an instance takes from this module, if both have them.
    fn parameters(&self, instance: &Instance) -> String {
        if let Some(Size { depth, width }) = instance.module.size {
            return format!("#(\n    .DEPTH (32'd{depth}),\n    .WIDTH (32'd{width})\n  ) ");
        }
        let known = |name: &str| self.module.parameters.iter().any(|parameter| parameter.name == name);
        let parameters = instance.module.parameters.iter().filter(|parameter| parameter.rounded.is_none());
        let names = parameters.map(|p| &p.name).filter(|name| known(name));
        let list: Vec<_> = names.map(|name| format!("    .{name} ({name})")).collect();
        if list.is_empty() { String::new() } else { format!("#(\n{}\n  ) ", list.join(",\n")) }
    }

    pub(super) fn instance(&self, instance: &Instance) -> String {
        let (name, module) = (&instance.name, format!("{}{}", self.style.prefix, instance.module.name));
        match instance.count {
            InstanceCount::One => {
                let list = indent(&self.connections(instance, |_| None), 4);
                format!("\n  {module} {}{name} (\n    {list}\n  );\n", self.parameters(instance))
            }
            InstanceCount::Parameter(parameter) => self.chain(instance, &self.module.parameters[parameter].name),
        }
    }

    /// A chain of instances. Each chained port has a vector with a part before each copy and one behind the last.
    fn chain(&self, instance: &Instance, count: &str) -> String {
        let (name, module) = (&instance.name, format!("{}{}", self.style.prefix, instance.module.name));
        let ports = &instance.module.ports;
        let links: Vec<(usize, usize)> = (0..ports.len())
            .filter(|port| ports[*port].output)
            .filter_map(|output| Some((next_in_chain(&instance.module, output)?, output)))
            .collect();
        let mut out =
            format!("\n  // A chain of {count} copies of {module}: each passes on what it gets, a register a copy.\n");
        for (input, output) in &links {
            let (vector, width) = (chained(name, &ports[*output].name), ports[*output].width);
            if let Some(first) = instance.inputs[*input] {
                out += &format!("  assign {vector}[{}:0] = {};\n", width - 1, self.text.value(first));
            }
        }
        for (port, id) in
            self.outputs_of(self.module.instances.iter().position(|i| std::ptr::eq(i, instance)).unwrap_or(0))
        {
            if let Some(last) = &self.text.names.declared[id.index()] {
                let (vector, width) = (chained(name, &ports[port].name), ports[port].width);
                out += &format!("  assign {last} = {vector}[{count}*{width} +: {width}];\n");
            }
        }
        let copy = format!("{name}_number");
        out += &format!(
            "  genvar {copy};\n  generate\n    for ({copy} = 0; {copy} < {count}; {copy} = {copy} + 1) begin : {name}\n"
        );
        if instance.inputs.iter().zip(ports).any(|(input, port)| input.is_none() && !port.output) {
            out += &format!("      localparam [31:0] NUMBER = {copy};\n");
        }
        let part = |port: usize, output: usize| {
            let (vector, width) = (chained(name, &ports[output].name), ports[output].width);
            let place = if port == output { format!("({copy}+1)") } else { copy.clone() };
            format!("{vector}[{place}*{width} +: {width}]")
        };
        let list = self.connections(instance, |port| {
            let link = links.iter().find(|(input, output)| *input == port || *output == port);
            link.map(|(_, output)| part(port, *output))
        });
        out + &format!(
            "      {module} {}unit (\n        {}\n      );\n    end\n  endgenerate\n",
            self.parameters(instance),
            indent(&list, 8)
        )
    }
}

/// The vector of a chained port, by the name of the output.
pub(super) fn chained(instance: &str, output: &str) -> String {
    format!("{instance}_{}_chain", output.strip_suffix("_out").unwrap_or(output))
}

fn indent(text: &str, spaces: usize) -> String {
    text.replace('\n', &format!("\n{}", " ".repeat(spaces)))
}
