//! Names for values that the source left unnamed: short, without a negation in front, and never cut so that two of them
//! look alike.

use super::super::module::{Module, Node, NodeId, Op};

/// A derived name has at most about this many characters before its stage. Longer parts keep their last words, which
/// are what tells them apart.
const LONGEST: usize = 44;
/// The length of each part where both together are too long.
const LONGEST_PART: usize = 20;

/// Makes names of a module's values, where `declared` has those that are known already.
pub(super) struct Derivation<'a> {
    pub module: &'a Module,
    pub declared: &'a [Option<String>],
}

impl Derivation<'_> {
    /// A name that says what the value is.
    pub fn name(&self, id: NodeId) -> String {
        let node = self.module.node(id);
        let part = |position: usize| self.part(node.operands[position]);
        let two = |word: &str| join(&part(0), word, &part(1));
        match &node.op {
            Op::Delay { .. } => self.delayed(id),
            Op::Not => self.complement(node.operands[0]),
            Op::And => self.both(id),
            Op::Or => self.chain(id, "or"),
            Op::Xor => self.chain(id, "xor"),
            Op::Add => self.chain(id, "plus"),
            Op::Sub if self.is_constant(node.operands[0]) => join(&part(1), "from", &part(0)),
            Op::Sub => two("minus"),
            Op::SubAdd => two("minus_or_plus"),
            Op::Mul => two("times"),
            Op::Equal => self.compared(node, "equals", "equals"),
            Op::Less => self.compared(node, "below", "above"),
            Op::Mux => self.choice(node),
            Op::Case { .. } => join(&part(1), "by", &part(0)),
            Op::Slice { low } if node.width == 1 => format!("{}_{low}", part(0)),
            Op::Slice { low } => format!("{}_{}_{low}", part(0), low + node.width - 1),
            Op::OneHot => format!("{}_one_hot", part(0)),
            Op::Lookup(_) => format!("{}_word", part(0)),
            Op::Any => format!("{}_any", part(0)),
            Op::All => format!("{}_all", part(0)),
            Op::Concat => self.parts(node),
            Op::MemoryRead { memory } => format!("{}_word", self.module.memories[*memory].name),
            Op::InstanceOutput { instance, port } => {
                let instance = &self.module.instances[*instance];
                format!("{}_{}", instance.name, instance.module.ports[*port].name)
            }
            Op::Register { .. } => "state".to_owned(),
            Op::Parameter(index) => format!("{}_value", self.module.parameters[*index].name.to_lowercase()),
            Op::Constant(value) => format!("constant_{value}"),
            Op::Input | Op::Wire => "value".to_owned(),
        }
    }

    /// A value as a part of another one's name.
    fn part(&self, id: NodeId) -> String {
        let node = self.module.node(id);
        if let Some(name) = self.declared[id.index()].as_ref().or(node.name.as_ref()) {
            return name.clone();
        }
        match node.op {
            Op::Constant(value) => format!("{value}"),
            // Zeros above it change nothing.
            _ => extended(self.module, node).map_or_else(|| self.name(id), |value| self.part(value)),
        }
    }

    /// A delayed value is its source's name and the stage it has come to, or the cycles it has waited.
    fn delayed(&self, id: NodeId) -> String {
        let (mut root, mut total) = (id, 0);
        while let Op::Delay { cycles } = self.module.node(root).op {
            total += cycles;
            root = self.module.node(root).operands[0];
        }
        let base = self.part(root);
        match stage(self.module, id) {
            Some(stage) => format!("{base}_s{stage}"),
            None => format!("{base}_d{total}"),
        }
    }

    /// A comparison has an opposite, other values the ending of a line that is active when low.
    fn complement(&self, id: NodeId) -> String {
        let node = self.module.node(id);
        match node.op {
            _ if self.declared[id.index()].is_some() || node.name.is_some() => format!("{}_n", self.part(id)),
            Op::Less => self.compared(node, "at_least", "at_most"),
            Op::Equal => self.compared(node, "differs_from", "differs_from"),
            Op::Any => format!("{}_is_zero", self.part(node.operands[0])),
            _ => format!("{}_n", self.name(id)),
        }
    }

    /// `word` between the operands, or `turned` if the first one is a constant and goes behind.
    fn compared(&self, node: &Node, word: &str, turned: &str) -> String {
        let [left, right] = [0, 1].map(|position| node.operands[position]);
        match self.is_constant(left) {
            true => join(&self.part(right), turned, &self.part(left)),
            false => join(&self.part(left), word, &self.part(right)),
        }
    }

    fn is_constant(&self, id: NodeId) -> bool {
        matches!(self.module.node(id).op, Op::Constant(_))
    }

    /// The complement's operand, if the value is a complement without a name.
    fn complemented(&self, id: NodeId) -> Option<NodeId> {
        let node = self.module.node(id);
        let is_plain = self.declared[id.index()].is_none() && node.name.is_none() && node.op == Op::Not;
        let operand = node.operands.first().copied().filter(|_| is_plain)?;
        let has_opposite = matches!(self.module.node(operand).op, Op::Less | Op::Equal | Op::Any);
        (!has_opposite || self.declared[operand.index()].is_some()).then_some(operand)
    }

    /// `a` and not `b` is `a_unless_b`.
    fn both(&self, id: NodeId) -> String {
        let node = self.module.node(id);
        let [left, right] = [0, 1].map(|position| node.operands[position]);
        if let Some(bit) = self.module.repeated_bit(right) {
            return match self.complemented(bit) {
                Some(bit) => join(&self.part(left), "unless", &self.part(bit)),
                None => join(&self.part(left), "if", &self.part(bit)),
            };
        }
        match [left, right].map(|operand| self.complemented(operand)) {
            [None, Some(without)] => join(&self.part(left), "unless", &self.part(without)),
            [Some(without), None] => join(&self.part(right), "unless", &self.part(without)),
            [Some(left), Some(right)] => format!("neither_{}", join(&self.part(left), "nor", &self.part(right))),
            [None, None] => self.chain(id, "and"),
        }
    }

    /// Two operands of an operation that can have more: of those, the first and how many others.
    fn chain(&self, id: NodeId, word: &str) -> String {
        let mut operands = Vec::new();
        self.flatten(id, id, &mut operands);
        match operands[..] {
            [left, right] => join(&self.part(left), word, &self.part(right)),
            [first, ..] => join(&self.part(first), word, &format!("{}_others", operands.len() - 1)),
            [] => word.to_owned(),
        }
    }

    fn flatten(&self, root: NodeId, id: NodeId, operands: &mut Vec<NodeId>) {
        let node = self.module.node(id);
        let is_open = id == root || (self.declared[id.index()].is_none() && node.name.is_none());
        if !is_open || node.op != self.module.node(root).op {
            operands.push(id);
            return;
        }
        node.operands.iter().for_each(|operand| self.flatten(root, *operand, operands));
    }

    /// A value that a condition replaces by a constant, or the first of two values.
    fn choice(&self, node: &Node) -> String {
        let [condition, yes, no] = [0, 1, 2].map(|position| node.operands[position]);
        let (value, mut word) = if self.is_constant(yes) { (no, "unless") } else { (yes, "if") };
        let condition = match self.complemented(condition) {
            Some(without) => {
                word = if word == "if" { "unless" } else { "if" };
                without
            }
            None => condition,
        };
        join(&self.part(value), word, &self.part(condition))
    }

    /// What a concatenation has beside constants.
    fn parts(&self, node: &Node) -> String {
        let mut parts: Vec<NodeId> = node.operands.clone();
        parts.retain(|id| !self.is_constant(*id));
        let is_last_constant = node.operands.last().is_some_and(|id| !parts.contains(id));
        parts.dedup();
        match parts[..] {
            [] => "constant".to_owned(),
            [only] if node.operands.iter().filter(|part| **part == only).count() > 1 => {
                format!("{}_repeated", self.part(only))
            }
            [only] if is_last_constant => format!("{}_shifted", self.part(only)),
            [only] => format!("{}_extended", self.part(only)),
            [first, last] => join(&self.part(first), "with", &self.part(last)),
            [first, .., last] => join(&self.part(first), "to", &self.part(last)),
        }
    }
}

/// The value that a concatenation has below zeros.
fn extended(module: &Module, node: &Node) -> Option<NodeId> {
    match node.operands[..] {
        [zeros, value] if node.op == Op::Concat && module.node(zeros).op == Op::Constant(0) => Some(value),
        _ => None,
    }
}

/// The stage in which a value is available. Each rank of registers adds one.
pub(super) fn stage(module: &Module, id: NodeId) -> Option<u32> {
    let node: &Node = module.node(id);
    match node.op {
        Op::Delay { cycles } if node.stage.is_none() => Some(stage(module, node.operands[0])? + cycles),
        Op::Input if module.nodes.iter().any(|n| n.stage.is_some()) => Some(node.stage.unwrap_or(0)),
        _ => node.stage,
    }
}

/// Two parts and the word between them. The right part leaves out the words with which both begin.
fn join(left: &str, word: &str, right: &str) -> String {
    let right = without_start_of(left, right);
    let whole = format!("{left}_{word}_{right}");
    if whole.len() <= LONGEST {
        return whole;
    }
    format!("{}_{word}_{}", last_words(left), last_words(right))
}

fn without_start_of<'t>(left: &str, right: &'t str) -> &'t str {
    let mut rest = right;
    for word in left.split('_') {
        match rest.split_once('_') {
            Some((first, behind)) if first == word => rest = behind,
            _ => break,
        }
    }
    if begins_a_name(rest) || is_number(rest) { rest } else { right }
}

/// Words that stand between two others.
const BETWEEN: [&str; 14] =
    ["or", "and", "xor", "if", "unless", "nor", "plus", "minus", "times", "below", "above", "with", "to", "by"];

fn is_number(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit())
}

/// True if the text does not begin with a number, a stage or a word that stands between two others.
fn begins_a_name(text: &str) -> bool {
    let first = text.split('_').next().unwrap_or_default();
    let is_stage = first.strip_prefix(['s', 'd']).is_some_and(is_number);
    !is_number(first) && !is_stage && !BETWEEN.contains(&first)
}

/// The end of a name, from a word with which a name can begin.
fn last_words(name: &str) -> &str {
    // A number belongs to the word before it, and what follows belongs to the number.
    let follows_number = |start: usize| name[..start - 1].rsplit('_').next().is_some_and(is_number);
    let is_word = |start: &usize| begins_a_name(&name[*start..]) && !follows_number(*start);
    let starts: Vec<usize> = name.match_indices('_').map(|(at, _)| at + 1).filter(is_word).collect();
    let fits = |start: &&usize| name.len() - **start <= LONGEST_PART;
    match starts.iter().find(fits).or(starts.last()) {
        Some(start) if name.len() > LONGEST_PART => &name[*start..],
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::join;

    #[test]
    fn long_names_keep_what_tells_them_apart() {
        assert_eq!(join("guard", "or", "sticky"), "guard_or_sticky");
        assert_eq!(join("invalid_here_0", "or", "invalid_here_1"), "invalid_here_0_or_1");
        let choice = |bits: &str| join(&format!("a_significand_{bits}_zeros"), "if", "significand_with_guard_is_zero");
        assert_eq!(choice("15_8"), "significand_15_8_zeros_if_guard_is_zero");
        assert_ne!(choice("15_8"), choice("7_0"));
    }
}
