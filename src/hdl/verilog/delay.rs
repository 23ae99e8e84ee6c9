//! Delays: written as registers, as a shift register if narrow, otherwise as a memory with a pointer.

use super::super::module::{LONGEST_REGISTER_DELAY, Node, Op, is_memory_delay};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DelayKind {
    /// One register: a delay of a few cycles is a chain of such.
    Register,
    /// A register after a shift register of this number of words.
    Shift(u32),
    /// A register after a memory of this number of words.
    Memory(u32),
}

impl DelayKind {
    /// The kind of a delay; `None` for other nodes.
    pub fn of(node: &Node) -> Option<Self> {
        let Op::Delay { cycles } = node.op else { return None };
        Some(if is_memory_delay(cycles, node.width) {
            Self::Memory(cycles)
        } else if cycles > LONGEST_REGISTER_DELAY {
            Self::Shift(cycles - 1)
        } else {
            Self::Register
        })
    }

    /// The depth of the memory behind a delay that has one.
    pub fn memory_depth(node: &Node) -> Option<u32> {
        match Self::of(node) {
            Some(Self::Memory(depth)) => Some(depth),
            _ => None,
        }
    }

    /// The statements of the delay `node`, called `name`, at the clock edge.
    pub fn clocked(node: &Node, name: &str, source: &str) -> String {
        let width = node.width;
        match Self::of(node) {
            Some(Self::Memory(depth)) => {
                let write = format!("    {name}_line[newest_of_{depth}] <= {source};\n");
                write + &format!("    {name} <= {name}_line[oldest_of_{depth}];\n")
            }
            Some(Self::Shift(waiting)) => {
                let bits = waiting * width;
                let rest = format!("{name}_line[{}:0]", bits - width - 1);
                let oldest = match width {
                    1 => format!("{}", bits - 1),
                    _ => format!("{}:{}", bits - 1, bits - width),
                };
                let shift = format!("    {name}_line <= {{{rest}, {source}}};\n");
                shift + &format!("    {name} <= {name}_line[{oldest}];\n")
            }
            _ => format!("    {name} <= {source};\n"),
        }
    }
}
