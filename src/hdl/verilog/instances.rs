//! Instances in the body of a module: one, or the number that a parameter gives, with outputs or-ed together.

use super::super::module::{Instance, InstanceCount, NodeId, Op};
use super::expression::{constant, range};
use super::sections::Sections;
use super::unused::unconnected;

impl Sections<'_> {
    pub(super) fn instance_outputs(&self, index: usize) -> String {
        let instance = &self.module.instances[index];
        let mut out = String::new();
        for (port, name) in unconnected(self.module, index) {
            let width = instance.module.ports[port].width;
            match instance.count {
                InstanceCount::One => out += &format!("  wire {}{name};\n", range(width)),
                InstanceCount::Parameter(parameter) => {
                    let count = &self.module.parameters[parameter].name;
                    out += &format!("  wire [{count}*{width}-1:0] {name}_all;\n");
                }
            }
        }
        for (port, id) in self.outputs_of(index) {
            let Some(name) = &self.text.names.declared[id.index()] else { continue };
            let width = instance.module.ports[port].width;
            let is_port = self.text.names.is_port[id.index()];
            match instance.count {
                InstanceCount::One if !is_port => out += &format!("  wire {}{name};\n", range(width)),
                InstanceCount::One => {}
                InstanceCount::Parameter(parameter) => {
                    let count = &self.module.parameters[parameter].name;
                    out += &format!("  wire [{count}*{width}-1:0] {name}_all;\n");
                    if !is_port {
                        out += &format!("  reg {}{name};\n", range(width));
                    }
                }
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

    fn connections(&self, instance: &Instance, output: impl Fn(&str, u32) -> String) -> String {
        let position = self.module.instances.iter().position(|i| std::ptr::eq(i, instance)).unwrap_or(0);
        let outputs = self.outputs_of(position);
        let mut list = Vec::new();
        if instance.module.is_clocked() {
            list.push((String::from("clk"), String::from("clk")));
        }
        if instance.module.has_reset_port() {
            list.push((self.style.reset_port().to_owned(), self.style.reset_port().to_owned()));
        }
        for (index, port) in instance.module.ports.iter().enumerate() {
            let value = if port.output {
                let used = outputs.iter().find(|(number, _)| *number == index);
                let name = used.and_then(|(_, id)| self.text.names.declared[id.index()].clone());
                let name = name.unwrap_or_else(|| format!("{}_{}_unused", instance.name, port.name));
                output(&name, port.width)
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

    /// Parameters that an instance takes from this module, if both have them.
    fn inherited(&self, instance: &Instance) -> String {
        let known = |name: &str| self.module.parameters.iter().any(|parameter| parameter.name == name);
        let parameters = instance.module.parameters.iter().filter(|parameter| parameter.rounded.is_none());
        let names = parameters.map(|p| &p.name).filter(|name| known(name));
        let list: Vec<_> = names.map(|name| format!("    .{name} ({name})")).collect();
        if list.is_empty() { String::new() } else { format!("#(\n{}\n  ) ", list.join(",\n")) }
    }

    pub(super) fn instance(&self, instance: &Instance) -> String {
        let (name, module) = (&instance.name, format!("{}{}", self.style.prefix, instance.module.name));
        let indent = |text: &str, spaces: usize| text.replace('\n', &format!("\n{}", " ".repeat(spaces)));
        match instance.count {
            InstanceCount::One => {
                let list = self.connections(instance, |name, _| name.to_owned());
                let parameters = self.inherited(instance);
                format!("\n  {module} {parameters}{name} (\n    {}\n  );\n", indent(&list, 4))
            }
            InstanceCount::Parameter(parameter) => {
                let count = &self.module.parameters[parameter].name;
                let list =
                    self.connections(instance, |name, width| format!("{name}_all[{name}_copy*{width} +: {width}]"));
                let copy = format!("{name}_number");
                let list = replace_copies(&list, &copy);
                let mut out =
                    format!("\n  // {count} copies of {module}: the same inputs to all, outputs or-ed together.\n");
                out += &format!(
                    "  genvar {copy};\n  generate\n    for ({copy} = 0; {copy} < {count}; {copy} = {copy} + 1) begin : {name}\n"
                );
                if instance
                    .inputs
                    .iter()
                    .zip(&instance.module.ports)
                    .any(|(input, port)| input.is_none() && !port.output)
                {
                    out += &format!("      localparam [31:0] NUMBER = {copy};\n");
                }
                out += &format!(
                    "      {module} {}unit (\n        {}\n      );\n    end\n  endgenerate\n",
                    self.inherited(instance),
                    indent(&list, 8)
                );
                out + &self.array_or(instance, count)
            }
        }
    }

    fn array_or(&self, instance: &Instance, count: &str) -> String {
        let position = self.module.instances.iter().position(|i| std::ptr::eq(i, instance)).unwrap_or(0);
        let outputs: Vec<_> = self
            .outputs_of(position)
            .into_iter()
            .filter_map(|(port, id)| {
                Some((self.text.names.declared[id.index()].clone()?, instance.module.ports[port].width))
            })
            .collect();
        let place = format!("{}_place", instance.name);
        let mut out = format!("\n  integer {place};\n  always @* begin\n");
        for (name, width) in &outputs {
            out += &format!("    {name} = {};\n", constant(*width, 0));
        }
        out += &format!("    for ({place} = 0; {place} < {count}; {place} = {place} + 1) begin\n");
        for (name, width) in &outputs {
            out += &format!("      {name} = {name} | {name}_all[{place}*{width} +: {width}];\n");
        }
        out + "    end\n  end\n"
    }
}

/// Output connections of an array are written with a placeholder for the copy's number.
fn replace_copies(list: &str, copy: &str) -> String {
    let mut out = String::new();
    for line in list.split_inclusive('\n') {
        match (line.find("_all["), line.find("_copy*")) {
            (Some(start), Some(end)) => {
                out += &line[..start + "_all[".len()];
                out += copy;
                out += &line[end + "_copy".len()..];
            }
            _ => out += line,
        }
    }
    out
}
