//! The top of the shell: the core, its registers, and the bursts of its reads and writes.

use std::sync::Arc;

use super::port::{ControlInputs, ControlOutputs, MemoryInputs, MemoryOutputs};
use super::{control, read, write};
use crate::afu::port::{JobInputs, JobOutputs, ReadInputs, ReadOutputs, WriteInputs, WriteOutputs, outputs};
use crate::afu::{EPOCH_BITS, MAX_SCPUS, SCPU_BITS, Spec};
use crate::hdl::{BuildErrors, Graph, Module};

/// The top's name.
pub(super) const NAME: &str = "contact_afu_axi";
/// The name of the clock, as Vitis expects it.
pub(super) const CLOCK: &str = "ap_clk";
/// The name of the reset, active low.
pub(super) const RESET: &str = "ap_rst_n";

/// The top around `core`, the module that is the top of the shell `line`.
pub(super) fn top(spec: &Spec, core: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new(NAME);
    graph.about("collision-detection accelerator behind an AXI4 master and an AXI4-Lite slave");
    // Behind deciders the number of SCPUs is fixed.
    if !spec.config.has_deciders() {
        graph.parameter("SCPUS", spec.config.scpus, 1..=MAX_SCPUS, SCPU_BITS);
    }
    graph.clocked_by(CLOCK);
    graph.reset_by(!graph.input(RESET, 1));
    let host = ControlInputs::of(spec).map(|port| port.input(&graph));
    let memory = MemoryInputs::of(spec).map(|port| port.input(&graph));
    let slot_bits = spec.max_outstanding.ilog2();
    let constant = |width: u32, value: u128| graph.constant(width, value);

    let told = JobOutputs::of(spec).map(|port| (port.name, graph.wire(port.name, port.bits)));
    let requests = ReadOutputs::of(spec).map(|port| graph.wire(port.name, port.bits));
    let writes = WriteOutputs::of(spec).map(|port| graph.wire(port.name, port.bits));
    let reader = graph.instance(
        "reader",
        &read::read(spec)?,
        &[
            ("rd_valid", requests.rd_req_valid),
            ("rd_address", requests.rd_req_address),
            ("rd_tag", requests.rd_req_tag),
            ("arready", memory.m_axi_gmem_arready),
            ("rvalid", memory.m_axi_gmem_rvalid),
            ("rdata", memory.m_axi_gmem_rdata),
            ("rresp", memory.m_axi_gmem_rresp),
            ("rlast", memory.m_axi_gmem_rlast),
        ],
    );
    let writer = graph.instance(
        "writer",
        &write::write(spec)?,
        &[
            ("wr_valid", writes.wr_req_valid),
            ("wr_address", writes.wr_req_address),
            ("wr_tag", writes.wr_req_tag),
            ("wr_data", writes.wr_req_data),
            ("awready", memory.m_axi_gmem_awready),
            ("wready", memory.m_axi_gmem_wready),
            ("bvalid", memory.m_axi_gmem_bvalid),
            ("bresp", memory.m_axi_gmem_bresp),
        ],
    );

    let names: Vec<(String, _)> =
        told.named().into_iter().map(|(_, (name, wire))| (format!("core_{name}"), wire)).collect();
    let mut control_inputs = host.named();
    control_inputs.extend(names.iter().map(|(name, wire)| (name.as_str(), *wire)));
    control_inputs.extend([
        ("read_failed", reader.output("failed")),
        ("read_response", reader.output("failed_response")),
        ("read_address", reader.output("failed_address")),
        ("read_epoch", reader.output("rsp_tag").slice(slot_bits, EPOCH_BITS)),
        ("write_failed", writer.output("failed")),
        ("write_response", writer.output("failed_response")),
        ("write_address", writer.output("failed_address")),
        ("write_epoch", writer.output("rsp_tag").slice(slot_bits, EPOCH_BITS)),
        ("read_unasked", reader.output("unasked")),
        ("write_unasked", writer.output("unasked")),
        ("read_idle", reader.output("idle")),
        ("write_idle", writer.output("idle")),
        ("line_read", reader.output("rsp_valid")),
        ("line_written", writes.wr_req_valid),
    ]);
    let control = graph.instance("control", &control::control(spec)?, &control_inputs);

    let job = JobInputs::of(spec).map(|port| control.output(port.name));
    let read_inputs = ReadInputs {
        rd_req_ready: reader.output("rd_ready"),
        rd_rsp_valid: reader.output("rsp_valid"),
        rd_rsp_tag: reader.output("rsp_tag"),
        rd_rsp_data: reader.output("rsp_data"),
        rd_rsp_error: reader.output("rsp_error"),
    };
    let write_inputs = WriteInputs {
        wr_req_ready: writer.output("wr_ready"),
        wr_rsp_valid: writer.output("rsp_valid"),
        wr_rsp_tag: writer.output("rsp_tag"),
        wr_rsp_error: writer.output("rsp_error"),
    };
    let core_inputs = [job.named(), read_inputs.named(), write_inputs.named()].concat();
    let core = graph.instance("core", core, &core_inputs);
    for (name, wire) in told.named().into_iter().map(|(_, named)| named) {
        wire.drive(core.output(name));
    }
    for (name, wire) in requests.named().into_iter().chain(writes.named()) {
        wire.drive(core.output(name));
    }

    outputs(&graph, ControlOutputs::of(spec).map(|port| control.output(port.name)).named());
    let size = constant(3, (spec.config.bus / 8).ilog2().into());
    let (incrementing, cache, never) = (constant(2, 1), constant(4, 0b0011), constant(1, 0));
    let to_memory = MemoryOutputs {
        m_axi_gmem_awvalid: writer.output("awvalid"),
        m_axi_gmem_awid: never,
        m_axi_gmem_awaddr: writer.output("awaddr"),
        m_axi_gmem_awlen: writer.output("awlen"),
        m_axi_gmem_awsize: size,
        m_axi_gmem_awburst: incrementing,
        m_axi_gmem_awlock: never,
        m_axi_gmem_awcache: cache,
        m_axi_gmem_awprot: constant(3, 0),
        m_axi_gmem_awqos: constant(4, 0),
        m_axi_gmem_wvalid: writer.output("wvalid"),
        m_axi_gmem_wdata: writer.output("wdata"),
        m_axi_gmem_wstrb: constant(1, 1).repeat(spec.config.bus / 8),
        m_axi_gmem_wlast: writer.output("wlast"),
        m_axi_gmem_bready: constant(1, 1),
        m_axi_gmem_arvalid: reader.output("arvalid"),
        m_axi_gmem_arid: never,
        m_axi_gmem_araddr: reader.output("araddr"),
        m_axi_gmem_arlen: reader.output("arlen"),
        m_axi_gmem_arsize: size,
        m_axi_gmem_arburst: incrementing,
        m_axi_gmem_arlock: never,
        m_axi_gmem_arcache: cache,
        m_axi_gmem_arprot: constant(3, 0),
        m_axi_gmem_arqos: constant(4, 0),
        m_axi_gmem_rready: constant(1, 1),
    };
    outputs(&graph, to_memory.named());
    graph.finish()
}
