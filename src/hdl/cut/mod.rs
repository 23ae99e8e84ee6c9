//! Cuts a combinational module into pipeline stages for a clock: every operation gets a stage ([`place`]), and every
//! value waits in registers until the last stage that needs it.

mod block;
mod place;

use std::collections::HashMap;
use std::panic::Location;
use std::sync::Arc;

use place::Plan;

use super::delay_model::DelayModel;
use super::error::{BuildErrors, Error};
use super::graph::{Graph, Inner};
use super::module::{Module, Node, NodeId, Op};

/// The timing of a pipeline's stages, by the delay model that they were cut with.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Timing {
    /// The clock that the stages reach. It is below the requested one if a single operation takes longer than its
    /// period.
    pub clock_mhz: f64,
    /// The slowest stage, counted from 0.
    pub stage: u32,
    /// The named nodes on the critical path of that stage.
    pub critical: Vec<String>,
    /// Bits held in registers, those of the outputs among them.
    pub register_bits: u64,
}

/// The combinational `module` as a pipeline for `clock_mhz` that takes new inputs every cycle.
///
/// Inputs are expected straight from registers; every output ends in one, and all of them appear
/// [`Module::latency`] cycles after their inputs. Operations are not divided: one that takes longer than the period
/// gets a stage of its own, and [`Module::timing`] says what clock remains. Constants, and what is computed from
/// constants and parameters alone, are never delayed. A product that fits a multiplier block with registers inside
/// becomes an instance of one, and so does a table that fits a block memory; a difference that may be a sum one of the
/// target's carry chain, if the model names it.
///
/// A clock that is not a positive number; anything in `module` that is clocked, and instances.
#[track_caller]
pub fn cut(module: &Module, model: &DelayModel, clock_mhz: f64) -> Result<Arc<Module>, BuildErrors> {
    let place = Location::caller();
    let wrong = problems(module, clock_mhz);
    if !wrong.is_empty() {
        let error = |message| Error { module: module.name.clone(), message, place };
        return Err(BuildErrors(wrong.into_iter().map(error).collect()));
    }
    let mut plan = Plan::as_soon_as_possible(module, model, model.budget(clock_mhz));
    plan.save_registers();
    let mut pipeline = super::finish::finish(registered(module, &plan, model, place)?)?;
    pipeline.latency = plan.stages;
    let slowest = plan.slowest();
    pipeline.timing = Some(Timing {
        clock_mhz: model.clock(slowest.logic),
        stage: slowest.stage,
        critical: slowest.path.into_iter().map(|id| describe(module.node(id))).collect(),
        register_bits: register_bits(&pipeline),
    });
    Ok(Arc::new(pipeline))
}

fn problems(module: &Module, clock_mhz: f64) -> Vec<String> {
    let mut wrong = Vec::new();
    if !(clock_mhz.is_finite() && clock_mhz > 0.0) {
        wrong.push(format!("cut: a clock of {clock_mhz} MHz"));
    }
    for node in &module.nodes {
        let what = match node.op {
            Op::Delay { .. } | Op::Register { .. } | Op::MemoryRead { .. } => "is clocked",
            Op::InstanceOutput { .. } => "is an instance's output",
            _ => continue,
        };
        wrong.push(format!("cut: `{}` {what}; only combinational operations can be cut", describe(node)));
    }
    wrong
}

fn describe(node: &Node) -> String {
    node.name.clone().unwrap_or_else(|| format!("{:?} of {} bits", node.op, node.width))
}

/// The module with stages noted and registers between them.
fn registered(
    module: &Module,
    plan: &Plan<'_>,
    model: &DelayModel,
    place: &'static Location<'static>,
) -> Result<Inner, BuildErrors> {
    let mut inner = Graph::new(module.name.clone()).inner.into_inner();
    inner.about.clone_from(&module.about);
    inner.parameters.clone_from(&module.parameters);
    inner.ports.clone_from(&module.ports);
    inner.nodes.clone_from(&module.nodes);

    let mut delays: HashMap<(NodeId, u32), NodeId> = HashMap::new();
    let mut delayed = |nodes: &mut Vec<Node>, id: NodeId, until: u32| {
        let cycles = if plan.invariant[id.index()] { 0 } else { until - plan.stage[id.index()] };
        if cycles == 0 {
            return id;
        }
        *delays.entry((id, cycles)).or_insert_with(|| {
            let width = nodes[id.index()].width;
            // Unnamed: a printer derives the name from the value and the stage it has come to.
            nodes.push(Node { op: Op::Delay { cycles }, width, operands: vec![id], name: None, stage: None });
            NodeId(nodes.len() as u32 - 1)
        })
    };
    for id in module.ids() {
        let (stage, begin) = (plan.stage[id.index()], plan.begin(id));
        let mut operands = std::mem::take(&mut inner.nodes[id.index()].operands);
        for operand in &mut operands {
            *operand = delayed(&mut inner.nodes, *operand, begin);
        }
        inner.nodes[id.index()].operands = operands;
        if stage != begin && matches!(module.node(id).op, Op::Lookup(_)) {
            block::instantiate_table(&mut inner, id, &module.name, model)?;
        } else if stage != begin {
            block::instantiate_multiplier(&mut inner, id, model)?;
        } else if module.node(id).op == Op::SubAdd
            && let Some(primitive) = model.adder_primitive
        {
            block::instantiate_sub_add(&mut inner, id, primitive)?;
        }
        let node = &mut inner.nodes[id.index()];
        node.stage = (!matches!(node.op, Op::Constant(_))).then_some(stage);
    }
    for port in inner.ports.iter_mut().filter(|port| port.output) {
        port.node = port.node.map(|id| delayed(&mut inner.nodes, id, plan.stages));
    }
    inner.places = vec![place; inner.nodes.len()];
    Ok(inner)
}

/// Those between stages; those inside multiplier blocks are the blocks' own.
fn register_bits(module: &Module) -> u64 {
    let bits = |node: &Node| match node.op {
        Op::Delay { cycles } => u64::from(cycles) * u64::from(node.width),
        _ => 0,
    };
    module.nodes.iter().map(bits).sum()
}
