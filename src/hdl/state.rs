//! State: registers and memories. Also instances of other modules.

use std::ops::Deref;
use std::panic::Location;
use std::sync::Arc;

use super::graph::{Graph, is_identifier};
use super::instance::{Instance, InstanceCount};
use super::module::{Memory, Module, Op, Start, fits_luts};
use super::signal::Signal;

/// A register under construction. It reads as its present value.
#[derive(Clone, Copy, Debug)]
pub struct Register<'g>(Signal<'g>);

impl<'g> Deref for Register<'g> {
    type Target = Signal<'g>;

    fn deref(&self) -> &Signal<'g> {
        &self.0
    }
}

impl<'g> Register<'g> {
    /// The present value.
    pub fn value(self) -> Signal<'g> {
        self.0
    }

    /// Takes `next` at every clock edge.
    #[track_caller]
    pub fn next(self, next: Signal<'g>) {
        self.connect(&[next], Location::caller());
    }

    /// Takes `next` at the clock edges at which `enable` is set.
    #[track_caller]
    pub fn next_if(self, enable: Signal<'g>, next: Signal<'g>) {
        if enable.width() > 1 {
            let message = format!("enable of register `{}` has {} bits, not 1", self.0.describe(), enable.width());
            self.0.graph().error(message, Location::caller());
        }
        self.connect(&[next, enable], Location::caller());
    }

    fn connect(self, inputs: &[Signal<'g>], place: &'static Location<'static>) {
        let graph = self.0.graph();
        let Some(id) = self.0.id() else { return };
        let Some(ids) = graph.own("register", inputs, place) else { return };
        if inputs[0].width() != self.0.width() {
            let message = format!(
                "register `{}` has {} bits, its next value `{}` has {}",
                self.0.describe(),
                self.0.width(),
                inputs[0].describe(),
                inputs[0].width()
            );
            return graph.error(message, place);
        }
        if !graph.node(id).operands.is_empty() {
            return graph.error(format!("register `{}` is connected twice", self.0.describe()), place);
        }
        graph.inner.borrow_mut().nodes[id.index()].operands = ids;
    }
}

impl<'g> Signal<'g> {
    /// A register of this name, zero after reset, which takes this value at every clock edge.
    #[track_caller]
    pub fn registered(self, name: &str) -> Signal<'g> {
        let register = self.graph().register(name, self.width(), 0);
        register.next(self);
        register.value()
    }

    #[track_caller]
    fn copied(self, name: &str, count: u32, start: Start) -> Vec<Signal<'g>> {
        let (graph, place) = (self.graph(), Location::caller());
        let copy = |index: u32| {
            let op = Op::Register { start, is_copy: true };
            let register =
                Register(graph.fresh(op, self.width(), vec![], place).named(&format!("{name}_copy_{index}")));
            register.next(self);
            register.value()
        };
        (0..count).map(copy).collect()
    }

    /// Equal registers, zero after reset, which take this value at every clock edge. Synthesis neither merges nor
    /// removes them, so each can be placed beside its loads, where one register would drive too many. An equal register
    /// that is no copy may become one of them.
    #[track_caller]
    pub fn copies(self, name: &str, count: u32) -> Vec<Signal<'g>> {
        self.copied(name, count, Start::Reset(0))
    }

    /// As [`Signal::copies`], without reset.
    #[track_caller]
    pub fn data_copies(self, name: &str, count: u32) -> Vec<Signal<'g>> {
        self.copied(name, count, Start::Any)
    }
}

/// A memory under construction.
#[derive(Clone, Copy)]
pub struct MemoryHandle<'g> {
    graph: &'g Graph,
    index: usize,
    width: u32,
    address_width: u32,
}

impl<'g> MemoryHandle<'g> {
    /// This memory in look-up tables, whatever its size: its words come early enough in a cycle to steer something.
    #[must_use]
    pub(crate) fn in_luts(self) -> Self {
        self.graph.inner.borrow_mut().memories[self.index].in_luts = true;
        self
    }

    /// Writes `data` to `address` at the clock edges at which `enable` is set. A memory can have one write.
    #[track_caller]
    pub fn write(self, enable: Signal<'g>, address: Signal<'g>, data: Signal<'g>) {
        let place = Location::caller();
        let Some(ids) = self.graph.own("memory write", &[enable, address, data], place) else { return };
        let mut wrong = Vec::new();
        for (what, got, wanted) in [
            ("enable", enable.width(), 1),
            ("address", address.width(), self.address_width),
            ("data", data.width(), self.width),
        ] {
            if got != wanted {
                wrong.push(format!("{what} has {got} bits, not {wanted}"));
            }
        }
        let name = self.graph.inner.borrow().memories[self.index].name.clone();
        if !wrong.is_empty() {
            return self.graph.error(format!("memory `{name}`: {}", wrong.join(", ")), place);
        }
        if self.graph.inner.borrow().memories[self.index].write.is_some() {
            return self.graph.error(format!("memory `{name}` is written twice"), place);
        }
        self.graph.inner.borrow_mut().memories[self.index].write = Some([ids[0], ids[1], ids[2]]);
    }

    /// The word at `address` before the last clock edge: a registered read. A read of the address that is being written
    /// may return anything: the old word in a simulator of the Verilog, and its complement in the evaluator.
    #[track_caller]
    pub fn read(self, address: Signal<'g>) -> Signal<'g> {
        self.read_at(&[address], Location::caller())
    }

    /// As [`MemoryHandle::read`], at the clock edges at which `enable` is set. Otherwise the word is kept.
    #[track_caller]
    pub(crate) fn read_if(self, enable: Signal<'g>, address: Signal<'g>) -> Signal<'g> {
        self.read_at(&[address, enable], Location::caller())
    }

    fn read_at(self, inputs: &[Signal<'g>], place: &'static Location<'static>) -> Signal<'g> {
        let Some(ids) = self.graph.own("memory read", inputs, place) else { return Signal::poison(self.graph) };
        let name = || self.graph.inner.borrow().memories[self.index].name.clone();
        let address = inputs[0].width();
        let message = match inputs.get(1).map(|enable| enable.width()) {
            _ if address != self.address_width => {
                format!("memory `{}`: read address has {address} bits, not {}", name(), self.address_width)
            }
            Some(enable) if enable != 1 => format!("memory `{}`: read enable has {enable} bits, not 1", name()),
            _ => return self.graph.shared(Op::MemoryRead { memory: self.index }, self.width, ids, place),
        };
        self.graph.error(message, place);
        Signal::poison(self.graph)
    }
}

/// The outputs of an instance.
#[derive(Clone, Debug)]
pub struct Instantiated<'g> {
    graph: &'g Graph,
    name: String,
    outputs: Vec<(String, Signal<'g>)>,
}

impl std::fmt::Debug for Graph {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Graph({})", self.inner.borrow().name)
    }
}

impl<'g> Instantiated<'g> {
    /// The output port of that name.
    #[track_caller]
    pub fn output(&self, port: &str) -> Signal<'g> {
        if let Some((_, signal)) = self.outputs.iter().find(|(name, _)| name == port) {
            return *signal;
        }
        self.graph.error(format!("instance `{}` has no output `{port}`", self.name), Location::caller());
        Signal::poison(self.graph)
    }
}

impl Graph {
    /// A register that takes `reset` on reset.
    #[track_caller]
    pub fn register(&self, name: &str, width: u32, reset: u128) -> Register<'_> {
        self.begins(name, width, Start::Reset(reset))
    }

    /// A register for data, which is not reset.
    #[track_caller]
    pub fn data_register(&self, name: &str, width: u32) -> Register<'_> {
        self.begins(name, width, Start::Any)
    }

    /// A register that no reset changes and that holds `value` when the device is configured. Whatever it holds after a
    /// fault, the circuit around it must come right by itself.
    #[track_caller]
    pub fn configured_register(&self, name: &str, width: u32, value: u128) -> Register<'_> {
        self.begins(name, width, Start::Configured(value))
    }

    #[track_caller]
    fn begins(&self, name: &str, width: u32, start: Start) -> Register<'_> {
        let place = Location::caller();
        let value = match start {
            Start::Reset(value) => Some(("reset value", value)),
            Start::Configured(value) => Some(("configured value", value)),
            Start::Any => None,
        };
        if let Some((kind, value)) = value.filter(|(_, value)| width < 128 && value >> width != 0) {
            self.error(format!("register `{name}`: {kind} {value} does not fit {width} bits"), place);
        }
        Register(self.fresh(Op::Register { start, is_copy: false }, width, vec![], place).named(name))
    }

    /// A memory of `depth` ≥ 2 words of `width` bits; its addresses have ⌈log2 depth⌉ bits. It is never reset.
    #[track_caller]
    pub fn memory(&self, name: &str, depth: u32, width: u32) -> MemoryHandle<'_> {
        if depth < 2 || width == 0 || !is_identifier(name) {
            self.error(format!("memory `{name}` of {depth} words of {width} bits"), Location::caller());
        }
        let mut inner = self.inner.borrow_mut();
        inner.memories.push(Memory {
            name: name.to_owned(),
            depth,
            width,
            write: None,
            in_luts: fits_luts(depth, width),
        });
        MemoryHandle { graph: self, index: inner.memories.len() - 1, width, address_width: address_width(depth) }
    }

    /// An instance of `module`. `inputs` names each of its input ports once. Its parameters are this module's of the
    /// same name, if there are any.
    #[track_caller]
    pub fn instance<'g>(&'g self, name: &str, module: &Arc<Module>, inputs: &[(&str, Signal<'g>)]) -> Instantiated<'g> {
        self.refuse_top(name, module, Location::caller());
        self.instantiate(name, module, InstanceCount::One, inputs, Location::caller())
    }

    /// As [`Graph::instance`], for a module that may have its own reset. This is for a wrapper that is synthesised; the
    /// evaluator refuses it.
    #[track_caller]
    pub(crate) fn instance_of_top<'g>(
        &'g self,
        name: &str,
        module: &Arc<Module>,
        inputs: &[(&str, Signal<'g>)],
    ) -> Instantiated<'g> {
        self.instantiate(name, module, InstanceCount::One, inputs, Location::caller())
    }

    fn refuse_top(&self, name: &str, module: &Module, place: &'static Location<'static>) {
        if module.reset.is_some() {
            self.error(format!("instance `{name}`: `{}` has a reset of its own, so it is a top", module.name), place);
        }
    }

    /// A chain of instances of `module`, as many as the [`Graph::parameter`] `count` gives. What an instance has at its
    /// output `NAME_out` goes into the input `NAME_in` of the next. `inputs` are those of the first; the outputs are
    /// those of the last. All instances share the other inputs, and an input named `index` gets each instance's number.
    ///
    /// Every output must have its input, and come from a register.
    #[track_caller]
    pub fn chain<'g>(
        &'g self,
        name: &str,
        module: &Arc<Module>,
        count: Signal<'g>,
        inputs: &[(&str, Signal<'g>)],
    ) -> Instantiated<'g> {
        let place = Location::caller();
        self.refuse_top(name, module, place);
        for (index, port) in module.ports.iter().enumerate().filter(|(_, port)| port.output) {
            let next = super::instance::next_in_chain(module, index).map(|next| &module.ports[next]);
            if next.is_none_or(|next| next.width != port.width) {
                let message =
                    format!("chain `{name}`: output `{}` of `{}` has no input to go into", port.name, module.name);
                self.error(message, place);
            }
            if !module.paths[index].is_empty() {
                let message =
                    format!("chain `{name}`: output `{}` of `{}` is not a register's", port.name, module.name);
                self.error(message, place);
            }
        }
        let parameter = self.own("chain", &[count], place).map(|ids| self.node(ids[0]).op);
        if let Some(Op::Parameter(index)) = parameter {
            return self.instantiate(name, module, InstanceCount::Parameter(index), inputs, place);
        }
        if parameter.is_some() {
            self.error(format!("chain `{name}`: `{}` is not a parameter", count.describe()), place);
        }
        let outputs = module.ports.iter().filter(|port| port.output);
        let outputs = outputs.map(|port| (port.name.clone(), Signal::poison(self))).collect();
        Instantiated { graph: self, name: name.to_owned(), outputs }
    }

    fn instantiate<'g>(
        &'g self,
        name: &str,
        module: &Arc<Module>,
        count: InstanceCount,
        inputs: &[(&str, Signal<'g>)],
        place: &'static Location<'static>,
    ) -> Instantiated<'g> {
        let signals: Vec<_> = inputs.iter().map(|(_, signal)| *signal).collect();
        let ids = self.own("instance", &signals, place);
        let mut connected = vec![None; module.ports.len()];
        for (position, (port_name, signal)) in inputs.iter().enumerate() {
            let found = module.port(port_name).filter(|(_, port)| !port.output);
            let Some((index, port)) = found else {
                self.error(format!("instance `{name}`: `{}` has no input `{port_name}`", module.name), place);
                continue;
            };
            if signal.width() != 0 && signal.width() != port.width {
                let message = format!(
                    "instance `{name}`: input `{port_name}` of `{}` has {} bits, `{}` has {}",
                    module.name,
                    port.width,
                    signal.describe(),
                    signal.width()
                );
                self.error(message, place);
            }
            if connected[index].is_some() {
                self.error(format!("instance `{name}`: input `{port_name}` is connected twice"), place);
            }
            connected[index] = ids.as_ref().map(|ids| ids[position]);
        }
        for (index, port) in module.ports.iter().enumerate() {
            let given = inputs.iter().any(|(given, _)| *given == port.name);
            let implied = count != InstanceCount::One && port.name == "index";
            if !port.output && !given && !implied {
                self.error(format!("instance `{name}`: input `{}` is not connected", port.name), place);
            }
            debug_assert!(index < connected.len());
        }
        if !is_identifier(name) {
            self.error(format!("instance `{name}` is not a Verilog identifier"), place);
        }
        let mut inner = self.inner.borrow_mut();
        let instance = inner.instances.len();
        inner.instances.push(Instance {
            name: name.to_owned(),
            module: module.clone(),
            count,
            inputs: connected,
            reset: None,
        });
        drop(inner);
        let outputs = module.ports.iter().enumerate().filter(|(_, port)| port.output);
        let outputs = outputs.map(|(index, port)| {
            let op = Op::InstanceOutput { instance, port: index };
            let signal = if ids.is_some() { self.fresh(op, port.width, vec![], place) } else { Signal::poison(self) };
            (port.name.clone(), signal)
        });
        Instantiated { graph: self, name: name.to_owned(), outputs: outputs.collect() }
    }
}

/// The number of bits in an address of `depth` words, at least 1.
pub(super) fn address_width(depth: u32) -> u32 {
    depth.saturating_sub(1).checked_ilog2().map_or(1, |log| log + 1)
}
