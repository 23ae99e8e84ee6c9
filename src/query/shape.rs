//! The data of a query.

use super::Flow;

/// The rule for a word of a pair. A pair that breaks a rule is invalid; the hardware checks the raw words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Neither an infinity nor a NaN.
    Finite,
    /// Finite and not below zero (−0 is valid).
    NotNegative,
    /// Finite, and a component of a vector of length 1. The caller promises the length; it is not checked.
    UnitLength,
}

impl Rule {
    const SIGN: u32 = 0x8000_0000;
    const INFINITY: u32 = 0x7F80_0000;

    /// True if a binary32 word keeps this rule.
    pub const fn holds(self, word: u32) -> bool {
        Self::holds_below(word, self.largest())
    }

    /// The largest finite word that keeps this rule.
    pub(super) const fn largest(self) -> u32 {
        if matches!(self, Self::NotNegative) { Self::SIGN } else { u32::MAX }
    }

    /// True if a word keeps the rule with this largest word.
    #[inline(always)]
    pub(super) const fn holds_below(word: u32, largest: u32) -> bool {
        (word & Self::INFINITY != Self::INFINITY) & (word <= largest)
    }
}

/// A word of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input {
    /// The name in files, messages and hardware.
    pub name: &'static str,
    /// The meaning, for documentation.
    pub meaning: &'static str,
    /// The rule that a valid pair keeps.
    pub rule: Rule,
    /// True for a sphere's radius, which `--radius` makes a constant of the hardware.
    pub is_radius: bool,
}

impl Input {
    pub(crate) const fn new(name: &'static str, meaning: &'static str, rule: Rule) -> Self {
        Self { name, meaning, rule, is_radius: false }
    }

    pub(super) const fn radius(name: &'static str, meaning: &'static str) -> Self {
        Self { name, meaning, rule: Rule::NotNegative, is_radius: true }
    }
}

/// A query as data: everything that hardware, files, checks and documentation need to know about it.
#[derive(Debug)]
pub struct Shape {
    /// The name in options, files and reports.
    pub name: &'static str,
    /// The code in the capability word.
    pub code: u32,
    /// The Verilog module of its kernel.
    pub kernel: &'static str,
    /// The two bodies in the plural: "two spheres".
    pub bodies: &'static str,
    /// The words of a pair, in the order of its record.
    pub inputs: &'static [Input],
    /// The outcomes of a valid pair.
    pub flows: &'static [Flow],
    /// The computation in the notation of [`Shape::inputs`]: a paragraph of PORTS.md.
    pub computes: &'static str,
    /// Pairs of every flow, and invalid ones, for the generated test bench.
    pub examples: &'static [&'static [f32]],
}

impl Shape {
    /// The names of a pair's words, in order: the header of its files.
    pub fn names(&self) -> impl Iterator<Item = &'static str> + Clone {
        self.inputs.iter().map(|input| input.name)
    }
}
