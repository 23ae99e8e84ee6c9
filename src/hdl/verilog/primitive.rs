//! A vendor's primitive for synthesis, beside the plain logic that simulators read.

use super::super::module::{Module, Primitive};

/// Bits of a factor of a MULT18X18D.
const FACTOR: u32 = 18;

/// The primitive where the macro `SYNTHESIS` is defined, as synthesis programs do; `behaviour` elsewhere.
pub(super) fn either(primitive: Primitive, module: &Module, behaviour: &str) -> String {
    let instance = match primitive {
        Primitive::Mult18x18d => mult18x18d(module),
        Primitive::Ccu2c => ccu2c(module),
    };
    format!("\n`ifdef SYNTHESIS\n{instance}`else\n{behaviour}`endif\n")
}

/// Ports `a` and `b` into the low bits of the factors, the product out of the low bits of the block's.
///
/// The primitive has a port a bit, and wants each one connected.
fn mult18x18d(module: &Module) -> String {
    let width = |name: &str| module.port(name).map_or(0, |(_, port)| port.width);
    let factor = |port: &str| {
        let width = width(port);
        let bit = |index: u32| match index {
            _ if index >= width => "1'b0".to_owned(),
            _ if width == 1 => port.to_owned(),
            _ => format!("{port}[{index}]"),
        };
        let letter = port.to_uppercase();
        (0..FACTOR).map(|index| format!(".{letter}{index}({})", bit(index))).collect::<Vec<_>>()
    };
    let product = (0..2 * FACTOR).map(|index| format!(".P{index}(whole[{index}])")).collect::<Vec<_>>();
    let constant = ["SIGNEDA", "SIGNEDB", "SOURCEA", "SOURCEB", "RST0", "RST1", "RST2", "RST3", "CE1", "CE2", "CE3"];
    let tied = constant.map(|port| format!(".{port}(1'b0)")).to_vec();
    let clocks = [".CLK0(clk)", ".CLK1(1'b0)", ".CLK2(1'b0)", ".CLK3(1'b0)", ".CE0(1'b1)"].map(str::to_owned).to_vec();
    let lines: Vec<String> = [factor("a"), factor("b"), product, tied, clocks]
        .iter()
        .flat_map(|group| group.chunks(6))
        .map(|line| line.join(", "))
        .collect();
    let registers = ["INPUTA", "INPUTB", "OUTPUT"].map(|register| format!("    .REG_{register}_CLK(\"CLK0\")"));
    let (all, used) = (2 * FACTOR, width("product"));
    let mut out = format!("  wire [{}:0] whole;\n", all - 1);
    out += &format!("  MULT18X18D #(\n{}\n  ) block (\n    {}\n  );\n", registers.join(",\n"), lines.join(",\n    "));
    out += &format!("  assign product = whole[{}:0];\n", used - 1);
    if used < all {
        out += &format!("\n  // Bits that nothing needs.\n  wire unused = &{{1'b0, whole[{}:{used}]}};\n", all - 1);
    }
    out
}

/// Ports `a`, `b`, `add` and `result`. A CCU2C has two bits of the chain, each with a table whose upper half is what passes
/// the carry on, here a ^ b ^ ~add, and whose lowest bits make it where nothing passes it on, here a. The lowest bit of
/// all only makes the first carry, which is ~add.
fn ccu2c(module: &Module) -> String {
    let width = module.port("result").map_or(1, |(_, port)| port.width);
    let cells = (width + 1).div_ceil(2);
    let all = 2 * cells;
    let pad = if all > width + 1 { "1'b0, " } else { "" };
    let mut out =
        format!("  wire [{0}:0] chain_a = {{{pad}a, add}};\n  wire [{0}:0] chain_b = {{{pad}b, 1'b0}};\n", all - 1);
    out += &format!("  wire [{}:0] whole;\n  wire [{cells}:0] carry;\n  assign carry[0] = 1'b0;\n", all - 1);
    out += "  genvar index;\n  generate\n";
    out += &format!("    for (index = 0; index < {cells}; index = index + 1) begin : two_bits\n");
    out += "      CCU2C #(\n        .INIT0(index == 0 ? 16'b0000_0000_0000_0101 : 16'b0110_1001_1010_1010),\n";
    out += "        .INIT1(16'b0110_1001_1010_1010),\n";
    out += "        .INJECT1_0(\"NO\"),\n        .INJECT1_1(\"NO\")\n      ) slice (\n        .CIN(carry[index]),\n";
    for bit in 0..2 {
        let at = if bit == 0 { "2 * index" } else { "2 * index + 1" };
        let inputs = format!(".A{bit}(chain_a[{at}]), .B{bit}(chain_b[{at}]), .C{bit}(add), .D{bit}(1'b1)");
        out += &format!("        {inputs}, .S{bit}(whole[{at}]),\n");
    }
    out += "        .COUT(carry[index + 1])\n      );\n    end\n  endgenerate\n";
    out += &format!("  assign result = whole[{width}:1];\n");
    let mut unused = vec![format!("carry[{cells}]"), "whole[0]".to_owned()];
    if all > width + 1 {
        unused.push(format!("whole[{}]", width + 1));
    }
    out += &format!("\n  // Bits that nothing needs.\n  wire unused = &{{1'b0, {}}};\n", unused.join(", "));
    out
}
