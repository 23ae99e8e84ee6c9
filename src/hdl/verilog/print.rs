//! A module's file from top to bottom: header, ports, logic (by stage where there are stages), state, instances.

use super::super::module::{Module, NodeId, Op, Parameter, Rounded};
use super::Style;
use super::expression::{Expressions, range};
use super::layout::lay_out;
use super::line_memory::line_memory;
use super::names::Names;
use super::primitive;
use super::sections::Sections;
use super::unused::unused;

pub(super) fn print(module: &Module, style: &Style) -> String {
    let names = Names::of(module, &[module.clock(), style.reset_port()]);
    let expressions = Expressions { module, names: &names };
    let mut out = header(module, style);
    if module.size.is_some() {
        return out + &line_memory(&format!("{}{}", style.prefix, module.name), style.memories);
    }
    out += &interface(module, style, &names);
    out += &range_checks(module);
    out += &local_parameters(module);
    if module.reset.is_some() && module.has_reset_state() {
        out += &format!(
            "\n  // Resets this module; each instance has a register of its own.\n  wire {};\n",
            style.reset_port()
        );
    }
    let mut sections = Sections::new(module, style, &expressions);
    let body = sections.body() + &assignments(module, style, &names, &expressions) + &unused(module, &names);
    out += &match module.primitive {
        Some(primitive) => primitive::either(primitive, module, &body),
        None => body,
    };
    out += "\nendmodule\n\n`default_nettype wire\n";
    lay_out(&out)
}

fn header(module: &Module, style: &Style) -> String {
    let mut out = String::from("// SPDX-License-Identifier: MIT OR Apache-2.0\n");
    out += &format!("// {}{}\n", style.prefix, module.name);
    for line in &module.about {
        out += format!("// {line}").trim_end();
        out.push('\n');
    }
    if !style.header.is_empty() {
        out += "//\n";
    }
    for line in &style.header {
        out += &format!("// {line}\n");
    }
    out += "`default_nettype none\n\n";
    out
}

fn interface(module: &Module, style: &Style, names: &Names) -> String {
    let mut out = format!("module {}{}", style.prefix, module.name);
    if !module.parameters.is_empty() {
        let parameters: Vec<_> = module
            .parameters
            .iter()
            .filter(|p| p.rounded.is_none())
            .map(|p| format!("  parameter [31:0] {} = 32'd{} // {} to {}", p.name, p.default, p.min, p.max))
            .collect();
        out += &format!(" #(\n{}\n)", parameters.join(",\n"));
    }
    let ranges = module.ports.iter().map(|port| range(port.width).len()).max().unwrap_or(0);
    let mut ports = Vec::new();
    if module.is_clocked() {
        ports.push(format!("input  wire {:ranges$}{}", "", module.clock()));
    }
    if module.has_reset_port() {
        ports.push(format!("input  wire {:ranges$}{}", "", style.reset_port()));
    }
    for port in &module.ports {
        let direction = if port.output { "output" } else { "input " };
        let kind = match port.node {
            Some(id)
                if port.output
                    && names.is_port[id.index()]
                    && is_register(module, id)
                    && is_own(names, id, &port.name) =>
            {
                "reg "
            }
            _ => "wire",
        };
        ports.push(format!("{direction} {kind} {:<ranges$}{}", range(port.width), port.name));
    }
    out += &format!(" (\n  {}\n);\n", ports.join(",\n  "));
    out
}

fn is_own(names: &Names, id: NodeId, port: &str) -> bool {
    names.declared[id.index()].as_deref() == Some(port)
}

/// True if a node is a Verilog `reg`.
pub(super) fn is_register(module: &Module, id: NodeId) -> bool {
    matches!(module.node(id).op, Op::Delay { .. } | Op::Register { .. } | Op::MemoryRead { .. })
}

/// An instance of a module that does not exist fails elaboration in every tool, if the parameter is out of range.
fn range_checks(module: &Module) -> String {
    let check = |p: &Parameter| {
        let Parameter { name, min, max, .. } = p;
        let below = if *min > 0 { format!("({name} < 32'd{min}) || ") } else { String::new() };
        format!(
            "\n  // Elaboration fails here if {name} is out of range.\n  generate\n    if ({below}({name} > 32'd{max})) \
             begin : {name}_out_of_range\n      {name}_must_be_{min}_to_{max} failed ();\n    end\n  endgenerate\n"
        )
    };
    module.parameters.iter().filter(|parameter| parameter.rounded.is_none()).map(check).collect()
}

/// Parameters that are computed from others.
fn local_parameters(module: &Module) -> String {
    let local = |p: &Parameter| {
        let Rounded { of, multiple } = p.rounded?;
        let (name, of) = (&p.name, &module.parameters.get(of)?.name);
        Some(format!(
            "\n  // {of} up to {multiple}, and the whole {multiple}s of it above that.\n  localparam [31:0] {name} = \
             ({of} > 32'd{multiple}) ? ({of} / 32'd{multiple}) * 32'd{multiple} : {of};\n"
        ))
    };
    module.parameters.iter().filter_map(local).collect()
}

fn assignments(module: &Module, style: &Style, names: &Names, expressions: &Expressions<'_>) -> String {
    let mut out = String::new();
    if let Some(reset) = module.reset.filter(|_| module.has_reset_state()) {
        let level = if style.reset.active_low { "~" } else { "" };
        out += &format!("  assign {} = {level}{};\n", style.reset_port(), expressions.term(reset));
    }
    for port in module.ports.iter().filter(|port| port.output) {
        let Some(id) = port.node else { continue };
        if !is_own(names, id, &port.name) {
            out += &format!("  assign {} = {};\n", port.name, expressions.value(id));
        }
    }
    if out.is_empty() { out } else { format!("\n{out}") }
}
