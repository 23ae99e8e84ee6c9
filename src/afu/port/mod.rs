//! Ports, each declared once: its name, its width and its meaning. Hardware declares and connects its ports by these
//! interfaces, PORTS.md and test benches are written from them, and simulations bind to models by them.
//!
//! An interface is generic in the type of each port: a [`Declaration`], a signal of hardware, or a model's port.

mod job;
mod line;

use std::borrow::Cow;

use crate::hdl::{Graph, Signal};

use super::Spec;
pub(crate) use job::{JobInputs, JobOutputs};
pub(crate) use line::{ReadInputs, ReadOutputs, WriteInputs, WriteOutputs};

/// The declaration of a port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Declaration {
    pub(crate) name: &'static str,
    pub(crate) bits: u32,
    /// The description in PORTS.md.
    pub(crate) meaning: Cow<'static, str>,
}

impl Declaration {
    pub(crate) fn new(name: &'static str, bits: u32, meaning: impl Into<Cow<'static, str>>) -> Self {
        Self { name, bits, meaning: meaning.into() }
    }

    /// The module's input of this name and width.
    pub(super) fn input<'g>(&self, graph: &'g Graph) -> Signal<'g> {
        graph.input(self.name, self.bits)
    }

    /// A wire of this name and width in Verilog, as a line of its own.
    pub(super) fn wire(&self) -> String {
        match self.bits {
            1 => format!("  wire {};\n", self.name),
            bits => format!("  wire [{}:0] {};\n", bits - 1, self.name),
        }
    }
}

/// The connections of an instance in Verilog, each a port's name and its value.
pub(super) fn connections(indent: &str, ports: &[(&str, &str)]) -> String {
    let widest = ports.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let lines: Vec<_> = ports.iter().map(|(name, value)| format!("{indent}.{name:<widest$} ({value})")).collect();
    lines.join(",\n")
}

/// The ports of a module in their order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Ports {
    pub(crate) inputs: Vec<Declaration>,
    pub(crate) outputs: Vec<Declaration>,
}

/// The clock.
pub(super) fn clock() -> Declaration {
    Declaration::new("clk", 1, "clock")
}

/// The reset of a module that does not reset itself.
pub(crate) fn reset(active_low: bool) -> Declaration {
    let (name, meaning) = match active_low {
        false => ("rst", "reset, active high; at least one cycle"),
        true => ("rst_n", "reset, active low; at least one cycle"),
    };
    Declaration::new(name, 1, meaning)
}

/// The ports of the core.
pub(super) fn core(spec: &Spec) -> Ports {
    let inputs =
        JobInputs::of(spec).list().into_iter().chain(ReadInputs::of(spec).list()).chain(WriteInputs::of(spec).list());
    let outputs = JobOutputs::of(spec)
        .list()
        .into_iter()
        .chain(ReadOutputs::of(spec).list())
        .chain(WriteOutputs::of(spec).list());
    Ports {
        inputs: [clock(), reset(spec.reset.active_low)].into_iter().chain(inputs).collect(),
        outputs: outputs.collect(),
    }
}

/// Declares a module's outputs.
pub(super) fn outputs<'g>(graph: &'g Graph, named: Vec<(&'static str, Signal<'g>)>) {
    named.into_iter().for_each(|(name, value)| graph.output(name, value));
}

/// An interface: ports of one direction, in their order, each with its width and its meaning, which may follow from the
/// specification. A port that only some modules have is an `Option`, with its condition behind `if`.
macro_rules! interface {
    ($(#[$about:meta])* $interface:ident($spec:ident) {
        $($port:ident: $type:ty => $bits:expr, $meaning:expr $(, if $condition:expr)?;)*
    }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct $interface<T> {
            $(pub(crate) $port: $type,)*
        }

        impl $interface<$crate::afu::port::Declaration> {
            pub(crate) fn of($spec: &$crate::afu::Spec) -> Self {
                Self {
                    $($port: $crate::afu::port::interface!(
                        @declare $crate::afu::port::Declaration::new(stringify!($port), $bits, $meaning)
                        $(, $condition)?
                    ),)*
                }
            }
        }

        // Not every interface is used in every way.
        #[allow(dead_code)]
        impl<T> $interface<T> {
            /// Applies `f` to each port; fails with its first error.
            pub(crate) fn try_map<U, E>(self, mut f: impl FnMut(T) -> Result<U, E>) -> Result<$interface<U>, E> {
                Ok($interface { $($port: $crate::afu::port::interface!(@map f, self.$port $(, $condition)?),)* })
            }

            /// Applies `f` to each port.
            pub(crate) fn map<U>(self, mut f: impl FnMut(T) -> U) -> $interface<U> {
                match self.try_map(|each| Ok::<_, std::convert::Infallible>(f(each))) {
                    Ok(mapped) => mapped,
                    Err(never) => match never {},
                }
            }

            /// The ports with their names, in order.
            pub(crate) fn named(self) -> Vec<(&'static str, T)> {
                let each = [$((stringify!($port), $crate::afu::port::interface!(@some self.$port $(, $condition)?)),)*];
                each.into_iter().filter_map(|(name, value)| Some((name, value?))).collect()
            }

            /// The ports, in order.
            pub(crate) fn list(self) -> Vec<T> {
                self.named().into_iter().map(|(_, each)| each).collect()
            }
        }
    };
    (@declare $declaration:expr) => { $declaration };
    (@declare $declaration:expr, $condition:expr) => { $condition.then(|| $declaration) };
    (@map $f:ident, $value:expr) => { $f($value)? };
    (@map $f:ident, $value:expr, $condition:expr) => { $value.map(&mut $f).transpose()? };
    (@some $value:expr) => { Some($value) };
    (@some $value:expr, $condition:expr) => { $value };
}
pub(crate) use interface;
