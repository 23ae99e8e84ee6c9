//! The graphs to which a delay model is fitted, and those on which it is tested.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, Signal};

/// A small combinational graph of one kind and size.
#[derive(Clone, Copy)]
pub struct Sample {
    /// The kind of operation.
    kind: &'static str,
    /// Bits of its operands.
    width: u32,
    /// Number of levels, if the kind has levels.
    levels: u32,
    build: for<'g> fn(&mut Operands<'g, '_>) -> Signal<'g>,
    /// True for a sample of the fit, false for one of the test.
    pub fitted: bool,
}

/// Hands out a sample's inputs.
struct Operands<'g, 'a> {
    graph: &'g Graph,
    name: &'a str,
    width: u32,
    levels: u32,
    next: u32,
}

impl<'g> Operands<'g, '_> {
    fn of(&mut self, width: u32) -> Signal<'g> {
        self.next += 1;
        self.graph.input(&format!("x{}_{}", self.next, self.name), width)
    }

    fn one(&mut self) -> Signal<'g> {
        self.of(self.width)
    }
}

impl Sample {
    /// The name of the sample, as in `add_24`.
    pub fn name(&self) -> String {
        match self.levels {
            0 => format!("{}_{}", self.kind, self.width),
            levels => format!("{}_{}x{levels}", self.kind, self.width),
        }
    }

    /// The logic of the sample in a graph, with its own inputs.
    fn logic<'g>(&self, graph: &'g Graph) -> Signal<'g> {
        let name = self.name();
        (self.build)(&mut Operands { graph, name: &name, width: self.width, levels: self.levels, next: 0 })
    }

    /// The sample alone, as a combinational module.
    ///
    /// # Errors
    /// Returns an error only if this list is wrong.
    pub fn module(&self) -> Result<Arc<Module>, BuildErrors> {
        let graph = Graph::new(self.name());
        let result = self.logic(&graph);
        graph.output("result", result);
        graph.finish()
    }
}

/// The output port, and the register behind it, of a sample in [`together`].
pub fn port(name: &str) -> String {
    format!("y_{name}")
}

/// Samples side by side in one module, each with a register behind its logic.
///
/// # Errors
/// Returns an error only if this list is wrong.
pub fn together(samples: &[Sample]) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("samples");
    graph.about("small graphs side by side, for fitting a delay model");
    for sample in samples {
        let port = port(&sample.name());
        let result = sample.logic(&graph).delay(1).named(&port);
        graph.output(&port, result);
    }
    graph.finish()
}

/// All samples.
pub fn samples() -> Vec<Sample> {
    let mut all = Vec::new();
    let mut kind = |kind, build, fitted: &[(u32, u32)], tried: &[(u32, u32)]| {
        let one = |fitted| move |&(width, levels): &(u32, u32)| Sample { kind, width, levels, build, fitted };
        all.extend(fitted.iter().map(one(true)));
        all.extend(tried.iter().map(one(false)));
    };
    kind("add", add, &[(8, 0), (16, 0), (24, 0), (32, 0), (48, 0)], &[(12, 0), (20, 0), (28, 0), (40, 0)]);
    kind("less", less, &[(8, 0), (16, 0), (31, 0), (48, 0)], &[(12, 0), (24, 0), (40, 0)]);
    kind("equal", equal, &[(8, 0), (24, 0), (48, 0)], &[(16, 0), (34, 0)]);
    kind("any", any, &[(8, 0), (24, 0), (56, 0)], &[(16, 0), (32, 0)]);
    kind("select", select, &[(12, 0), (48, 0)], &[(24, 0)]);
    kind("shift", shift, &[(28, 2), (28, 3), (28, 5), (56, 3)], &[(24, 4), (32, 5), (50, 2)]);
    kind("gates", gates, &[(16, 3), (16, 8)], &[(16, 5)]);
    kind("times", times, &[(9, 0), (18, 0), (24, 0)], &[(12, 0), (17, 0)]);
    kind("order", order, &[(16, 0), (33, 0)], &[(24, 0)]);
    kind("add_normalise", add_normalise, &[(24, 0)], &[(32, 0)]);
    kind("complement_add", complement_add, &[(27, 0)], &[(20, 0)]);
    kind("add_any", add_any, &[(24, 0)], &[(16, 0)]);
    kind("add_add", add_add, &[(12, 0)], &[(20, 0)]);
    all
}

fn add<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    x.one() + x.one()
}

fn less<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    x.one().less_than(x.one())
}

fn equal<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    x.one().equals(x.one())
}

fn any<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    x.one().any()
}

fn select<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    x.of(1).select(x.one(), x.one())
}

/// A left shifter with one level per power of two.
fn shift<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    let (mut value, distance) = (x.one(), x.of(x.levels));
    for level in 0..x.levels {
        let by = 1 << level;
        let shifted = value.low(x.width - by).append_zeros(by);
        value = distance.bit(level).select(shifted, value);
    }
    value
}

/// A chain of gates of two inputs.
fn gates<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    let mut value = x.one();
    for level in 0..x.levels {
        let other = x.one();
        value = match level % 3 {
            0 => value & other,
            1 => value ^ other,
            _ => value | other,
        };
    }
    value
}

fn times<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    x.one() * x.one()
}

/// The larger of two numbers, as before an addition of magnitudes.
fn order<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    let (a, b) = (x.one(), x.one());
    a.less_than(b).select(b, a)
}

/// A sum, shifted by one place if it carries.
fn add_normalise<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    let (a, b) = (x.one(), x.one());
    let sum = a.extend(x.width + 1) + b.extend(x.width + 1);
    sum.msb().select(sum.drop_low(1), sum.low(x.width))
}

/// A sum or a difference, chosen by one bit that fans out to all bits of an operand.
fn complement_add<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    let (a, b, subtract) = (x.one(), x.one(), x.of(1));
    a.concat(a.graph().constant(1, 1)) + (b ^ subtract.repeat(x.width)).concat(subtract)
}

fn add_any<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    (x.one() + x.one()).any()
}

fn add_add<'g>(x: &mut Operands<'g, '_>) -> Signal<'g> {
    let (a, b) = (x.one(), x.one());
    (a + b) + x.one()
}
