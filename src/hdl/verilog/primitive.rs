//! A vendor's primitive for synthesis, beside the plain logic that simulators read.

use std::ops::Range;

use super::super::module::{Module, Op, Primitive};

/// Bits of a factor of a MULT18X18D.
const FACTOR: u32 = 18;

/// The primitive where the macro `SYNTHESIS` is defined, as synthesis programs do; `behaviour` elsewhere.
pub(super) fn either(primitive: Primitive, module: &Module, behaviour: &str) -> String {
    let instance = match primitive {
        Primitive::Mult18x18d => mult18x18d(module),
        Primitive::Ccu2c => ccu2c(module),
        Primitive::Dp16kd => dp16kd(module),
    };
    format!("\n`ifdef SYNTHESIS\n{instance}`else\n{behaviour}`endif\n")
}

/// Ports `a` and `b` into the low bits of the factors, the product out of the low bits of the block's.
///
/// The primitive has one port per bit, and each must be connected.
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

/// Ports `a`, `b`, `add` and `result`. A CCU2C has two bits of the chain, each with a table. The upper half of the
/// table says when the carry passes, here a ^ b ^ ~add. Its lowest bits make the carry where it does not pass, here a.
/// The lowest bit of the chain only makes the first carry, ~add.
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

/// Bits of a word of a DP16KD; among its initial values each has 20, five hexadecimal digits.
const WORD: u32 = 18;
/// The words in one initial value, the number of initial values, and the words in half of the memory.
const WORDS: usize = 16;
const VALUES: usize = 64;
const HALF: usize = WORDS * VALUES / 2;

/// A table, or a memory that is written too.
fn dp16kd(module: &Module) -> String {
    let Block { word, parameters, ports } = if module.memories.is_empty() { table(module) } else { memory(module) };
    let lines: Vec<String> = ports.iter().flat_map(|group| group.chunks(6)).map(|line| line.join(", ")).collect();
    let all = 2 * WORD;
    let mut out = format!("  wire [{}:0] whole;\n", all - 1);
    out += &format!("  DP16KD #(\n{}\n  ) block (\n    {}\n  );\n", parameters.join(",\n"), lines.join(",\n    "));
    out += &format!("  assign word = whole[{}:{}];\n", word.end - 1, word.start);
    let unused: Vec<_> = [word.end..all, 0..word.start]
        .into_iter()
        .filter(|bits| !bits.is_empty())
        .map(|bits| format!("whole[{}:{}]", bits.end - 1, bits.start))
        .collect();
    if !unused.is_empty() {
        out += &format!("\n  // Bits that nothing needs.\n  wire unused = &{{1'b0, {}}};\n", unused.join(", "));
    }
    out
}

/// How a block memory is used.
struct Block {
    /// Where the word stands among the bits that both ports read.
    word: Range<u32>,
    parameters: Vec<String>,
    /// The connections of ports A and B.
    ports: [Vec<String>; 2],
}

fn width(module: &Module, port: &str) -> u32 {
    module.port(port).map_or(0, |(_, port)| port.width)
}

/// A bit of a port, or zero beyond it.
fn bit(module: &Module, port: &str, place: u32) -> String {
    match width(module, port) {
        width if place >= width => "1'b0".to_owned(),
        1 => port.to_owned(),
        _ => format!("{port}[{place}]"),
    }
}

fn modes(bits: u32) -> [String; 2] {
    ["A", "B"]
        .map(|port| format!("    .DATA_WIDTH_{port}({bits}), .REGMODE_{port}(\"OUTREG\"), .CSDECODE_{port}(\"0b000\")"))
}

/// The connections of a port: its address from the lowest bit, the word to write, when the port writes and reads, and
/// when its register takes a word. Of a word that is read, port A has the low half and port B the high half.
fn port(
    letter: &str,
    address: [String; 14],
    written: impl Fn(u32) -> String,
    [write, read, advance]: [&str; 3],
) -> Vec<String> {
    let first = if letter == "A" { 0 } else { WORD };
    let mut ports: Vec<String> = (0..14).map(|bit| format!(".AD{letter}{bit}({})", address[bit])).collect();
    ports.extend((0..WORD).map(|bit| format!(".DI{letter}{bit}({})", written(first + bit))));
    ports.extend((0..WORD).map(|bit| format!(".DO{letter}{bit}(whole[{}])", first + bit)));
    ports.push(format!(".CLK{letter}(clk)"));
    ports.extend([format!(".WE{letter}({write})"), format!(".CE{letter}({read})"), format!(".OCE{letter}({advance})")]);
    ports.push(format!(".RST{letter}(1'b0)"));
    ports.extend((0..3).map(|bit| format!(".CS{letter}{bit}(1'b0)")));
    ports
}

/// Ports `index` and `word`. Both ports of the memory read: one the low 18 bits of the word, from the lower half of the
/// memory, and the other one the remaining bits, from the upper half. A table of more words fills both halves, and both
/// ports read the same.
fn table(module: &Module) -> Block {
    let table = module.nodes.iter().find_map(|node| if let Op::Lookup(table) = &node.op { Some(table) } else { None });
    let is_deep = table.is_some_and(|table| table.len() > HALF);
    let part = |address: usize| {
        let place = if is_deep { address } else { address % HALF };
        let word = table.and_then(|table| table.get(place)).copied().unwrap_or_default();
        let part = if is_deep || address < HALF { word } else { word >> WORD };
        part & ((1 << WORD) - 1)
    };
    let value = |number: usize| {
        let words = (0..WORDS).rev().map(|place| format!("{:05x}", part(number * WORDS + place)));
        format!("    .INITVAL_{number:02X}(320'h{})", words.collect::<String>())
    };
    let is_used = |number: &usize| (0..WORDS).any(|place| part(number * WORDS + place) != 0);
    let parameters = (0..VALUES).filter(is_used).map(value).chain(modes(WORD)).collect();
    let connected = |letter: &str, half: u32| {
        let address = std::array::from_fn(|place| match place {
            0..4 => "1'b0".to_owned(),
            13 if !is_deep => format!("1'b{half}"),
            _ => bit(module, "index", place as u32 - 4),
        });
        port(letter, address, |_| "1'b0".to_owned(), ["1'b0", "1'b1", "1'b1"])
    };
    Block { word: 0..width(module, "word"), parameters, ports: [connected("A", 0), connected("B", 1)] }
}

/// Ports `write_index`, `write_word`, `read_index` and `word`; `write`, `read` and `advance` if the module has them.
/// Port A writes whole words, port B reads them. In half of the memory's words are up to 36 bits, and each port has
/// half of the word that was read, in its own register. Otherwise they are up to 18 bits, and port B has them.
fn memory(module: &Module) -> Block {
    let is_deep = module.memories.iter().any(|memory| memory.depth as usize > HALF);
    // The lowest bits of an address that is written choose the bytes, of which a word of 18 bits has two.
    let (bytes, lowest, bits, first) = if is_deep { (2, 4, WORD, WORD) } else { (4, 5, 2 * WORD, 0) };
    let address = |index: &str, low: &str| {
        std::array::from_fn(|place| match place {
            _ if place < bytes => low.to_owned(),
            _ if place < lowest => "1'b0".to_owned(),
            _ => bit(module, index, (place - lowest) as u32),
        })
    };
    let written = |place: u32| bit(module, "write_word", place);
    let given = |port: &str, text: &'static str, otherwise| if module.port(port).is_some() { text } else { otherwise };
    let [write, read, advance] = ["write", "read", "advance"].map(|name| given(name, name, "1'b1"));
    let a = port("A", address("write_index", "1'b1"), written, [write, "1'b1", advance]);
    let b = port("B", address("read_index", "1'b0"), written, ["1'b0", read, advance]);
    Block { word: first..first + width(module, "word"), parameters: modes(bits).to_vec(), ports: [a, b] }
}
