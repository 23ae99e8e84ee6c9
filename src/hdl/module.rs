//! A finished module: checked, with every node reached by an output, in an order in which operands come first.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::instance::Instance;

/// A node's index in [`Module::nodes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(super) u32);

impl NodeId {
    /// The index into [`Module::nodes`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The operation of a node. Operands have the node's width unless stated otherwise.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// An input port.
    Input,
    /// The value of a Verilog parameter of this module: index into [`Module::parameters`].
    Parameter(usize),
    /// A constant; bits above 127 are zero.
    Constant(u128),
    /// Bitwise complement.
    Not,
    /// Bitwise and.
    And,
    /// Bitwise or.
    Or,
    /// Bitwise exclusive or.
    Xor,
    /// Sum modulo 2^width.
    Add,
    /// Difference modulo 2^width.
    Sub,
    /// Operands: two of the node's width, and one bit. First − second modulo 2^width, or first + second where the bit
    /// is set: one carry chain for both, which Sub, Add and Mux are not.
    SubAdd,
    /// Unsigned product: as wide as both operands together.
    Mul,
    /// One bit: operands (of equal width) are equal.
    Equal,
    /// One bit: first operand < second (of equal width), unsigned.
    Less,
    /// Operands: condition (1 bit), value if set, value if clear.
    Mux,
    /// Operands: a number of any width, then the value for each number, the last one also for all numbers above.
    Case {
        /// For each value, what it is for.
        notes: Arc<[String]>,
    },
    /// Operands from the most significant down, of any widths.
    Concat,
    /// `width` bits of the operand from bit `low` on.
    Slice {
        /// The lowest bit taken.
        low: u32,
    },
    /// One-hot decoder: of 2^n bits, the bit whose index is the operand (of n bits) is set.
    OneHot,
    /// The word of a table whose index is the operand, of n bits: a table has 2^n words.
    Lookup(Arc<[u128]>),
    /// One bit: some bit of the operand is set.
    Any,
    /// One bit: every bit of the operand is set.
    All,
    /// The operand `cycles` ≥ 1 clock cycles ago. Never reset, never stalled.
    Delay {
        /// The number of cycles.
        cycles: u32,
    },
    /// A register. Operands: next value, then an enable (1 bit) if it has one.
    Register {
        /// The value it begins with.
        start: Start,
        /// True for one of several equal registers that synthesis must keep.
        is_copy: bool,
    },
    /// The word read from a memory at the last clock edge, or the last at which the enable was set. Operands: address,
    /// then an enable (1 bit) if it has one.
    MemoryRead {
        /// Index into [`Module::memories`].
        memory: usize,
    },
    /// An output of an instance.
    InstanceOutput {
        /// Index into [`Module::instances`].
        instance: usize,
        /// Index into the ports of the instantiated module.
        port: usize,
    },
    /// Stands for a value that is driven later. Operand: the value. Not in a finished module.
    Wire,
}

/// The value with which a register begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Start {
    /// The value on reset.
    Reset(u128),
    /// The value when the device is configured; a reset does not change it.
    Configured(u128),
    /// Any value; a reset does not change it.
    Any,
}

/// One node of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// The operation.
    pub op: Op,
    /// The width in bits, at least 1.
    pub width: u32,
    /// The operands.
    pub operands: Vec<NodeId>,
    /// The name of the value, if it has one.
    pub name: Option<String>,
    /// The pipeline stage, if a scheduler has placed the node.
    pub stage: Option<u32>,
}

impl Node {
    /// True if a reset changes it.
    pub(super) fn is_reset(&self) -> bool {
        matches!(self.op, Op::Register { start: Start::Reset(_), .. })
    }
}

/// A port of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// The name.
    pub name: String,
    /// The width in bits.
    pub width: u32,
    /// True for an output; then `node` is the value driven.
    pub output: bool,
    /// The node of the input, or the value of the output. `None` if nothing uses the input.
    pub node: Option<NodeId>,
}

/// An integer parameter of the Verilog module, or a `localparam` that is computed from one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The name.
    pub name: String,
    /// The default value.
    pub default: u32,
    /// Smallest allowed value, checked at elaboration.
    pub min: u32,
    /// Largest allowed value, checked at elaboration.
    pub max: u32,
    /// How the value is computed, for a `localparam`. Nobody can override it.
    pub rounded: Option<Rounded>,
}

/// How a `localparam` follows from a parameter: the parameter's value up to `multiple`, and above that the largest
/// multiple of it that is not more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rounded {
    /// Index of the parameter, which comes first.
    pub of: usize,
    /// The value is rounded down to a multiple of this; at least 1.
    pub multiple: u32,
}

impl Rounded {
    /// The value for a value of the parameter.
    pub fn of(self, value: u32) -> u32 {
        if value > self.multiple { value - value % self.multiple } else { value }
    }
}

/// A memory with one write port and any number of registered read ports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Memory {
    /// The name.
    pub name: String,
    /// Words.
    pub depth: u32,
    /// Bits per word.
    pub width: u32,
    /// Write port: enable, address, data.
    pub write: Option<[NodeId; 3]>,
    /// True if it stands in look-up tables, if the device has such memories; otherwise in block RAM.
    pub in_luts: bool,
}

/// Up to this depth a memory goes to look-up tables, above it to block RAM.
const DEEPEST_DISTRIBUTED: u32 = 64;
/// A distributed memory has at most this many bits, a quarter of a block RAM.
const LARGEST_DISTRIBUTED: u32 = 4096;
/// A memory narrower than this would waste a block RAM.
const NARROWEST_BLOCK: u32 = 8;

/// True if a memory of this size goes to look-up tables.
pub(crate) const fn fits_luts(depth: u32, width: u32) -> bool {
    let is_small = depth <= DEEPEST_DISTRIBUTED && depth.saturating_mul(width) <= LARGEST_DISTRIBUTED;
    is_small || width < NARROWEST_BLOCK
}

/// A vendor's building block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Primitive {
    /// Lattice ECP5: 18 × 18 bits, with registers of factors and product.
    #[serde(rename = "MULT18X18D")]
    Mult18x18d,
    /// Lattice ECP5: two bits of a carry chain, each with the look-up table before it.
    #[serde(rename = "CCU2C")]
    Ccu2c,
    /// Lattice ECP5: a block memory of 1024 words of 18 bits with two ports, with registers of index and word.
    #[serde(rename = "DP16KD")]
    Dp16kd,
}

impl Primitive {
    /// The vendor's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mult18x18d => "MULT18X18D",
            Self::Ccu2c => "CCU2C",
            Self::Dp16kd => "DP16KD",
        }
    }

    /// The ending of the name of the module that models it.
    pub(super) const fn suffix(self) -> &'static str {
        match self {
            Self::Mult18x18d | Self::Ccu2c | Self::Dp16kd => "_ecp5",
        }
    }
}

/// The size of a memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// The number of words, at least 2.
    pub depth: u32,
    /// The bits of a word.
    pub width: u32,
}

/// The reset style of generated registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Reset {
    /// Reset acts without a clock edge.
    pub asynchronous: bool,
    /// Reset is active when low; the port is then `rst_n`.
    pub active_low: bool,
}

/// A checked module.
#[derive(Clone, Debug)]
pub struct Module {
    /// The name in Verilog.
    pub name: String,
    /// The description for its header: lines of text.
    pub about: Vec<String>,
    /// Ports in the order they were declared, without clock and reset.
    pub ports: Vec<Port>,
    /// Parameters.
    pub parameters: Vec<Parameter>,
    /// Nodes, operands before users but for registers' next values and instance inputs.
    pub nodes: Vec<Node>,
    /// Memories.
    pub memories: Vec<Memory>,
    /// Instances.
    pub instances: Vec<Instance>,
    /// The value (1 bit, high in reset) that resets this module, in place of a reset port. Each instance has its own.
    pub reset: Option<NodeId>,
    /// The name of the clock port, if it is not `clk`.
    pub clock: Option<&'static str>,
    /// For each port: the inputs (port indices) an output depends on without a register between.
    pub paths: Vec<BTreeSet<usize>>,
    /// Register ranks between inputs and outputs, for a pipeline.
    pub latency: u32,
    /// The vendor's primitive that synthesis takes in the place of its nodes.
    pub primitive: Option<Primitive>,
    /// The size of a memory whose file serves every size: its Verilog has the size as parameters, which an instance
    /// sets.
    pub size: Option<Size>,
    /// The timing of its stages, for a pipeline made by [`cut`](super::cut).
    pub timing: Option<super::Timing>,
}

/// Only a delay of at most this many cycles is a row of registers with their own names.
pub const LONGEST_REGISTER_DELAY: u32 = 3;
/// A wide delay of at least this many cycles is a memory. Two registers cost no more than a memory and its output
/// register.
const SHORTEST_MEMORY_DELAY: u32 = 3;
/// A longer delay of fewer bits than this is a shift register: a memory is never narrower than a few bits, and its
/// pointer costs more than it saves.
const NARROWEST_MEMORY_DELAY: u32 = 12;
/// A shift register never has more bits than this.
const MOST_SHIFT_REGISTER_BITS: u32 = 64;
/// One primitive of distributed memory is so deep on every family (ECP5 16, 7 series and Cyclone V 32). A longer delay
/// in distributed memory is several, one behind the other: so no choice of primitives lies before the register.
pub(super) const DISTRIBUTED_DEPTH: u32 = 16;
/// A longer delay is one memory, a block RAM. Not sooner: on ECP5 a word takes 5.2 ns out of a block RAM without its
/// own output register, which synthesis does not find, and what follows a delay would have to be as slow.
pub(super) const LONGEST_DISTRIBUTED_DELAY: u32 = 256;

/// True if a delay of a value of `width` bits is a memory with a pointer.
pub(super) fn is_memory_delay(cycles: u32, width: u32) -> bool {
    if width >= NARROWEST_MEMORY_DELAY {
        cycles >= SHORTEST_MEMORY_DELAY
    } else {
        cycles > LONGEST_REGISTER_DELAY && width.saturating_mul(cycles) > MOST_SHIFT_REGISTER_BITS
    }
}

impl Module {
    /// The node behind an id.
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.index()]
    }

    /// The bit that a value is copies of, side by side.
    pub(super) fn repeated_bit(&self, id: NodeId) -> Option<NodeId> {
        let node = self.node(id);
        let first = *node.operands.first().filter(|_| node.op == Op::Concat)?;
        (self.node(first).width == 1 && node.operands.iter().all(|part| *part == first)).then_some(first)
    }

    /// The port of that name and its index.
    pub fn port(&self, name: &str) -> Option<(usize, &Port)> {
        self.ports.iter().enumerate().find(|(_, port)| port.name == name)
    }

    /// Ids of all nodes, operands first.
    pub fn ids(&self) -> impl Iterator<Item = NodeId> + use<> {
        (0..self.nodes.len() as u32).map(NodeId)
    }

    /// The name of the clock port.
    pub(crate) fn clock(&self) -> &'static str {
        self.clock.unwrap_or("clk")
    }

    /// True if anything inside is clocked.
    pub(crate) fn is_clocked(&self) -> bool {
        !self.memories.is_empty()
            || self.nodes.iter().any(|n| matches!(n.op, Op::Delay { .. } | Op::Register { .. } | Op::MemoryRead { .. }))
            || self.instances.iter().any(|i| i.module.is_clocked())
    }

    /// True if it has a reset port: something inside is reset, and not by the module itself.
    pub fn has_reset_port(&self) -> bool {
        self.reset.is_none() && self.is_reset()
    }

    /// True if anything inside is reset.
    pub(crate) fn is_reset(&self) -> bool {
        self.has_reset_state() || self.instances.iter().any(|i| i.module.is_reset())
    }

    /// True if anything is reset that is in no instance.
    pub(crate) fn has_reset_state(&self) -> bool {
        self.nodes.iter().any(Node::is_reset)
    }

    /// This module and all modules below it, each once, instantiated ones first.
    pub fn hierarchy(self: &Arc<Self>) -> Vec<Arc<Module>> {
        fn visit(module: &Arc<Module>, found: &mut Vec<Arc<Module>>) {
            if found.iter().any(|m| m.name == module.name) {
                return;
            }
            for instance in &module.instances {
                visit(&instance.module, found);
            }
            found.push(module.clone());
        }
        let mut found = Vec::new();
        visit(self, &mut found);
        found
    }
}
