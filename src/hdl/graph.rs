//! A module under construction.

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::panic::Location;
use std::sync::Arc;

use super::error::{BuildErrors, Error};
use super::instance::Instance;
use super::module::{Memory, Module, Node, NodeId, Op, Parameter, Port, Rounded};
use super::signal::Signal;

pub(super) struct Inner {
    pub name: String,
    pub about: Vec<String>,
    pub nodes: Vec<Node>,
    pub places: Vec<&'static Location<'static>>,
    pub known: HashMap<(Op, u32, Vec<NodeId>), NodeId>,
    pub ports: Vec<Port>,
    pub parameters: Vec<Parameter>,
    pub memories: Vec<Memory>,
    pub instances: Vec<Instance>,
    pub reset: Option<NodeId>,
    pub clock: Option<&'static str>,
    pub errors: Vec<Error>,
}

/// The maximum width of a value in bits: far beyond any line, but small enough that a typo does not fill the memory.
pub(super) const WIDEST: u32 = 1 << 16;

/// A module under construction. Hand out [`Signal`]s by [`Graph::input`] and the like, combine them, declare
/// outputs, and [`Graph::finish`].
pub struct Graph {
    pub(super) inner: RefCell<Inner>,
}

impl Graph {
    /// An empty module.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            inner: RefCell::new(Inner {
                name: name.into(),
                about: Vec::new(),
                nodes: Vec::new(),
                places: Vec::new(),
                known: HashMap::new(),
                ports: Vec::new(),
                parameters: Vec::new(),
                memories: Vec::new(),
                instances: Vec::new(),
                reset: None,
                clock: None,
                errors: Vec::new(),
            }),
        }
    }

    /// Adds a line to the description in the module's header.
    pub fn about(&self, line: impl Into<String>) {
        self.inner.borrow_mut().about.push(line.into());
    }

    /// An input port of `width` bits.
    #[track_caller]
    pub fn input(&self, name: &str, width: u32) -> Signal<'_> {
        let place = Location::caller();
        if !self.check_port(name, width, place) {
            return Signal::poison(self);
        }
        let signal = self.fresh(Op::Input, width, vec![], place);
        let mut inner = self.inner.borrow_mut();
        inner.nodes[signal.id_or_zero()].name = Some(name.to_owned());
        inner.ports.push(Port { name: name.to_owned(), width, output: false, node: signal.id() });
        drop(inner);
        signal
    }

    /// An output port driven by `value`.
    #[track_caller]
    pub fn output(&self, name: &str, value: Signal<'_>) {
        let place = Location::caller();
        let Some(ids) = self.own("output", &[value], place) else { return };
        let width = value.width();
        if self.check_port(name, width, place) {
            self.inner.borrow_mut().ports.push(Port { name: name.to_owned(), width, output: true, node: Some(ids[0]) });
        }
    }

    /// A constant of `width` bits.
    #[track_caller]
    pub fn constant(&self, width: u32, value: u128) -> Signal<'_> {
        let place = Location::caller();
        if width == 0 || (width < 128 && value >> width != 0) {
            self.error(format!("constant {value} does not fit {width} bits"), place);
            return Signal::poison(self);
        }
        self.shared(Op::Constant(value), width, vec![], place)
    }

    /// An integer parameter of the module (a Verilog `parameter`), read as a value of `width` bits.
    #[track_caller]
    pub fn parameter(&self, name: &str, default: u32, range: std::ops::RangeInclusive<u32>, width: u32) -> Signal<'_> {
        let place = Location::caller();
        let (min, max) = (*range.start(), *range.end());
        if !self.is_new_parameter(name, place) {
            return Signal::poison(self);
        }
        if !range.contains(&default) || width == 0 || width < 32 && max >> width != 0 {
            self.error(
                format!("parameter `{name}`: default {default} or its width {width} is outside {min}..={max}"),
                place,
            );
            return Signal::poison(self);
        }
        self.push_parameter(Parameter { name: name.to_owned(), default, min, max, rounded: None }, width, place)
    }

    /// A Verilog `localparam`: the value of the [`Graph::parameter`] `of` up to `multiple`, and above that the largest
    /// multiple of it that is not more. It is a value of as many bits as `of`.
    #[track_caller]
    pub fn rounded_down<'g>(&'g self, name: &str, of: Signal<'g>, multiple: u32) -> Signal<'g> {
        let place = Location::caller();
        let Some(ids) = self.own("rounded down", &[of], place) else { return Signal::poison(self) };
        let Op::Parameter(index) = self.node(ids[0]).op else {
            self.error(format!("rounded down `{name}`: `{}` is not a parameter", of.describe()), place);
            return Signal::poison(self);
        };
        let parameter = self.inner.borrow().parameters[index].clone();
        if multiple == 0 || !self.is_new_parameter(name, place) {
            self.error(format!("rounded down `{name}`: to a multiple of {multiple}"), place);
            return Signal::poison(self);
        }
        let rounded = Rounded { of: index, multiple };
        let [default, min, max] = [parameter.default, parameter.min, parameter.max].map(|value| rounded.of(value));
        let local = Parameter { name: name.to_owned(), default, min, max, rounded: Some(rounded) };
        self.push_parameter(local, of.width(), place)
    }

    fn is_new_parameter(&self, name: &str, place: &'static Location<'static>) -> bool {
        if !is_identifier(name) {
            self.error(format!("parameter `{name}` is not a Verilog identifier"), place);
            return false;
        }
        if self.inner.borrow().parameters.iter().any(|parameter| parameter.name == name) {
            self.error(format!("parameter `{name}` is declared twice"), place);
            return false;
        }
        true
    }

    fn push_parameter(&self, parameter: Parameter, width: u32, place: &'static Location<'static>) -> Signal<'_> {
        let mut inner = self.inner.borrow_mut();
        inner.parameters.push(parameter);
        let index = inner.parameters.len() - 1;
        drop(inner);
        self.shared(Op::Parameter(index), width, vec![], place)
    }

    /// A signal that is driven later by [`Signal::drive`].
    #[track_caller]
    pub fn wire(&self, name: &str, width: u32) -> Signal<'_> {
        self.fresh(Op::Wire, width, vec![], Location::caller()).named(name)
    }

    /// The module is reset, with all below it, a cycle after `active` (1 bit, high in reset), and has no reset port of
    /// its own: for the top of a platform that has its own reset signals. A register stands between, and one of its own
    /// for each instance. Nothing may instantiate such a module.
    #[track_caller]
    pub fn reset_by(&self, active: Signal<'_>) {
        let place = Location::caller();
        let Some(ids) = self.own("reset by", &[active], place) else { return };
        if active.width() != 1 {
            return self.error(format!("reset by: `{}` has {} bits, not 1", active.describe(), active.width()), place);
        }
        if self.inner.borrow_mut().reset.replace(ids[0]).is_some() {
            self.error("reset by: the module's reset is given twice".to_owned(), place);
        }
    }

    /// Gives the clock port of this module another name than `clk`: for the top of a platform that has its own.
    pub fn clocked_by(&self, name: &'static str) {
        self.inner.borrow_mut().clock = Some(name);
    }

    /// Checks all that was recorded, drops what no output needs and puts the rest in order.
    ///
    /// # Errors
    /// Every error recorded by an operation, wires never driven, and combinational loops, together.
    pub fn finish(self) -> Result<Arc<Module>, BuildErrors> {
        let inner = self.inner.into_inner();
        super::finish::finish(inner).map(Arc::new)
    }

    fn check_port(&self, name: &str, width: u32, place: &'static Location<'static>) -> bool {
        if width == 0 {
            self.error(format!("port `{name}` has no bits"), place);
            return false;
        }
        if width > WIDEST {
            self.error(format!("port `{name}` has {width} bits, more than {WIDEST}"), place);
            return false;
        }
        if !is_identifier(name) {
            self.error(format!("port `{name}` is not a Verilog identifier"), place);
            return false;
        }
        if self.inner.borrow().ports.iter().any(|p| p.name == name) {
            self.error(format!("port `{name}` is declared twice"), place);
            return false;
        }
        true
    }

    pub(super) fn error(&self, message: String, place: &'static Location<'static>) {
        let mut inner = self.inner.borrow_mut();
        let module = inner.name.clone();
        inner.errors.push(Error { module, message, place });
    }

    /// The ids of `signals` if all are valid and belong to this graph; otherwise records an error.
    pub(super) fn own(
        &self,
        what: &str,
        signals: &[Signal<'_>],
        place: &'static Location<'static>,
    ) -> Option<Vec<NodeId>> {
        let mut ids = Vec::with_capacity(signals.len());
        for signal in signals {
            if !std::ptr::eq(self, signal.graph()) {
                let message = format!(
                    "{what}: `{}` is a signal of another graph, `{}`",
                    signal.describe(),
                    signal.graph().inner.borrow().name
                );
                self.error(message, place);
                return None;
            }
            ids.push(signal.id()?);
        }
        Some(ids)
    }

    /// A new node, never shared with an equal one.
    pub(super) fn fresh(
        &self,
        op: Op,
        width: u32,
        operands: Vec<NodeId>,
        place: &'static Location<'static>,
    ) -> Signal<'_> {
        if width == 0 {
            self.error(format!("{op:?} would have no bits"), place);
            return Signal::poison(self);
        }
        if width > WIDEST {
            self.error(format!("{op:?} would have {width} bits, more than {WIDEST}"), place);
            return Signal::poison(self);
        }
        let mut inner = self.inner.borrow_mut();
        let id = NodeId(inner.nodes.len() as u32);
        inner.nodes.push(Node { op, width, operands, name: None, stage: None });
        inner.places.push(place);
        drop(inner);
        Signal::new(self, id)
    }

    /// The node that computes this: an equal one if there is one already.
    pub(super) fn shared(
        &self,
        op: Op,
        width: u32,
        operands: Vec<NodeId>,
        place: &'static Location<'static>,
    ) -> Signal<'_> {
        let key = (op, width, operands);
        if let Some(&id) = self.inner.borrow().known.get(&key) {
            return Signal::new(self, id);
        }
        let signal = self.fresh(key.0.clone(), width, key.2.clone(), place);
        if let Some(id) = signal.id() {
            self.inner.borrow_mut().known.insert(key, id);
        }
        signal
    }

    pub(super) fn node(&self, id: NodeId) -> Node {
        self.inner.borrow().nodes[id.index()].clone()
    }
}

/// True if `name` is a valid identifier in Verilog.
pub(super) fn is_identifier(name: &str) -> bool {
    let mut bytes = name.bytes();
    bytes.next().is_some_and(|b| b.is_ascii_alphabetic() || b == b'_')
        && bytes.all(|b| b.is_ascii_alphanumeric() || b == b'_')
        && !super::keywords::keywords().any(|word| word == name)
}

/// Output-to-input paths without a register, for each port.
pub(super) type Paths = Vec<BTreeSet<usize>>;
