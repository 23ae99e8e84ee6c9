//! A vendor's primitive for synthesis, beside the plain logic that simulators read.

use super::super::module::{Module, Primitive};

/// Bits of a factor of a MULT18X18D.
const FACTOR: u32 = 18;

/// The primitive where the macro `SYNTHESIS` is defined, as synthesis programs do; `behaviour` elsewhere.
pub(super) fn either(primitive: Primitive, module: &Module, behaviour: &str) -> String {
    let instance = match primitive {
        Primitive::Mult18x18d => mult18x18d(module),
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
