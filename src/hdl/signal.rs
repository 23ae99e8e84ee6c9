//! Copyable handles of nodes, and the operations between them. Values are unsigned bit vectors.

use std::ops::{Add, BitAnd, BitOr, BitXor, Mul, Not, Sub};
use std::panic::Location;

use super::graph::{Graph, is_identifier};
use super::module::{NodeId, Op};

/// A handle of one node of a [`Graph`]. A bad operation is recorded in the graph and returns a poisoned handle.
/// Operations on it return poisoned handles again, without a further error.
#[derive(Clone, Copy)]
pub struct Signal<'g> {
    graph: &'g Graph,
    id: Option<NodeId>,
}

impl std::fmt::Debug for Signal<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.describe())
    }
}

impl<'g> Signal<'g> {
    pub(super) fn new(graph: &'g Graph, id: NodeId) -> Self {
        Self { graph, id: Some(id) }
    }

    pub(super) fn poison(graph: &'g Graph) -> Self {
        Self { graph, id: None }
    }

    pub(super) fn id(self) -> Option<NodeId> {
        self.id
    }

    pub(super) fn id_or_zero(self) -> usize {
        self.id.map_or(0, NodeId::index)
    }

    /// True if both are handles of the same node.
    pub(crate) fn is_same(self, other: Self) -> bool {
        std::ptr::eq(self.graph, other.graph) && self.id == other.id
    }

    /// The graph it belongs to.
    pub fn graph(self) -> &'g Graph {
        self.graph
    }

    /// The width in bits; 0 if it is poisoned.
    pub fn width(self) -> u32 {
        self.id.map_or(0, |id| self.graph.inner.borrow().nodes[id.index()].width)
    }

    /// The name that the value was given.
    pub(crate) fn name(self) -> Option<String> {
        self.graph.node(self.id?).name
    }

    /// The value, if it is a constant.
    pub fn as_constant(self) -> Option<u128> {
        match self.graph.inner.borrow().nodes[self.id?.index()].op {
            Op::Constant(value) => Some(value),
            _ => None,
        }
    }

    /// The name, or the operation, for messages.
    pub(super) fn describe(self) -> String {
        let Some(id) = self.id else { return "poison".to_owned() };
        let node = self.graph.node(id);
        node.name.unwrap_or_else(|| format!("{:?} of {} bits", node.op, node.width))
    }

    /// Names the value in the generated Verilog. The first name given to a value is kept; constants need none.
    #[track_caller]
    #[must_use]
    pub fn named(self, name: &str) -> Self {
        if !is_identifier(name) {
            self.graph.error(format!("`{name}` is not a Verilog identifier"), Location::caller());
            return self;
        }
        if let Some(id) = self.id {
            let node = &mut self.graph.inner.borrow_mut().nodes[id.index()];
            if !matches!(node.op, Op::Constant(_)) {
                node.name.get_or_insert_with(|| name.to_owned());
            }
        }
        self
    }

    /// Drives a [`Graph::wire`].
    #[track_caller]
    pub fn drive(self, value: Signal<'g>) {
        let place = Location::caller();
        let Some(ids) = self.graph.own("drive", &[self, value], place) else { return };
        if self.width() != value.width() {
            return self.graph.error(self.widths("drive", value), place);
        }
        let node = self.graph.node(ids[0]);
        if node.op != Op::Wire {
            self.graph.error(format!("drive: `{}` is not a wire", self.describe()), place);
        } else if !node.operands.is_empty() {
            self.graph.error(format!("drive: `{}` is driven twice", self.describe()), place);
        } else {
            self.graph.inner.borrow_mut().nodes[ids[0].index()].operands.push(ids[1]);
        }
    }

    fn widths(self, what: &str, other: Self) -> String {
        format!("{what}: `{}` has {} bits, `{}` has {}", self.describe(), self.width(), other.describe(), other.width())
    }

    /// An operation of two operands of equal width.
    fn binary(self, other: Self, what: &str, op: Op, width: Option<u32>, place: &'static Location<'static>) -> Self {
        let Some(ids) = self.graph.own(what, &[self, other], place) else { return Self::poison(self.graph) };
        if self.width() != other.width() {
            self.graph.error(self.widths(what, other), place);
            return Self::poison(self.graph);
        }
        if let Some(folded) = super::fold::binary(self, other, &op) {
            return folded;
        }
        self.graph.shared(op, width.unwrap_or(self.width()), ids, place)
    }

    pub(super) fn unary(self, what: &str, op: Op, width: u32, place: &'static Location<'static>) -> Self {
        let Some(ids) = self.graph.own(what, &[self], place) else { return Self::poison(self.graph) };
        self.graph.shared(op, width, ids, place)
    }

    /// A constant as wide as this signal.
    #[track_caller]
    pub fn same(self, value: u128) -> Self {
        if self.id.is_none() {
            return self;
        }
        self.graph.constant(self.width(), value)
    }

    /// One bit: equal to `other`.
    #[track_caller]
    pub fn equals(self, other: Self) -> Self {
        self.binary(other, "equals", Op::Equal, Some(1), Location::caller())
    }

    /// One bit: equal to a constant.
    #[track_caller]
    pub fn is(self, value: u128) -> Self {
        self.equals(self.same(value))
    }

    /// One bit: every bit is clear.
    #[track_caller]
    pub fn is_zero(self) -> Self {
        !self.any()
    }

    /// One bit: less than `other`, unsigned.
    #[track_caller]
    pub fn less_than(self, other: Self) -> Self {
        self.binary(other, "less than", Op::Less, Some(1), Location::caller())
    }

    /// One bit: greater than `other`, unsigned.
    #[track_caller]
    pub fn greater_than(self, other: Self) -> Self {
        other.binary(self, "greater than", Op::Less, Some(1), Location::caller())
    }

    /// One bit: at least `other`, unsigned.
    #[track_caller]
    pub fn at_least(self, other: Self) -> Self {
        !self.less_than(other)
    }

    /// One bit: at most `other`, unsigned.
    #[track_caller]
    pub fn at_most(self, other: Self) -> Self {
        !other.less_than(self)
    }

    /// Sum with a constant, modulo 2^width.
    #[track_caller]
    pub fn plus(self, value: u128) -> Self {
        self.binary(self.same(value), "plus", Op::Add, None, Location::caller())
    }

    /// Difference with a constant, modulo 2^width.
    #[track_caller]
    pub fn minus(self, value: u128) -> Self {
        self.binary(self.same(value), "minus", Op::Sub, None, Location::caller())
    }

    /// The difference to a value of the same width, or the sum if `add` (1 bit) is set; modulo 2^width, on one carry
    /// chain.
    #[track_caller]
    pub(crate) fn minus_or_plus(self, other: Self, add: Self) -> Self {
        let (what, place) = ("minus or plus", Location::caller());
        match add.as_constant() {
            Some(0) => return self.binary(other, what, Op::Sub, None, place),
            Some(_) => return self.binary(other, what, Op::Add, None, place),
            None => {}
        }
        let Some(ids) = self.graph.own(what, &[self, other, add], place) else { return Self::poison(self.graph) };
        if self.width() != other.width() {
            self.graph.error(self.widths(what, other), place);
            return Self::poison(self.graph);
        }
        if add.width() != 1 {
            let message = format!("{what}: `{}` has {} bits, a condition has 1", add.describe(), add.width());
            self.graph.error(message, place);
            return Self::poison(self.graph);
        }
        self.graph.shared(Op::SubAdd, self.width(), ids, place)
    }

    /// One bit: any bit is set.
    #[track_caller]
    pub fn any(self) -> Self {
        if let Some(value) = super::fold::below_zeros(self) {
            return value.any();
        }
        match (self.width(), self.as_constant()) {
            (1, _) => self,
            (_, Some(value)) => self.graph.constant(1, u128::from(value != 0)),
            _ => self.unary("any", Op::Any, 1, Location::caller()),
        }
    }

    /// One bit: every bit is set.
    #[track_caller]
    pub fn all(self) -> Self {
        if self.width() == 1 { self } else { self.unary("all", Op::All, 1, Location::caller()) }
    }

    /// One-hot decoder: of 2^width bits, the bit whose index is this value is set. At most 8 bits wide.
    #[track_caller]
    pub fn one_hot(self) -> Self {
        let width = self.width();
        if width > 8 {
            let message = format!("one hot: `{}` has {width} bits, more than 8", self.describe());
            self.graph.error(message, Location::caller());
            return Self::poison(self.graph);
        }
        if width == 8 {
            // A decoder has up to 128 outputs: two of them, one for each half.
            let (upper, half) = (self.bit(7), self.low(7).one_hot());
            return half.gate(upper).concat(half.gate(!upper));
        }
        self.unary("one hot", Op::OneHot, 1 << width, Location::caller())
    }

    /// `yes` if this bit is set, otherwise `no`.
    #[track_caller]
    pub fn select(self, yes: Self, no: Self) -> Self {
        let place = Location::caller();
        let Some(ids) = self.graph.own("select", &[self, yes, no], place) else { return Self::poison(self.graph) };
        if self.width() != 1 {
            let message = format!("select: the condition `{}` has {} bits, not 1", self.describe(), self.width());
            self.graph.error(message, place);
            return Self::poison(self.graph);
        }
        if yes.width() != no.width() {
            self.graph.error(yes.widths("select", no), place);
            return Self::poison(self.graph);
        }
        match self.as_constant() {
            Some(0) => return no,
            Some(_) => return yes,
            None if yes.id == no.id => return yes,
            None => {}
        }
        match (yes.width(), yes.as_constant(), no.as_constant()) {
            (1, Some(1), Some(0)) => return self,
            (1, Some(0), Some(1)) => return !self,
            _ => {}
        }
        self.graph.shared(Op::Mux, yes.width(), ids, place)
    }

    /// This value if `condition` (1 bit) is set, otherwise zero.
    #[track_caller]
    pub fn gate(self, condition: Self) -> Self {
        if self.id.is_none() { self } else { self & condition.repeat(self.width()) }
    }

    /// The value `cycles` clock cycles ago: registers for a few, a memory with a pointer for many. Never reset.
    #[track_caller]
    pub fn delay(self, cycles: u32) -> Self {
        if cycles == 0 || self.as_constant().is_some() {
            return self;
        }
        self.unary("delay", Op::Delay { cycles }, self.width(), Location::caller())
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $op:ident, $what:literal) => {
        impl<'g> $trait for Signal<'g> {
            type Output = Signal<'g>;

            #[track_caller]
            fn $method(self, other: Self) -> Self {
                self.binary(other, $what, Op::$op, None, Location::caller())
            }
        }
    };
}

operator!(BitAnd, bitand, And, "and");
operator!(BitOr, bitor, Or, "or");
operator!(BitXor, bitxor, Xor, "exclusive or");
operator!(Add, add, Add, "sum");
operator!(Sub, sub, Sub, "difference");

impl<'g> Not for Signal<'g> {
    type Output = Signal<'g>;

    #[track_caller]
    fn not(self) -> Self {
        if let Some(folded) = super::fold::not(self) {
            return folded;
        }
        self.unary("not", Op::Not, self.width(), Location::caller())
    }
}

impl<'g> Mul for Signal<'g> {
    type Output = Signal<'g>;

    /// The full unsigned product, as wide as both operands together.
    #[track_caller]
    fn mul(self, other: Self) -> Self {
        let place = Location::caller();
        let Some(ids) = self.graph.own("product", &[self, other], place) else { return Self::poison(self.graph) };
        let width = [self, other].iter().map(|factor| factor.width()).sum();
        self.graph.shared(Op::Mul, width, ids, place)
    }
}
