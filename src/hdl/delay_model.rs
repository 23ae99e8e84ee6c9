//! Delays of operations on a target's fabric, for cutting pipelines. All times are in nanoseconds.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::loads::{chooser, loads};
use super::module::{Module, Node, NodeId, Op, Primitive};

/// Tables with so many bits of index go into a block memory, where the target has such: shorter ones are a look-up
/// table or two a bit, longer ones take several blocks.
const TABLE_INDEX: RangeInclusive<u32> = 6..=9;
/// The widest word of a block memory.
const TABLE_BITS: u32 = 36;
/// Bits of an index into a block memory of twice as many words.
pub(crate) const DEEP_TABLE_INDEX_BITS: u32 = 10;
/// The widest word of that.
pub(crate) const DEEP_TABLE_BITS: u32 = 18;

/// The delays of a target between two registers.
///
/// Times are of register-to-register figures of one open flow (Yosys 0.70, nextpnr-ecp5 0.11, LFE5U-85F speed grade 8);
/// routing is contained in each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DelayModel {
    /// The target.
    pub name: String,
    /// Clock to output, routing to the first logic and set-up: paid once between two registers.
    pub register: f64,
    /// One level of look-up tables in a tree over many bits, and the way to the next.
    pub lut: f64,
    /// A tree over 2^n bits takes n times this longer: they come from far apart.
    #[serde(default)]
    pub spread: f64,
    /// A gate of two inputs on each bit by itself: several share a look-up table, and the ways are short.
    pub gate: f64,
    /// Inputs of a look-up table.
    pub lut_inputs: u32,
    /// One level of two-way multiplexers, beside what its select line takes.
    pub mux: f64,
    /// The part of the period that is reserved for placement, which no model of operations knows.
    #[serde(default)]
    pub margin: f64,
    /// A line that goes to 2^n places takes n times this longer.
    #[serde(default)]
    pub fanout: f64,
    /// Into a carry chain and out of it at a sum bit.
    pub carry: f64,
    /// One bit of a carry chain.
    pub carry_bit: f64,
    /// From logic to the carry at the beginning of a chain, where it is not a constant. Not fitted: read off routed
    /// roots and quotients.
    #[serde(default)]
    pub carry_in: f64,
    /// Out of a carry chain at its end, as a comparison does, beyond what a sum needs.
    pub carry_out: f64,
    /// One multiplier block.
    pub multiplier: f64,
    /// The widest operand of a multiplier block.
    pub multiplier_bits: u32,
    /// Register ranks inside a multiplier block: 2, of its factors and its product, or 0 for a block that is used
    /// without.
    #[serde(default)]
    pub multiplier_registers: u32,
    /// From logic into a multiplier block's first register, beyond what a register between stages takes: blocks stand
    /// in a few columns, and the way there is long. Like the next one not fitted: read off routed SCPUs.
    #[serde(default)]
    pub multiplier_input: f64,
    /// Out of a multiplier block's last register, beyond what a register between stages takes.
    #[serde(default)]
    pub multiplier_output: f64,
    /// Register ranks of a block memory that holds a table: 2, of its index and its word, or 0 where tables are logic.
    #[serde(default)]
    pub table_registers: u32,
    /// Out of such a memory's last register, beyond what a register between stages takes: it is slower, and farther
    /// off.
    #[serde(default)]
    pub table_output: f64,
    /// The primitive such a memory is written as; without one synthesis has to find it.
    #[serde(default)]
    pub memory_primitive: Option<Primitive>,
    /// True to make operators without multiplier blocks where possible: for a device that runs out of them first.
    #[serde(default)]
    pub spares_multipliers: bool,
    /// The primitive a multiplier block with registers is written as; without one synthesis has to find it.
    #[serde(default)]
    pub multiplier_primitive: Option<Primitive>,
    /// The primitive that differences which may be sums are written as, where synthesis does not fold the complement
    /// into the carry chain by itself.
    #[serde(default)]
    pub adder_primitive: Option<Primitive>,
}

impl Default for DelayModel {
    /// What `rtl/` is cut with, for any family: fitted to the one router there is, without a vendor's primitives.
    /// Synthesis has to find the registers of multiplier blocks and block memories; Yosys leaves those of an ECP5's
    /// blocks in the fabric, so for it there are [`Primitive`]s.
    fn default() -> Self {
        Self::ecp5().with_registered_multipliers(None).with_registered_tables(None)
    }
}

impl DelayModel {
    /// What `scripts/fit-delays` found: `docs/delays-ecp5.json` has the graphs and how far each is off.
    pub fn ecp5() -> Self {
        Self {
            register: 0.987,
            lut: 0.152,
            spread: 0.319,
            gate: 0.23,
            mux: 0.344,
            fanout: 0.078,
            carry: 0.727,
            carry_bit: 0.035,
            carry_out: 0.667,
            multiplier: 4.413,
            ..Self::guess()
        }
    }

    /// Where a fit begins: read off a dozen figures by hand, of adders of 12, 16, 24, 32 and 48 bits (453, 431, 385,
    /// 356 and 306 MHz), a 31-bit comparison (304), a 28-bit shifter of two, three and five levels (447, 306 and 234),
    /// an 18 × 18 product (182) and a 24 × 24 one (111).
    pub fn guess() -> Self {
        Self {
            name: "ecp5".to_owned(),
            margin: 0.1,
            register: 1.0,
            lut: 0.62,
            spread: 0.0,
            gate: 0.31,
            lut_inputs: 4,
            mux: 0.65,
            fanout: 0.0,
            carry: 0.85,
            carry_bit: 0.0295,
            carry_in: 0.6,
            carry_out: 0.52,
            multiplier: 4.5,
            multiplier_bits: 18,
            multiplier_registers: 0,
            multiplier_input: 0.0,
            multiplier_output: 0.0,
            table_registers: 0,
            table_output: 0.0,
            memory_primitive: None,
            spares_multipliers: false,
            multiplier_primitive: None,
            adder_primitive: None,
        }
    }

    /// The parameters of a fit: all times. They are positive, because a fit changes them by factors.
    pub fn parameters(&self) -> [f64; 10] {
        let Self { register, lut, spread, gate, mux, fanout, carry, carry_bit, carry_out, multiplier, .. } = *self;
        [register, lut, spread, gate, mux, fanout, carry, carry_bit, carry_out, multiplier].map(|time| time.max(0.01))
    }

    /// The same target with other times, in the order of [`DelayModel::parameters`]; those not given stay.
    #[must_use]
    pub(crate) fn with_parameters(&self, times: &[f64]) -> Self {
        let mut model = self.clone();
        let DelayModel { register, lut, spread, gate, mux, fanout, carry, carry_bit, carry_out, multiplier, .. } =
            &mut model;
        let places = [register, lut, spread, gate, mux, fanout, carry, carry_bit, carry_out, multiplier];
        places.into_iter().zip(times).for_each(|(place, time)| *place = *time);
        model
    }

    /// The longest way through a combinational module, from inputs to outputs.
    pub fn longest(&self, module: &Module) -> f64 {
        let mut arrival: Vec<f64> = Vec::with_capacity(module.nodes.len());
        for (node, delay) in module.nodes.iter().zip(self.delays(module)) {
            let before = node.operands.iter().filter_map(|id| arrival.get(id.index())).copied().fold(0.0, f64::max);
            arrival.push(before + delay);
        }
        arrival.into_iter().fold(0.0, f64::max)
    }

    /// The time between two register ranks at `clock_mhz` that logic is given: what is left but for the margin.
    pub fn budget(&self, clock_mhz: f64) -> f64 {
        1000.0 / clock_mhz * (1.0 - self.margin) - self.register
    }

    /// The clock, in MHz, at which logic that takes `logic` runs between two registers.
    pub fn clock(&self, logic: f64) -> f64 {
        1000.0 / (self.register + logic)
    }

    /// The same target with multiplier blocks whose registers are used, written as `primitive` where there is one.
    ///
    /// A block with registers is timed by them, not by the path inside, which nextpnr-ecp5 does not know.
    #[must_use]
    pub fn with_registered_multipliers(self, primitive: Option<Primitive>) -> Self {
        // Read off routed SCPUs: blocks stand in a few columns, and ways to and from them are long.
        let far = Self { multiplier_input: 1.6, multiplier_output: 0.75, ..self };
        Self { multiplier_registers: 2, multiplier_primitive: primitive, ..far }
    }

    /// The same target with longer tables in block memories whose registers are used, written as `primitive` where
    /// there is one.
    #[must_use]
    pub fn with_registered_tables(self, primitive: Option<Primitive>) -> Self {
        // Read off routed reciprocals.
        Self { table_registers: 2, table_output: 1.0, memory_primitive: primitive, ..self }
    }

    /// The same target where multiplier blocks are to be spared, or not.
    #[must_use]
    pub fn with_spared_multipliers(self, spares: bool) -> Self {
        Self { spares_multipliers: spares, ..self }
    }

    /// The same target with differences that may be sums written as `primitive`.
    #[must_use]
    pub(crate) fn with_adders(self, primitive: Primitive) -> Self {
        Self { adder_primitive: Some(primitive), ..self }
    }

    /// Register ranks inside an operation: only a product that one multiplier block takes has any, and a table that one
    /// memory block does.
    pub(super) fn ranks(&self, module: &Module, node: &Node) -> u32 {
        let fits = |id: &NodeId| module.node(*id).width <= self.multiplier_bits;
        match node.op {
            Op::Mul if node.operands.iter().all(fits) => self.multiplier_registers,
            Op::Lookup(_) => {
                let index_bits = module.node(node.operands[0]).width;
                let is_shallow = TABLE_INDEX.contains(&index_bits) && node.width <= TABLE_BITS;
                let is_deep = index_bits == DEEP_TABLE_INDEX_BITS && node.width <= DEEP_TABLE_BITS;
                if is_shallow || is_deep { self.table_registers } else { 0 }
            }
            _ => 0,
        }
    }

    /// From the operands' arrival to the result of each node of a combinational module; wiring takes no time.
    pub fn delays(&self, module: &Module) -> Vec<f64> {
        let loads = loads(module);
        module.nodes.iter().map(|node| self.delay(module, node, &loads)).collect()
    }

    /// `loads` is how many places each value chooses in.
    fn delay(&self, module: &Module, node: &Node, loads: &[u32]) -> f64 {
        let load = |position: usize| self.line(loads[chooser(module, node.operands[position]).index()]);
        // A value whose bits choose in many places comes late wherever it goes.
        let busiest =
            || [0, 1].map(|position| self.line(loads[node.operands[position].index()])).into_iter().fold(0.0, f64::max);
        let width = |position: usize| module.node(node.operands[position]).width;
        let constant = |position: usize| matches!(module.node(node.operands[position]).op, Op::Constant(_));
        match node.op {
            // An inverter is absorbed by the table before or after it; behind a carry chain it is a table.
            Op::Not if is_chained(module, node.operands[0]) => self.carry_out,
            Op::Not | Op::Wire | Op::Slice { .. } | Op::Concat => 0.0,
            Op::And | Op::Or | Op::Xor => {
                let repeated =
                    [0, 1].into_iter().filter(|&position| module.repeated_bit(node.operands[position]).is_some());
                self.gate + repeated.map(load).fold(0.0, f64::max)
            }
            Op::Mux if constant(1) || constant(2) => self.gate + load(0),
            Op::Mux => self.mux + load(0),
            Op::Case { .. } => {
                let levels = (node.operands.len() - 1).next_power_of_two().ilog2();
                f64::from(levels) * self.mux + load(0)
            }
            Op::Add | Op::Sub => busiest() + self.adder(node.width),
            // The complement shares the look-up tables of the chain, or is as fast as a gate before it.
            Op::SubAdd => busiest().max(load(2) + self.carry_in) + self.adder(node.width),
            Op::Less => busiest() + self.tree(2 * width(0)).min(self.adder(width(0)) + self.carry_out),
            Op::Equal if constant(0) || constant(1) => self.tree(width(0)),
            Op::Equal => self.tree(2 * width(0)).min(self.adder(width(0)) + self.carry_out),
            Op::Any | Op::All => self.tree(width(0)),
            Op::Mul if self.ranks(module, node) > 0 => self.multiplier_output,
            Op::Mul => self.product(width(0), width(1)),
            // Each output is a function of all address bits.
            Op::OneHot => self.tree(width(0)),
            Op::Lookup(_) if self.ranks(module, node) > 0 => self.table_output,
            Op::Lookup(_) => self.table(width(0)),
            Op::Input | Op::Parameter(_) | Op::Constant(_) => 0.0,
            Op::Delay { .. } | Op::Register { .. } | Op::MemoryRead { .. } | Op::InstanceOutput { .. } => 0.0,
        }
    }

    /// The additional delay of a net with this fan-out, compared with a fan-out of one.
    fn line(&self, places: u32) -> f64 {
        self.fanout * f64::from(places.max(1)).log2()
    }

    /// Any function of `inputs` bits that is a tree of tables.
    fn tree(&self, inputs: u32) -> f64 {
        let (mut levels, mut reach) = (0, 1_u32);
        while reach < inputs {
            reach = reach.saturating_mul(self.lut_inputs.max(2));
            levels += 1;
        }
        self.lut * f64::from(levels) + self.spread * f64::from(inputs.max(1)).log2()
    }

    /// A table by an index: one level of tables, and a two-way choice for each further bit of the index. Those are
    /// multiplexers beside the tables, with short ways: 128 words of 54 bits reach 341 MHz.
    fn table(&self, index: u32) -> f64 {
        self.lut + 0.6 * self.lut * f64::from(index.saturating_sub(self.lut_inputs))
    }

    fn adder(&self, width: u32) -> f64 {
        let chained = self.carry + self.carry_bit * f64::from(width);
        // The highest sum bit of a narrow adder is one function of all operand bits.
        if 2 * width <= self.lut_inputs { self.tree(2 * width).min(chained) } else { chained }
    }

    /// Multiplier blocks and a tree of adders over them, or shifted rows where one operand is narrow.
    fn product(&self, left: u32, right: u32) -> f64 {
        let (narrow, wide) = (left.min(right), left.max(right));
        let adders = |rows: u32, width: u32| f64::from(rows.next_power_of_two().ilog2()) * self.adder(width);
        let bits = self.multiplier_bits.max(1);
        let tiles = narrow.div_ceil(bits).saturating_mul(wide.div_ceil(bits)).min(1 << 16);
        let blocks = self.multiplier + adders(tiles, wide + narrow - bits.min(narrow + wide - 1));
        blocks.min(self.gate + adders(narrow, wide + narrow))
    }
}

/// True if a value comes straight out of a carry chain.
fn is_chained(module: &Module, id: NodeId) -> bool {
    match module.node(id).op {
        Op::Slice { .. } => is_chained(module, module.node(id).operands[0]),
        Op::Add | Op::Sub | Op::SubAdd => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hdl::{Graph, Signal};

    fn clock(build: impl for<'g> Fn(Signal<'g>, Signal<'g>) -> Signal<'g>, width: u32) -> f64 {
        let g = Graph::new("one");
        g.output("y", build(g.input("a", width), g.input("b", width)));
        let module = g.finish().unwrap();
        let model = DelayModel::guess();
        model.clock(model.delays(&module).into_iter().sum())
    }

    #[test]
    fn the_fitted_model_is_what_the_fit_found() {
        let fit: serde_json::Value = serde_json::from_str(include_str!("../../docs/delays-ecp5.json")).unwrap();
        let found: DelayModel = serde_json::from_value(fit["model"].clone()).unwrap();
        assert_eq!(found, DelayModel::ecp5());
        let worst = fit["points"].as_array().unwrap().iter().filter(|point| point["fitted"] == false).map(|point| {
            let [routed, modelled] = ["routed_mhz", "modelled_mhz"].map(|key| point[key].as_f64().unwrap());
            (modelled / routed - 1.0).abs()
        });
        assert!(worst.fold(0.0, f64::max) < 0.15, "graphs that the fit did not see");
    }

    #[test]
    fn the_guess_meets_its_measurements() {
        for (width, mhz) in [(12, 453.0), (16, 431.0), (24, 385.0), (32, 356.0), (48, 306.0)] {
            let modelled = clock(|a, b| a + b, width);
            assert!((modelled / mhz - 1.0_f64).abs() < 0.03, "{width}-bit adder: {modelled:.0} for {mhz} MHz");
        }
        for (width, mhz) in [(18, 182.0), (24, 111.0)] {
            let modelled = clock(|a, b| a * b, width);
            assert!((modelled / mhz - 1.0_f64).abs() < 0.08, "{width}-bit product: {modelled:.0} for {mhz} MHz");
        }
    }

    #[test]
    fn reductions_are_trees() {
        let model = DelayModel::guess();
        for (bits, levels) in [(1, 0), (2, 1), (4, 1), (5, 2), (16, 2), (17, 3), (64, 3), (65, 4)] {
            assert_eq!(model.tree(bits), model.lut * f64::from(levels), "{bits}");
        }
    }
}
