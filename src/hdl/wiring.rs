//! Bits taken out of signals and put side by side: what costs wires and no logic.

use std::panic::Location;

use super::graph::WIDEST;
use super::module::Op;
use super::signal::Signal;

impl Signal<'_> {
    /// The bit with weight 2^index.
    #[track_caller]
    pub fn bit(self, index: u32) -> Self {
        self.slice(index, 1)
    }

    /// The most significant bit.
    #[track_caller]
    pub fn msb(self) -> Self {
        if self.id().is_none() { self } else { self.slice(self.width() - 1, 1) }
    }

    /// `width` bits from bit `low` on.
    #[track_caller]
    pub fn slice(self, low: u32, width: u32) -> Self {
        let place = Location::caller();
        if self.id().is_none() {
            return self;
        }
        if width == 0 || low.checked_add(width).is_none_or(|end| end > self.width()) {
            let message =
                format!("slice: {width} bits from bit {low} of `{}`, which has {}", self.describe(), self.width());
            self.graph().error(message, place);
            return Self::poison(self.graph());
        }
        if let Some(folded) = super::fold::slice(self, low, width) {
            return folded;
        }
        self.unary("slice", Op::Slice { low }, width, place)
    }

    /// The `width` least significant bits.
    #[track_caller]
    pub fn low(self, width: u32) -> Self {
        self.slice(0, width)
    }

    /// The `width` most significant bits.
    #[track_caller]
    pub fn high(self, width: u32) -> Self {
        if self.id().is_none() { self } else { self.slice(self.width().saturating_sub(width), width) }
    }

    /// All bits but the `count` least significant ones (a shift right that narrows).
    #[track_caller]
    pub fn drop_low(self, count: u32) -> Self {
        if self.id().is_none() { self } else { self.slice(count, self.width().saturating_sub(count)) }
    }

    /// This signal above `lower`.
    #[track_caller]
    pub fn concat(self, lower: Self) -> Self {
        Self::join(&[self, lower])
    }

    /// Signals side by side, the first one most significant.
    ///
    /// # Panics
    /// Without any signal: there is no graph in which to record it.
    #[track_caller]
    pub fn join(parts: &[Self]) -> Self {
        let place = Location::caller();
        let graph = parts[0].graph();
        let Some(ids) = graph.own("join", parts, place) else { return Self::poison(graph) };
        if let [only] = parts {
            return *only;
        }
        let width = parts.iter().map(|p| p.width()).fold(0, u32::saturating_add);
        if width <= 128 && parts.iter().all(|p| p.as_constant().is_some()) {
            let value = parts.iter().fold(0, |v, p| v << p.width() | p.as_constant().unwrap_or(0));
            return graph.constant(width, value);
        }
        graph.shared(Op::Concat, width, ids, place)
    }

    /// `count` ≥ 1 copies side by side.
    #[track_caller]
    pub fn repeat(self, count: u32) -> Self {
        if count == 1 || self.id().is_none() {
            return self;
        }
        let copies = || format!("repeat: {count} copies of `{}`, which has {} bits", self.describe(), self.width());
        if count == 0 {
            self.graph().error(copies(), Location::caller());
            return Self::poison(self.graph());
        }
        if count.saturating_mul(self.width()) > WIDEST {
            self.graph().error(format!("{}, are more than {WIDEST} bits", copies()), Location::caller());
            return Self::poison(self.graph());
        }
        Self::join(&vec![self; count as usize])
    }

    /// Zeros above, to `width` bits in all.
    #[track_caller]
    pub fn extend(self, width: u32) -> Self {
        if self.id().is_none() || width == self.width() {
            return self;
        }
        let Some(more) = width.checked_sub(self.width()) else {
            let message = format!("extend: `{}` has {} bits, more than {width}", self.describe(), self.width());
            self.graph().error(message, Location::caller());
            return Self::poison(self.graph());
        };
        self.graph().constant(more, 0).concat(self)
    }

    /// `count` zeros below (a shift left that widens).
    #[track_caller]
    pub fn append_zeros(self, count: u32) -> Self {
        if self.id().is_none() || count == 0 { self } else { self.concat(self.graph().constant(count, 0)) }
    }
}
