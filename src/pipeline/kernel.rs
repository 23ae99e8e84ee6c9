//! A graph of operators: the computation of a kernel, without times.

use std::collections::HashMap;
use std::panic::Location;

use crate::hdl::Error;
use crate::number::{Format, Roots, Soft};
use crate::operator::Operator;

/// A value's index in its kernel. Operands have lower indices than their results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct ValueId(pub u32);

impl ValueId {
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Kind {
    Number(Format),
    Bit,
}

impl Kind {
    pub fn width(self) -> u32 {
        match self {
            Self::Number(format) => format.width(),
            Self::Bit => 1,
        }
    }

    fn describe(self) -> String {
        match self {
            Self::Number(format) => format.to_string(),
            Self::Bit => "a Boolean".to_owned(),
        }
    }
}

/// The source of a value. Everything but operators is glue: one level of plain logic, without its own register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Source {
    /// An input, by its number, which keeps two inputs apart.
    Input(usize),
    Constant(u128),
    /// Of operands in the format.
    Operator(Operator, Format),
    /// Operands: condition, value if set, value if clear.
    Select,
    And,
    Or,
    Not,
}

#[derive(Clone, Debug)]
pub(super) struct Value {
    pub source: Source,
    pub kind: Kind,
    pub operands: Vec<ValueId>,
    pub name: Option<String>,
}

/// The promise that an input is neither infinite nor NaN while a condition holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Promise {
    pub value: ValueId,
    pub condition: ValueId,
    /// True if the input is also not below zero.
    pub not_negative: bool,
}

/// The graph of a kernel: operators and the values between them. [`super::trace`] makes it.
#[derive(Clone, Debug)]
pub struct Kernel {
    pub(super) name: String,
    pub(super) about: Vec<String>,
    pub(super) values: Vec<Value>,
    pub(super) inputs: Vec<(String, ValueId)>,
    pub(super) outputs: Vec<(String, ValueId)>,
    /// Inputs that arrive some cycles after the others.
    pub(super) late: Vec<(ValueId, u32)>,
    pub(super) promises: Vec<Promise>,
    /// A Boolean that is supposed to be set.
    pub(super) supposed: Option<ValueId>,
    pub(super) errors: Vec<Error>,
    known: HashMap<(Source, Vec<ValueId>, Kind), ValueId>,
}

impl Kernel {
    pub(super) fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            about: Vec::new(),
            values: Vec::new(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            late: Vec::new(),
            promises: Vec::new(),
            supposed: None,
            errors: Vec::new(),
            known: HashMap::new(),
        }
    }

    /// The same kernel where what is supposed is known, without what no output needs then.
    pub(super) fn supposed(self) -> Self {
        let Some(supposed) = self.supposed else { return self };
        let mut new = Self { about: self.about.clone(), ..Self::new(&self.name) };
        let is_set = new.constant(Kind::Bit, 1);
        let mut needed = vec![false; self.values.len()];
        self.outputs.iter().for_each(|(_, id)| needed[id.index()] = true);
        for (index, value) in self.values.iter().enumerate().rev() {
            if needed[index] && index != supposed.index() {
                value.operands.iter().for_each(|id| needed[id.index()] = true);
            }
        }
        let mut moved = vec![is_set; self.values.len()];
        for (index, value) in self.values.iter().enumerate() {
            let old = ValueId(index as u32);
            let operands: Vec<_> = value.operands.iter().map(|id| moved[id.index()]).collect();
            let id = match (value.source, operands.as_slice()) {
                _ if old == supposed => is_set,
                (Source::Input(_), _) => new.input(value.name.as_deref().unwrap_or_default(), value.kind),
                _ if !needed[index] => continue,
                (Source::Select, &[condition, yes, no]) => match new.as_constant(condition) {
                    Some(0) => no,
                    Some(_) => yes,
                    None => new.shared(value.source, value.kind, operands),
                },
                (Source::And | Source::Or, &[a, b]) => new.logic(value.source, a, b),
                (Source::Not, &[a]) => new.not(a),
                _ => new.shared(value.source, value.kind, operands),
            };
            if new.as_constant(id).is_none() && value.name.is_some() {
                new.values[id.index()].name.clone_from(&value.name);
            }
            moved[index] = id;
        }
        let at = |id: ValueId| moved[id.index()];
        new.outputs = self.outputs.into_iter().map(|(name, id)| (name, at(id))).collect();
        new.late = self.late.into_iter().map(|(id, cycles)| (at(id), cycles)).collect();
        new.promises = self
            .promises
            .into_iter()
            .map(|promise| Promise { value: at(promise.value), condition: at(promise.condition), ..promise })
            .collect();
        new
    }

    pub(super) fn value(&self, id: ValueId) -> &Value {
        &self.values[id.index()]
    }

    pub(super) fn error(&mut self, message: String, place: &'static Location<'static>) {
        self.errors.push(Error { module: self.name.clone(), message, place });
    }

    /// A value with this source. An equal one is reused if it exists.
    fn shared(&mut self, source: Source, kind: Kind, operands: Vec<ValueId>) -> ValueId {
        let next = ValueId(self.values.len() as u32);
        let id = *self.known.entry((source, operands.clone(), kind)).or_insert(next);
        if id == next {
            self.values.push(Value { source, kind, operands, name: None });
        }
        id
    }

    pub(super) fn input(&mut self, name: &str, kind: Kind) -> ValueId {
        let id = self.shared(Source::Input(self.inputs.len()), kind, vec![]);
        self.values[id.index()].name = Some(name.to_owned());
        self.inputs.push((name.to_owned(), id));
        id
    }

    pub(super) fn constant(&mut self, kind: Kind, bits: u128) -> ValueId {
        self.shared(Source::Constant(bits), kind, vec![])
    }

    pub(super) fn as_constant(&self, id: ValueId) -> Option<u128> {
        match self.value(id).source {
            Source::Constant(bits) => Some(bits),
            _ => None,
        }
    }

    fn is_number(&self, id: ValueId, number: f64) -> bool {
        let Kind::Number(format) = self.value(id).kind else { return false };
        self.as_constant(id).is_some_and(|bits| Soft::from_f64(format, number).bits() == bits)
    }

    fn mixes(&self, what: &str, operands: &[ValueId]) -> String {
        let one = |&id: &ValueId| {
            let value = self.value(id);
            let name = value.name.as_deref().unwrap_or("a value");
            format!("`{name}` in {}", value.kind.describe())
        };
        format!("{what}: {}", operands.iter().map(one).collect::<Vec<_>>().join(" and "))
    }

    /// An operator's result. A cheaper operator's, or a constant, if that is the same.
    pub(super) fn operator(&mut self, operator: Operator, operands: &[ValueId]) -> Result<ValueId, String> {
        let kind = self.value(operands[0]).kind;
        let Kind::Number(format) = kind else { return Err(self.mixes(operator.name(), operands)) };
        if operands.iter().any(|id| self.value(*id).kind != kind) {
            return Err(self.mixes(operator.name(), operands));
        }
        match (operator, operands) {
            (Operator::Convert { to }, [a]) if to == format => return Ok(*a),
            (Operator::Mul, &[a, half] | &[half, a]) if self.is_number(half, 0.5) => {
                return self.operator(Operator::Halve, &[a]);
            }
            (Operator::Mul, &[a, b]) if a == b => return self.operator(Operator::Square, &[a]),
            // A quotient is rounded correctly, which a faithful reciprocal is not.
            (Operator::Div, &[one, a]) if self.is_number(one, 1.0) && format.roots() == Roots::Correct => {
                return self.operator(Operator::Recip, &[a]);
            }
            _ => {}
        }
        let result = match operator.result_format(format) {
            Some(format) => Kind::Number(format),
            None => Kind::Bit,
        };
        let constants: Option<Vec<u128>> = operands.iter().map(|id| self.as_constant(*id)).collect();
        if let Some(constants) = constants {
            let bits = operator.twin_of(format, std::array::from_fn(|i| constants[i.min(constants.len() - 1)]));
            return Ok(self.constant(result, bits));
        }
        Ok(self.shared(Source::Operator(operator, format), result, operands.to_vec()))
    }

    pub(super) fn select(&mut self, condition: ValueId, yes: ValueId, no: ValueId) -> Result<ValueId, String> {
        let kind = self.value(yes).kind;
        if self.value(no).kind != kind {
            return Err(self.mixes("select", &[yes, no]));
        }
        if yes == no {
            return Ok(yes);
        }
        Ok(match self.as_constant(condition) {
            Some(0) => no,
            Some(_) => yes,
            None => self.shared(Source::Select, kind, vec![condition, yes, no]),
        })
    }

    pub(super) fn not(&mut self, a: ValueId) -> ValueId {
        match self.value(a).source {
            Source::Constant(bits) => self.constant(Kind::Bit, 1 - bits),
            Source::Not => self.value(a).operands[0],
            _ => self.shared(Source::Not, Kind::Bit, vec![a]),
        }
    }

    /// The result of `source`, which is [`Source::And`] or [`Source::Or`].
    pub(super) fn logic(&mut self, source: Source, a: ValueId, b: ValueId) -> ValueId {
        let absorbing = u128::from(source == Source::Or);
        match (self.as_constant(a), self.as_constant(b)) {
            _ if a == b => a,
            (Some(bit), _) => {
                if bit == absorbing {
                    a
                } else {
                    b
                }
            }
            (_, Some(bit)) => {
                if bit == absorbing {
                    b
                } else {
                    a
                }
            }
            _ => self.shared(source, Kind::Bit, vec![a, b]),
        }
    }

    /// Why an operator of this kernel needs logic for infinities, NaN, subnormals, overflow or underflow: the first
    /// such operator, and the cases that may occur. `None` if no operator does, since the format is wide enough for
    /// every input that was promised to be finite.
    pub fn not_normal(&self) -> Option<String> {
        super::range::Ranges::of(self).short
    }

    /// The values that some output needs.
    pub(super) fn live(&self) -> Vec<bool> {
        let mut live = vec![false; self.values.len()];
        for (_, id) in &self.outputs {
            live[id.index()] = true;
        }
        for index in (0..self.values.len()).rev() {
            if live[index] {
                self.values[index].operands.iter().for_each(|id| live[id.index()] = true);
            }
        }
        live
    }
}
