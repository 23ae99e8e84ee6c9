//! Random modules, built twice: as a graph, and as a list that is evaluated bit by bit in the simplest way.

use contact_afu::hdl::{Graph, Module, Register, Signal};
use proptest::prelude::*;
use std::sync::Arc;

/// Bits, least significant first.
pub type Bits = Vec<bool>;

pub fn to_words(bits: &Bits) -> Vec<u64> {
    bits.chunks(64).map(|chunk| chunk.iter().rev().fold(0, |word, &bit| word << 1 | u64::from(bit))).collect()
}

fn number(width: u32, value: u128) -> Bits {
    (0..width).map(|index| index < 128 && value >> index & 1 == 1).collect()
}

fn small(bits: &Bits) -> usize {
    bits.iter().rev().take(32).fold(0, |value, &bit| value << 1 | usize::from(bit))
}

fn resized(bits: &Bits, width: usize) -> Bits {
    (0..width).map(|index| bits.get(index).copied().unwrap_or(false)).collect()
}

fn add(a: &Bits, b: &Bits, mut carry: bool) -> Bits {
    let mut sum = Bits::new();
    for (&a, &b) in a.iter().zip(b) {
        sum.push(a ^ b ^ carry);
        carry = a & b | carry & (a | b);
    }
    sum
}

fn complement(a: &Bits) -> Bits {
    a.iter().map(|bit| !bit).collect()
}

fn below(a: &Bits, b: &Bits) -> bool {
    a.iter().rev().cmp(b.iter().rev()).is_lt()
}

/// One line of a recipe: the operation, the earlier lines that it uses, and its parameters.
#[derive(Clone, Debug)]
pub struct Line {
    pub what: What,
    pub from: [u16; 3],
    pub numbers: [u32; 2],
    pub is_output: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum What {
    Input,
    Constant,
    Not,
    And,
    Or,
    Xor,
    Add,
    Sub,
    Mul,
    Equal,
    Less,
    Select,
    Concat,
    Slice,
    Any,
    All,
    Repeat,
    OneHot,
    Delay,
    Register,
    RegisterEnabled,
    Memory,
}

const COMBINATIONAL: &[What] = {
    use What::*;
    &[Input, Constant, Not, And, Or, Xor, Add, Sub, Mul, Equal, Less, Select, Concat, Slice, Any, All, Repeat, OneHot]
};
const CLOCKED: &[What] = &[What::Delay, What::Delay, What::Delay, What::Register, What::RegisterEnabled, What::Memory];

/// Lines of a recipe. If `clocked` is false, there are no registers, memories or delays.
pub fn lines(clocked: bool) -> impl Strategy<Value = Vec<Line>> {
    let mut whats = COMBINATIONAL.to_vec();
    if clocked {
        whats.extend(CLOCKED);
    }
    let line = (prop::sample::select(whats), any::<[u16; 3]>(), any::<[u32; 2]>(), prop::bool::weighted(0.2));
    let line = line.prop_map(|(what, from, numbers, is_output)| Line { what, from, numbers, is_output });
    prop::collection::vec(line, 1..60)
}

/// A line with its choices resolved: the lines it uses, and its width.
#[derive(Clone, Debug)]
struct Step {
    what: What,
    from: [usize; 3],
    numbers: [u32; 2],
    width: u32,
}

/// The description of a module, with the state of its bit-by-bit evaluation.
pub struct Recipe {
    steps: Vec<Step>,
    pub outputs: Vec<usize>,
    /// The lines' values in this cycle.
    values: Vec<Bits>,
    /// State by step: a register's value, a memory read's word, or a delay's previous inputs (the newest last).
    held: Vec<Vec<Bits>>,
    memories: Vec<Vec<Bits>>,
}

/// The maximum width, so that products of products stay small.
const WIDEST: u32 = 200;
const MEMORY_DEPTH: u32 = 5;

fn width_of(number: u32) -> u32 {
    // Widths are often near a multiple of 64 bits.
    match number % 4 {
        0 => 1 + number / 4 % 8,
        1 => 60 + number / 4 % 10,
        2 => 124 + number / 4 % 10,
        _ => 1 + number / 4 % 80,
    }
}

impl Recipe {
    pub fn new(lines: &[Line]) -> Self {
        let mut steps: Vec<Step> = Vec::new();
        for (index, line) in lines.iter().enumerate() {
            // The first line has no earlier line to use.
            let what = if index == 0 { What::Input } else { line.what };
            let mut from = line.from.map(|from| usize::from(from) % index.max(1));
            if matches!(what, What::Register | What::RegisterEnabled) {
                // A register may depend on its own output.
                from[0] = usize::from(line.from[0]) % lines.len();
                from[1] = usize::from(line.from[1]) % lines.len();
            }
            let width = |from: usize| steps.get(from).map_or(1, |step: &Step| step.width);
            let mut numbers = line.numbers;
            let width = match what {
                What::Input | What::Constant | What::Register | What::RegisterEnabled => width_of(numbers[0]),
                What::Memory => 1 + numbers[0] % 100,
                What::Not | What::And | What::Or | What::Xor | What::Add | What::Sub => width(from[0]),
                What::Mul => width(from[0]) + width(from[1]),
                What::Equal | What::Less | What::Any | What::All => 1,
                What::Select => width(from[1]),
                What::Concat => width(from[0]) + width(from[1]) + width(from[2]),
                What::Slice => {
                    numbers[0] %= width(from[0]);
                    1 + numbers[1] % (width(from[0]) - numbers[0])
                }
                What::Repeat => {
                    numbers[0] = 1 + numbers[0] % 5;
                    width(from[0]) * numbers[0]
                }
                What::OneHot => {
                    numbers[0] = 1 + numbers[0] % 7.min(width(from[0]));
                    1 << numbers[0]
                }
                What::Delay => {
                    numbers[0] = 1 + numbers[0] % 9;
                    width(from[0])
                }
            };
            let (what, width) = if width > WIDEST { (What::Any, 1) } else { (what, width) };
            steps.push(Step { what, from, numbers, width });
        }
        let mut outputs: Vec<usize> = (0..lines.len()).filter(|index| lines[*index].is_output).collect();
        if outputs.is_empty() {
            outputs.push(lines.len() - 1);
        }
        let held = steps.iter().map(|step| match step.what {
            What::Register | What::RegisterEnabled => vec![number(step.width, reset_value(step))],
            What::Delay => vec![number(step.width, 0); step.numbers[0] as usize],
            _ => vec![number(step.width, 0)],
        });
        let held = held.collect();
        let memories = steps.iter().map(|step| vec![number(step.width, 0); MEMORY_DEPTH as usize]).collect();
        Self { values: vec![Bits::new(); steps.len()], steps, outputs, held, memories }
    }

    /// Input ports: the line and the width of each.
    pub fn inputs(&self) -> Vec<(usize, u32)> {
        let inputs = self.steps.iter().enumerate().filter(|(_, step)| step.what == What::Input);
        inputs.map(|(index, step)| (index, step.width)).collect()
    }

    /// Builds the graph. Input `i7` and output `o7` are line 7. Delays of constants are recognised as constant.
    pub fn build(&mut self) -> Arc<Module> {
        let g = Graph::new("random");
        let mut signals: Vec<Signal<'_>> = Vec::new();
        let mut registers: Vec<(usize, Register<'_>)> = Vec::new();
        for (index, step) in self.steps.iter().enumerate() {
            let operand = |k: usize| signals[step.from[k]];
            let like = |k: usize, width: u32| resize(operand(k), width);
            let name = format!("n{index}");
            let signal = match step.what {
                What::Input => g.input(&format!("i{index}"), step.width),
                What::Constant => g.constant(step.width, constant_value(step)),
                What::Not => !operand(0),
                What::And => operand(0) & like(1, step.width),
                What::Or => operand(0) | like(1, step.width),
                What::Xor => operand(0) ^ like(1, step.width),
                What::Add => operand(0) + like(1, step.width),
                What::Sub => operand(0) - like(1, step.width),
                What::Mul => operand(0) * operand(1),
                What::Equal => operand(0).equals(like(1, operand(0).width())),
                What::Less => operand(0).less_than(like(1, operand(0).width())),
                What::Select => operand(0).bit(0).select(operand(1), like(2, step.width)),
                What::Concat => Signal::join(&[operand(0), operand(1), operand(2)]),
                What::Slice => operand(0).slice(step.numbers[0], step.width),
                What::Any => operand(0).any(),
                What::All => operand(0).all(),
                What::Repeat => operand(0).repeat(step.numbers[0]),
                What::OneHot => operand(0).low(step.numbers[0]).one_hot(),
                What::Delay => {
                    if let Some(value) = operand(0).as_constant() {
                        self.held[index].fill(number(step.width, value));
                    }
                    operand(0).delay(step.numbers[0])
                }
                What::Register | What::RegisterEnabled => {
                    let register = g.register(&name, step.width, reset_value(step));
                    registers.push((index, register));
                    register.value()
                }
                What::Memory => {
                    let memory = g.memory(&format!("m{index}"), MEMORY_DEPTH, step.width);
                    memory.write(operand(0).bit(0), like(1, 3), like(2, step.width));
                    memory.read(like(0, 3))
                }
            };
            signals.push(signal.named(&name));
        }
        for (index, register) in registers {
            let step = &self.steps[index];
            let next = resize(signals[step.from[0]], step.width);
            match step.what {
                What::RegisterEnabled => register.next_if(signals[step.from[1]].bit(0), next),
                _ => register.next(next),
            }
        }
        for &index in &self.outputs {
            g.output(&format!("o{index}"), signals[index]);
        }
        g.finish().unwrap_or_else(|errors| panic!("{errors}"))
    }

    /// Evaluates every line with these inputs, in the order of [`Recipe::inputs`].
    pub fn settle(&mut self, inputs: &[Bits]) {
        let mut inputs = inputs.iter();
        for (index, step) in self.steps.iter().enumerate() {
            let width = step.width as usize;
            let values = &self.values;
            let operand = |k: usize| &values[step.from[k]];
            let like = |k: usize| resized(operand(k), width);
            let zip = |f: fn(bool, bool) -> bool| operand(0).iter().zip(like(1)).map(|(&a, b)| f(a, b)).collect();
            let second = || resized(operand(1), operand(0).len());
            let value: Bits = match step.what {
                What::Input => inputs.next().cloned().unwrap_or_default(),
                What::Constant => number(step.width, constant_value(step)),
                What::Not => complement(operand(0)),
                What::And => zip(|a, b| a & b),
                What::Or => zip(|a, b| a | b),
                What::Xor => zip(|a, b| a ^ b),
                What::Add => add(operand(0), &like(1), false),
                What::Sub => add(operand(0), &complement(&like(1)), true),
                What::Mul => {
                    let mut product = number(step.width, 0);
                    for (shift, _) in operand(1).iter().enumerate().filter(|(_, bit)| **bit) {
                        let mut row = vec![false; shift];
                        row.extend(operand(0));
                        product = add(&product, &resized(&row, width), false);
                    }
                    product
                }
                What::Equal => vec![*operand(0) == second()],
                What::Less => vec![below(operand(0), &second())],
                What::Select => {
                    if operand(0)[0] {
                        operand(1).clone()
                    } else {
                        like(2)
                    }
                }
                What::Concat => [2, 1, 0].iter().flat_map(|&k| operand(k).clone()).collect(),
                What::Slice => operand(0)[step.numbers[0] as usize..][..width].to_vec(),
                What::Any => vec![operand(0).contains(&true)],
                What::All => vec![!operand(0).contains(&false)],
                What::Repeat => operand(0).repeat(step.numbers[0] as usize),
                What::OneHot => {
                    let hot = small(&operand(0)[..step.numbers[0] as usize].to_vec());
                    (0..width).map(|index| index == hot).collect()
                }
                What::Delay | What::Register | What::RegisterEnabled | What::Memory => self.held[index][0].clone(),
            };
            self.values[index] = value;
        }
    }

    /// Advances the state by a clock edge.
    pub fn step(&mut self) {
        for (index, step) in self.steps.iter().enumerate() {
            let operand = |k: usize| &self.values[step.from[k]];
            let width = step.width as usize;
            let held = &mut self.held[index];
            match step.what {
                What::Delay => {
                    held.remove(0);
                    held.push(operand(0).clone());
                }
                What::Register => held[0] = resized(operand(0), width),
                What::RegisterEnabled if operand(1)[0] => held[0] = resized(operand(0), width),
                What::Memory => {
                    let memory = &mut self.memories[index];
                    let read = small(&resized(operand(0), 3));
                    held[0] = memory.get(read).cloned().unwrap_or(vec![false; width]);
                    let write = small(&resized(operand(1), 3));
                    if let (true, Some(word)) = (operand(0)[0], memory.get_mut(write)) {
                        // What is read while it is written is wrong in every bit.
                        if read == write {
                            held[0].iter_mut().for_each(|bit| *bit = !*bit);
                        }
                        *word = resized(operand(2), width);
                    }
                }
                _ => {}
            }
        }
    }

    pub fn value(&self, line: usize) -> &Bits {
        &self.values[line]
    }
}

fn resize(signal: Signal<'_>, width: u32) -> Signal<'_> {
    if signal.width() > width { signal.low(width) } else { signal.extend(width) }
}

fn reset_value(step: &Step) -> u128 {
    if step.width >= 128 { u128::from(step.numbers[1]) } else { u128::from(step.numbers[1]) & ((1 << step.width) - 1) }
}

/// Zero, all ones, or an arbitrary value.
fn constant_value(step: &Step) -> u128 {
    let all = if step.width >= 128 { u128::MAX } else { (1 << step.width) - 1 };
    match step.numbers[1] % 3 {
        0 => 0,
        1 => all,
        _ => u128::from(step.numbers[1]).wrapping_mul(0x1234_5678_9abc_def0_1234_5678_9abc_def1) & all,
    }
}
