//! The body of a module: logic, registers, memories and delay lines, by stage where there are stages.

use std::collections::BTreeSet;

use super::super::instance::{Instance, InstanceCount};
use super::super::module::{Memory, Module, NodeId, Op, Start, fits_luts};
use super::super::state::address_width;
use super::cases::Cases;
use super::delay::DelayKind;
use super::derive::stage;
use super::expression::{Expressions, constant, range};
use super::lookup::{is_block_memory, lookup};
use super::print::is_register;
use super::{Memories, Style};

/// The attribute of a block memory. No word is used that was read in the cycle in which it was written: without saying
/// so, synthesis puts a register and a choice behind each bit.
pub(super) const fn block_style(memories: Memories) -> &'static str {
    match memories {
        Memories::Any => "  (* ram_style = \"block\", ramstyle = \"no_rw_check\" *)\n",
        Memories::BlocksAndLuts | Memories::Blocks => "  (* ram_style = \"block\", no_rw_check *)\n",
    }
}

/// What keeps a copy of a register: in Yosys (on the clocked block too) and Vivado, and in Quartus.
const COPY_ATTRIBUTES: &str = "(* keep = \"true\", dont_merge *) ";
const KEEP: &str = "(* keep = \"true\" *) ";

fn is_copy(module: &Module, id: NodeId) -> bool {
    matches!(module.node(id).op, Op::Register { is_copy: true, .. })
}

pub(super) struct Sections<'a> {
    pub(super) module: &'a Module,
    pub(super) style: &'a Style,
    pub(super) text: &'a Expressions<'a>,
}

impl<'a> Sections<'a> {
    pub fn new(module: &'a Module, style: &'a Style, text: &'a Expressions<'a>) -> Self {
        Self { module, style, text }
    }

    pub fn body(&mut self) -> String {
        let staged = self.module.nodes.iter().any(|node| node.stage.is_some());
        let pointers = self.delay_pointers();
        let body = if staged && self.is_feed_forward() { self.by_stage() } else { self.by_kind() };
        pointers + &body
    }

    /// True if every value has its stage, so that the file can be ordered by stage.
    fn is_feed_forward(&self) -> bool {
        let staged = |id: NodeId| match self.module.node(id).op {
            Op::Register { .. } => false,
            Op::InstanceOutput { instance, .. } => {
                self.module.instances[instance].count == InstanceCount::One && stage(self.module, id).is_some()
            }
            _ => true,
        };
        self.module.memories.is_empty() && self.module.ids().all(staged)
    }

    /// The stage in which an instance takes its inputs.
    fn begins(&self, instance: &Instance) -> u32 {
        let inputs = instance.inputs.iter().flatten();
        inputs.filter_map(|id| stage(self.module, *id)).max().unwrap_or(0)
    }

    /// A pipeline: each stage's logic, then the registers that end it.
    fn by_stage(&self) -> String {
        let mut out = String::new();
        let last = self.module.ids().filter_map(|id| stage(self.module, id)).max().unwrap_or(0);
        for number in 0..=last {
            let here = |id: &NodeId| stage(self.module, *id) == Some(number);
            let arriving: Vec<_> = self.module.ids().filter(here).filter(|id| is_register(self.module, *id)).collect();
            let logic = self.logic(self.module.ids().filter(here));
            let instances: Vec<usize> = (0..self.module.instances.len())
                .filter(|index| self.begins(&self.module.instances[*index]) == number)
                .collect();
            if arriving.is_empty() && logic.is_empty() && instances.is_empty() {
                continue;
            }
            out += &if number == last && logic.is_empty() {
                "\n  // ---- registered outputs ----\n".to_owned()
            } else {
                format!("\n  // ---- stage {number} ----\n")
            };
            out += &self.registers(&arriving);
            out += &logic;
            for index in instances {
                out += &self.instance_outputs(index);
                out += self.instance(&self.module.instances[index]).trim_start_matches('\n');
            }
        }
        out
    }

    /// State first, since logic may use it before what feeds it is known; then logic, clocked blocks, instances.
    fn by_kind(&self) -> String {
        let state: Vec<_> =
            self.module.ids().filter(|id| is_register(self.module, *id) && !self.is_array_output(*id)).collect();
        let mut out = String::new();
        let memories: String = self.module.memories.iter().map(|memory| self.memory_declaration(memory)).collect();
        if !memories.is_empty() {
            out += &format!("\n  // ---- memories ----\n{memories}");
        }
        let declared: String = state.iter().map(|id| self.declaration(*id)).collect();
        if !declared.is_empty() {
            out += &format!("\n  // ---- state ----\n{declared}");
        }
        let instances: String = (0..self.module.instances.len()).map(|index| self.instance_outputs(index)).collect();
        if !instances.is_empty() {
            out += &format!("\n  // ---- outputs of instances ----\n{instances}");
        }
        let logic = self.logic(self.module.ids());
        if !logic.is_empty() {
            out += &format!("\n  // ---- logic ----\n{logic}");
        }
        let clocked = self.clocked(&state);
        if !clocked.is_empty() {
            out += &format!("\n  // ---- at the clock edge ----\n{clocked}");
        }
        for instance in &self.module.instances {
            out += &self.instance(instance);
        }
        out
    }

    fn is_array_output(&self, id: NodeId) -> bool {
        matches!(self.module.node(id).op, Op::InstanceOutput { .. })
    }

    /// Declarations and clocked block of the registers that begin a stage.
    fn registers(&self, ids: &[NodeId]) -> String {
        let declared: String = ids.iter().map(|id| self.declaration(*id)).collect();
        declared + &self.clocked(ids)
    }

    fn declaration(&self, id: NodeId) -> String {
        let node = self.module.node(id);
        let Some(name) = &self.text.names.declared[id.index()] else { return String::new() };
        let mut out = String::new();
        match DelayKind::of(node) {
            Some(DelayKind::Memory(depth)) => {
                out += &self.ram(&format!("{name}_line"), (depth, node.width), fits_luts(depth, node.width))
            }
            Some(DelayKind::Shift(waiting)) => out += &format!("  reg {}{name}_line;\n", range(waiting * node.width)),
            Some(DelayKind::Register) | None => {}
        }
        if !self.text.names.is_port[id.index()] {
            let kept = if is_copy(self.module, id) { COPY_ATTRIBUTES } else { "" };
            out += &format!("  {kept}reg {}{name};\n", range(node.width));
            if let Op::Register { start: Start::Configured(value), .. } = node.op {
                out += &format!("  initial {name} = {};\n", constant(node.width, value));
            }
        }
        out
    }

    fn logic(&self, ids: impl Iterator<Item = NodeId>) -> String {
        let mut out = String::new();
        for id in ids {
            let node = self.module.node(id);
            let Some(name) = &self.text.names.declared[id.index()] else { continue };
            if matches!(node.op, Op::Input | Op::InstanceOutput { .. }) || is_register(self.module, id) {
                continue;
            }
            if let Op::Lookup(table) = &node.op {
                out +=
                    &lookup(name, node.width, table, &self.text.value(node.operands[0]), is_block_memory(self.module));
                continue;
            }
            let value = self.text.definition(id);
            out += &if self.text.names.is_port[id.index()] {
                format!("  assign {name} = {value};\n")
            } else {
                format!("  wire {}{name} = {value};\n", range(node.width))
            };
        }
        out
    }

    /// Clocked blocks: one for data, one for what is reset; and the same for copies, which synthesis is to keep.
    fn clocked(&self, ids: &[NodeId]) -> String {
        let (copies, others): (Vec<_>, Vec<_>) = ids.iter().copied().partition(|id| is_copy(self.module, *id));
        let copies = self.clocked_alike(&copies, false).replace("  always ", &format!("  {KEEP}always "));
        self.clocked_alike(&others, true) + &copies
    }

    fn clocked_alike(&self, ids: &[NodeId], with_memories: bool) -> String {
        let (mut data, mut cases) = (String::new(), Cases::new(self.module, self.text));
        let (mut reset, mut running) = (String::new(), String::new());
        for id in ids {
            let node = self.module.node(*id);
            let Some(name) = &self.text.names.declared[id.index()] else { continue };
            let operand = |position: usize| self.text.value(node.operands[position]);
            let enable = || match node.operands.get(1) {
                Some(id) => format!("if ({}) ", self.text.value(*id)),
                None => String::new(),
            };
            match &node.op {
                Op::Delay { .. } => data += &DelayKind::clocked(node, name, &operand(0)),
                Op::MemoryRead { memory } => {
                    let memory = &self.module.memories[*memory].name;
                    data += &format!("    {}{name} <= {memory}[{}];\n", enable(), operand(0));
                }
                Op::Register { start: Start::Any, is_copy: false } if cases.take(name, node) => {}
                Op::Register { start, .. } => {
                    let line = format!("{}{name} <= {};\n", enable(), operand(0));
                    match start {
                        Start::Reset(value) => {
                            reset += &format!("      {name} <= {};\n", constant(node.width, *value));
                            running += &format!("      {line}");
                        }
                        Start::Configured(_) | Start::Any => data += &format!("    {line}"),
                    }
                }
                _ => {}
            }
        }
        for memory in self.module.memories.iter().filter(|_| with_memories) {
            if let Some([enable, address, word]) = memory.write {
                data += &format!(
                    "    if ({}) {}[{}] <= {};\n",
                    self.text.value(enable),
                    memory.name,
                    self.text.value(address),
                    self.text.value(word)
                );
            }
        }
        let mut out = String::new();
        if !data.is_empty() {
            out += &format!("  always @(posedge {}) begin\n{data}  end\n", self.module.clock());
        }
        out += &cases.text();
        if !reset.is_empty() {
            out += &self.reset_block(&reset, &running);
        }
        out
    }

    fn reset_block(&self, reset: &str, running: &str) -> String {
        let port = self.style.reset_port();
        let (edge, test) = if self.style.reset.active_low {
            (format!("negedge {port}"), format!("!{port}"))
        } else {
            (format!("posedge {port}"), port.to_owned())
        };
        let clock = format!("posedge {}", self.module.clock());
        let sensitivity = if self.style.reset.asynchronous { format!("{clock} or {edge}") } else { clock };
        format!(
            "  always @({sensitivity}) begin\n    if ({test}) begin\n{reset}    end else begin\n{running}    end\n  end\n"
        )
    }

    /// Two places for all delay lines of a depth: where the newest word goes, and one ahead of it, where the oldest is
    /// read. Both are registers, so that no sum stands before a memory. From any values they come right by themselves:
    /// a reset would be a wire to every delay line.
    fn delay_pointers(&self) -> String {
        let depths: BTreeSet<u32> = self.module.nodes.iter().filter_map(DelayKind::memory_depth).collect();
        let mut out = String::new();
        for depth in depths {
            let width = address_width(depth);
            let (newest, oldest) = (format!("newest_of_{depth}"), format!("oldest_of_{depth}"));
            let [zero, one, last] = [0, 1, depth - 1].map(|place| constant(width, place.into()));
            let clock = self.module.clock();
            out +=
                &format!("\n  // Places of the newest and of the oldest word in the delay lines of {depth} cycles.\n");
            for (place, first) in [(&newest, &zero), (&oldest, &one)] {
                out += &format!("  reg {}{place};\n  initial {place} = {first};\n", range(width));
            }
            out += &format!("  always @(posedge {clock}) begin\n    {newest} <= {oldest};\n");
            let next = if depth.is_power_of_two() {
                format!("{oldest} + {one}")
            } else {
                format!("({oldest} == {last}) ? {zero} : ({oldest} + {one})")
            };
            out += &format!("    {oldest} <= {next};\n  end\n");
        }
        out
    }

    fn memory_declaration(&self, memory: &Memory) -> String {
        self.ram(&memory.name, (memory.depth, memory.width), memory.in_luts)
    }

    fn ram(&self, name: &str, (depth, width): (u32, u32), in_luts: bool) -> String {
        let attributes = match (self.style.memories, in_luts) {
            (Memories::Any, true) => "  (* ram_style = \"distributed\", ramstyle = \"MLAB, no_rw_check\" *)\n",
            (Memories::BlocksAndLuts, true) => "  (* ram_style = \"distributed\" *)\n",
            (Memories::Blocks, true) => "",
            (memories, false) => block_style(memories),
        };
        format!("{attributes}  reg {}{name} [0:{}];\n", range(width), depth - 1)
    }
}
