//! Runs a module cycle by cycle in Rust: two-state, one clock, no simulator needed.
//!
//! The hierarchy is flattened, every value is split into 64-bit words, and their computation becomes one tape of steps
//! ([`tape`]). The tape runs from beginning to end whenever something has changed.

mod flatten;
mod lower;
mod schedule;
mod state;
mod tape;

use std::sync::Arc;

use flatten::{Flat, Scope};
use lower::{DEAD, Lowered, word_bits, word_count};

use super::module::{Module, Parameter};

/// Why a module cannot be run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EvaluateError {
    /// A value depends on itself without a register in between.
    #[error("combinational loop through `{}`: a register must stand between", .0.join("`, `"))]
    Loop(Vec<String>),
    /// The module has no such parameter.
    #[error("module `{module}` has no parameter `{name}`")]
    UnknownParameter {
        /// The module.
        module: String,
        /// The name asked for.
        name: String,
    },
    /// A parameter value outside its range.
    #[error("parameter `{name}` = {value} is outside {min}..={max}")]
    ParameterRange {
        /// The parameter.
        name: String,
        /// The value asked for.
        value: u32,
        /// Smallest allowed value.
        min: u32,
        /// Largest allowed value.
        max: u32,
    },
    /// The memories are too large.
    #[error("memories and delays hold {0} words of 64 bits, more than this evaluator takes")]
    TooLarge(u64),
}

/// The places of the words of a port or an internal value. Only valid for the evaluator that returned it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pin {
    first: u32,
    width: u32,
    input: bool,
    /// It changes at clock edges or from outside only, so reading it needs no settling.
    stable: bool,
}

impl Pin {
    /// The width in bits.
    pub fn width(self) -> u32 {
        self.width
    }
}

/// A module that is being run. It starts as after a reset, with memories and delays all zero.
#[derive(Debug)]
pub struct Evaluator {
    module: Arc<Module>,
    scopes: Vec<Scope>,
    tape: tape::Tape,
    state: state::State,
    /// Every word's value: constants, pins, state, results.
    words: Vec<u64>,
    first_state: usize,
    /// Places of the words of nodes.
    places: Vec<u32>,
    /// By flat node: where its words' places stand in `places`.
    nodes: Vec<u32>,
    ports: Vec<Pin>,
    /// The reset input of a module that resets itself.
    reset: Option<Pin>,
    settled: bool,
}

impl Evaluator {
    /// Prepares `module` to be run with these parameters, and with the defaults of the others.
    ///
    /// # Errors
    /// Returns an error for an unknown parameter or one out of range, a combinational loop through several modules
    /// (those within one are found by [`Graph::finish`](super::Graph::finish)), or memories that are too large.
    pub fn new(module: &Arc<Module>, parameters: &[(&str, u32)]) -> Result<Self, EvaluateError> {
        let flat = Flat::new(module, parameter_values(module, parameters)?);
        let outputs = module.ports.iter().filter(|port| port.output);
        let roots = outputs.filter_map(|port| port.node).chain(module.reset);
        let order = flat.order(roots.map(|node| node.index()))?;
        let lowered = Lowered::new(&flat, &order);
        let elements = state::Elements::new(&flat, &lowered)?;
        let layout = schedule::schedule(&lowered, &elements.words(&flat, &lowered));
        let state = elements.place(&flat, &lowered, &layout.place);
        let places: Vec<u32> = lowered.words.iter().map(|&word| layout.place[word as usize]).collect();
        let results = layout.tape.first;
        let ports = module.ports.iter().zip(&lowered.pins).map(|(port, &pin)| {
            let node = port.node.filter(|_| port.output);
            let first = node.map_or(pin, |node| lowered.first[node.index()]);
            pin_at(&places, first, port.width, !port.output, results)
        });
        let own_reset = module.reset.map(|node| pin_at(&places, lowered.first[node.index()], 1, false, results));
        let mut evaluator = Self {
            module: module.clone(),
            reset: own_reset,
            tape: layout.tape,
            state,
            words: layout.words,
            first_state: layout.state,
            ports: ports.collect(),
            places,
            nodes: lowered.first,
            scopes: flat.scopes,
            settled: false,
        };
        evaluator.state.configure(&mut evaluator.words);
        evaluator.reset();
        Ok(evaluator)
    }

    /// The port of that name, for access without a look-up.
    pub fn pin(&self, port: &str) -> Option<Pin> {
        self.module.port(port).map(|(index, _)| self.ports[index])
    }

    /// A named value inside, as `instance.name` or, in a chain, `instance[2].name`. It is read like an output. `None`
    /// if there is no such name or nothing uses the value.
    pub fn probe(&self, path: &str) -> Option<Pin> {
        let (scope, name) = path.rfind('.').map_or(("", path), |dot| path.split_at(dot + 1));
        let scope = self.scopes.iter().find(|s| s.path == scope)?;
        let (index, node) = scope.module.nodes.iter().enumerate().find(|(_, n)| n.name.as_deref() == Some(name))?;
        let first = self.nodes[scope.base + index];
        (first != DEAD).then(|| pin_at(&self.places, first, node.width, false, self.tape.first))
    }

    /// Every path that [`Evaluator::probe`] finds, with its width.
    pub fn probes(&self) -> impl Iterator<Item = (String, u32)> + '_ {
        self.scopes.iter().flat_map(|scope| {
            let live = |index: &usize| self.nodes[scope.base + index] != DEAD;
            let nodes = scope.module.nodes.iter().enumerate().filter(move |(index, _)| live(index));
            nodes.filter_map(|(_, node)| Some((format!("{}{}", scope.path, node.name.as_ref()?), node.width)))
        })
    }

    /// Sets an input port; bits above its width are dropped, as by an assignment in Verilog.
    ///
    /// # Panics
    /// Panics if the module has no such input.
    #[track_caller]
    pub fn set(&mut self, port: &str, value: u128) {
        self.set_words(port, &[value as u64, (value >> 64) as u64]);
    }

    /// Sets an input port, least significant word first; missing words are zero.
    ///
    /// # Panics
    /// Panics if the module has no such input.
    #[track_caller]
    pub fn set_words(&mut self, port: &str, words: &[u64]) {
        let Some(pin) = self.pin(port).filter(|pin| pin.input) else {
            panic!("module `{}` has no input `{port}`", self.module.name)
        };
        self.write_words(pin, words);
    }

    /// The low 128 bits of a port.
    ///
    /// # Panics
    /// Panics if the module has no such port.
    #[track_caller]
    pub fn get(&mut self, port: &str) -> u128 {
        let words = self.get_words(port);
        words.iter().take(2).rev().fold(0, |value, &word| value << 64 | u128::from(word))
    }

    /// A port, least significant word first.
    ///
    /// # Panics
    /// Panics if the module has no such port.
    #[track_caller]
    pub fn get_words(&mut self, port: &str) -> Vec<u64> {
        let Some(pin) = self.pin(port) else { panic!("module `{}` has no port `{port}`", self.module.name) };
        let mut words = vec![0; word_count(pin.width)];
        self.read_words(pin, &mut words);
        words
    }

    /// Sets an input of at most 64 bits (or the low word of a wider one). Has no effect if it is not an input.
    #[inline]
    pub fn write(&mut self, pin: Pin, value: u64) {
        if pin.input {
            let place = self.places[pin.first as usize] as usize;
            self.words[place] = value & tape::mask(pin.width.min(64));
            self.settled = false;
        }
    }

    /// Sets an input, least significant word first; missing words are zero. Has no effect if it is not an input.
    pub fn write_words(&mut self, pin: Pin, words: &[u64]) {
        if !pin.input {
            return;
        }
        for index in 0..word_count(pin.width) {
            let place = self.places[pin.first as usize + index] as usize;
            let word = words.get(index).copied().unwrap_or(0);
            self.words[place] = word & tape::mask(word_bits(pin.width, index));
        }
        self.settled = false;
    }

    /// A value of at most 64 bits (or the low word of a wider one).
    #[inline]
    pub fn read(&mut self, pin: Pin) -> u64 {
        if !pin.stable {
            self.settle();
        }
        self.words[self.places[pin.first as usize] as usize]
    }

    /// A value, least significant word first, as many words as `words` holds. Words beyond the value become zero.
    pub fn read_words(&mut self, pin: Pin, words: &mut [u64]) {
        if !pin.stable {
            self.settle();
        }
        let count = word_count(pin.width).min(words.len());
        let (given, beyond) = words.split_at_mut(count);
        for (word, &place) in given.iter_mut().zip(&self.places[pin.first as usize..]) {
            *word = self.words[place as usize];
        }
        beyond.fill(0);
    }

    /// Brings every value up to date with inputs and state. Reading and [`Evaluator::step`] do it where needed.
    pub fn settle(&mut self) {
        if !self.settled {
            self.tape.run(&mut self.words);
            self.settled = true;
        }
    }

    /// One clock edge: registers, delays and memories sample their present inputs, then change together.
    pub fn step(&mut self) {
        self.settle();
        let resets = self.reset.is_some_and(|pin| self.words[self.places[pin.first as usize] as usize] != 0);
        self.state.clock(&mut self.words, self.first_state);
        if resets {
            self.state.reset(&mut self.words);
        }
        self.settled = false;
    }

    /// Sets every register with a reset value to that value. Other registers, delays and memories keep their content.
    pub fn reset(&mut self) {
        self.state.reset(&mut self.words);
        self.settled = false;
    }

    /// The number of one-word steps to settle: the cost of a cycle.
    pub fn steps(&self) -> usize {
        self.tape.steps.len()
    }
}

fn parameter_values(module: &Module, given: &[(&str, u32)]) -> Result<Vec<u32>, EvaluateError> {
    let mut values: Vec<u32> = module.parameters.iter().map(|parameter| parameter.default).collect();
    for &(name, value) in given {
        let is_it = |parameter: &Parameter| parameter.name == name && parameter.rounded.is_none();
        let Some(index) = module.parameters.iter().position(is_it) else {
            return Err(EvaluateError::UnknownParameter { module: module.name.clone(), name: name.to_owned() });
        };
        let (min, max) = (module.parameters[index].min, module.parameters[index].max);
        if !(min..=max).contains(&value) {
            return Err(EvaluateError::ParameterRange { name: name.to_owned(), value, min, max });
        }
        values[index] = value;
    }
    round_parameters(module, &mut values);
    Ok(values)
}

/// Computes the values of `localparam`s, each from a parameter before it.
fn round_parameters(module: &Module, values: &mut [u32]) {
    for (index, parameter) in module.parameters.iter().enumerate() {
        if let Some(rounded) = parameter.rounded {
            values[index] = rounded.of(values[rounded.of]);
        }
    }
}

fn pin_at(places: &[u32], first: u32, width: u32, input: bool, tape_first: usize) -> Pin {
    let words = &places[first as usize..first as usize + word_count(width)];
    let stable = words.iter().all(|&place| (place as usize) < tape_first);
    Pin { first, width, input, stable }
}
