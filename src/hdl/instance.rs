//! Instances of modules in others, and chains of them.

use std::sync::Arc;

use super::module::{Module, NodeId};

/// The number of copies that an instance stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstanceCount {
    /// One.
    One,
    /// A chain of as many as the parameter (or `localparam`) with this index says. Inputs are those of the first copy
    /// if they are chained (`NAME_in` for an output `NAME_out`), and shared by all otherwise, but for an input named
    /// `index`, which is each copy's number. Outputs are those of the last copy.
    Parameter(usize),
}

/// The input port of the next copy in a chain into which an output goes: `NAME_in` for `NAME_out`.
pub(super) fn next_in_chain(module: &Module, output: usize) -> Option<usize> {
    let name = format!("{}_in", module.ports[output].name.strip_suffix("_out")?);
    module.ports.iter().position(|port| !port.output && port.name == name)
}

/// An instance, or a chain of instances, of another module.
#[derive(Clone, Debug)]
pub struct Instance {
    /// The name.
    pub name: String,
    /// The instantiated module.
    pub module: Arc<Module>,
    /// The number of copies.
    pub count: InstanceCount,
    /// The value of each input port, by port index; `None` for outputs and for `index` of a chain.
    pub inputs: Vec<Option<NodeId>>,
    /// The value (1 bit, high in reset) that resets the instance; `None` for the reset of the module around it.
    pub reset: Option<NodeId>,
}

impl Instance {
    /// All values that it is given.
    pub(crate) fn given(&self) -> impl Iterator<Item = NodeId> {
        self.inputs.iter().flatten().copied().chain(self.reset)
    }

    /// As [`Instance::given`], to replace them.
    pub(super) fn given_mut(&mut self) -> impl Iterator<Item = &mut NodeId> {
        self.inputs.iter_mut().flatten().chain(&mut self.reset)
    }
}
