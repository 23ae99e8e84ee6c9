//! The top of the shell: the core, and the parts that connect it to SPL2's port.

use std::sync::Arc;

use super::words::{self, MDATA_BITS, is_core_s};
use super::{SplInputs, SplOutputs, acknowledge, registers, sequence, transmit};
use crate::afu::port::{JobInputs, JobOutputs, ReadInputs, ReadOutputs, WriteInputs, WriteOutputs, outputs};
use crate::afu::{EPOCH_BITS, JobError, MAX_SCPUS, SCPU_BITS, Spec};
use crate::hdl::{BuildErrors, Graph, Module};

/// The top's name.
pub(super) const NAME: &str = "afu_top";

/// The top `afu_top` around `core`, the module that is the top of the shell `line`.
pub(super) fn afu_top(spec: &Spec, core: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new(NAME);
    graph.about("collision-detection accelerator below SPL2 of Intel HARP v1");
    // Behind deciders the number of SCPUs is fixed.
    if !spec.config.has_deciders() {
        graph.parameter("SCPUS", spec.config.scpus, 1..=MAX_SCPUS, SCPU_BITS);
    }
    let slot_bits = spec.max_outstanding.ilog2();

    let spl = SplInputs::of(spec).map(|port| port.input(&graph));
    let (rd_valid, data) = (spl.spl_rx_rd_valid, spl.spl_rx_data);

    // Everything except the registers is in reset until SPL is enabled, and restarts when it is enabled again.
    graph.reset_by((!spl.reset_n | spl.spl_reset | !spl.spl_enable).named("resets"));
    let power_on = (!spl.reset_n).named("power_on");
    let mdata0 = spl.spl_rx_hdr0.low(MDATA_BITS);
    let mdata1 = spl.spl_rx_hdr1.low(MDATA_BITS);

    let wire = |name: &str, width: u32| graph.wire(name, width);
    let told = JobOutputs::of(spec);
    let (capability, start) = (wire("capability", told.capability.bits), wire("start_job", 1));
    let (register_granted, end_granted) = (wire("register_granted", 1), wire("end_granted", 1));
    let (own_read_granted, read_number) = (wire("own_read_granted", 1), wire("own_read_number", words::NUMBER_BITS));
    let registers = graph.instance(
        "registers",
        &registers::registers(spec)?,
        &[
            ("power_on", power_on),
            ("spl_reset", spl.spl_reset),
            ("cfg_valid", spl.spl_rx_cfg_valid),
            ("cfg_offset", mdata0),
            ("cfg_data", data.low(32)),
            ("wr_granted", register_granted),
            ("capability", capability),
        ],
    );

    let received = data.delay(1).named("received");
    let (core_done, core_error) = (wire("core_done", 1), wire("core_error", told.error.bits));
    let (core_read, core_write) = (wire("core_read_answered", 1), wire("core_write_asked", 1));
    let counts =
        [told.contacts, told.invalid, told.first_invalid, told.cycles_busy, told.cycles_input, told.cycles_output];
    let counts: Vec<_> =
        counts.into_iter().chain(told.candidates).map(|port| (port.name, wire(port.name, port.bits))).collect();
    let mut sequence_inputs = vec![
        ("dsm_line", registers.output("dsm_line")),
        ("dsm_valid", registers.output("dsm_valid")),
        ("context_line", registers.output("context_line")),
        ("context_valid", registers.output("context_valid")),
        ("context_written", registers.output("context_written")),
        ("rd_granted", own_read_granted),
        ("read_number", read_number),
        ("rsp_valid", rd_valid),
        ("rsp_mdata", mdata0),
        ("rsp_data", received),
        ("wr_granted", end_granted),
        ("core_done", core_done),
        ("core_error", core_error),
        ("core_read_answered", core_read),
        ("core_write_asked", core_write),
        ("capability", capability),
    ];
    sequence_inputs.extend(counts.iter().copied());
    let sequence = graph.instance("sequencer", &sequence::sequence(spec)?, &sequence_inputs);
    start.drive(sequence.output("start"));

    let [read_epoch, write_epoch] = ["read_epoch", "write_epoch"].map(|name| wire(name, words::SHELL_EPOCH_BITS));
    let core_epoch = wire("core_epoch", EPOCH_BITS);
    let acknowledge = graph.instance(
        "acknowledge",
        &acknowledge::acknowledge(spec)?,
        &[
            ("start", start),
            ("epoch", write_epoch),
            ("valid_0", spl.spl_rx_wr_valid0),
            ("mdata_0", mdata0),
            ("valid_1", spl.spl_rx_wr_valid1),
            ("mdata_1", mdata1),
        ],
    );
    // A response is compared with the epoch before it is passed to the core.
    let core_answered = (rd_valid & is_core_s(mdata0, read_epoch, slot_bits)).delay(1).named("core_answered");
    let (rd_ready, wr_ready) = (wire("core_rd_ready", 1), wire("core_wr_ready", 1));
    let never = graph.constant(1, 0);
    let job = JobInputs::of(spec).map(|port| match port.name {
        "start" => start,
        "epoch" => core_epoch,
        name => sequence.output(name),
    });
    let reads = ReadInputs {
        rd_req_ready: rd_ready,
        rd_rsp_valid: core_answered,
        rd_rsp_tag: mdata0.low(spec.tag_bits()).delay(1),
        rd_rsp_data: received,
        rd_rsp_error: never,
    };
    let writes = WriteInputs {
        wr_req_ready: wr_ready,
        wr_rsp_valid: acknowledge.output("valid"),
        wr_rsp_tag: acknowledge.output("tag"),
        wr_rsp_error: never,
    };
    let core_inputs = [job.named(), reads.named(), writes.named()].concat();
    let core = graph.instance("core", core, &core_inputs);
    let reads = ReadOutputs::of(spec).map(|port| core.output(port.name));
    let writes = WriteOutputs::of(spec).map(|port| core.output(port.name));
    capability.drive(core.output("capability"));
    core_done.drive(core.output("done"));
    core_error.drive(core.output("error"));
    core_read.drive(core_answered);
    core_write.drive(writes.wr_req_valid);
    counts.into_iter().for_each(|(name, wire)| wire.drive(core.output(name)));

    let transmit = graph.instance(
        "transmit",
        &transmit::transmit(spec)?,
        &[
            ("power_on", power_on),
            ("start", start),
            ("rd_almostfull", spl.spl_tx_rd_almostfull),
            ("wr_almostfull", spl.spl_tx_wr_almostfull),
            ("discard", core_error.is(JobError::Watchdog.code().into()).named("core_gave_up")),
            ("core_rd_valid", reads.rd_req_valid),
            ("core_rd_address", reads.rd_req_address),
            ("core_rd_tag", reads.rd_req_tag),
            ("own_rd_valid", sequence.output("rd_valid")),
            ("own_rd_address", sequence.output("rd_address")),
            ("core_wr_valid", writes.wr_req_valid),
            ("core_wr_address", writes.wr_req_address),
            ("core_wr_tag", writes.wr_req_tag),
            ("core_wr_data", writes.wr_req_data),
            ("register_wr_valid", registers.output("wr_valid")),
            ("register_wr_chosen", registers.output("wr_chosen")),
            ("register_wr_address", registers.output("wr_address")),
            ("register_wr_data", registers.output("wr_line")),
            ("end_wr_valid", sequence.output("wr_valid")),
            ("end_wr_fence", sequence.output("wr_fence")),
            ("end_wr_virtual", sequence.output("wr_virtual")),
            ("end_wr_address", sequence.output("wr_address")),
            ("end_wr_data", sequence.output("wr_data")),
        ],
    );
    register_granted.drive(transmit.output("register_wr_granted"));
    end_granted.drive(transmit.output("end_wr_granted"));
    own_read_granted.drive(transmit.output("own_rd_granted"));
    read_number.drive(transmit.output("read_number"));
    read_epoch.drive(transmit.output("read_epoch"));
    write_epoch.drive(transmit.output("write_epoch"));
    core_epoch.drive(transmit.output("core_epoch"));
    rd_ready.drive(transmit.output("core_rd_ready"));
    wr_ready.drive(transmit.output("core_wr_ready"));

    let asked = SplOutputs {
        afu_tx_rd_valid: transmit.output("tx_rd_valid"),
        afu_tx_rd_hdr: transmit.output("tx_rd_hdr"),
        afu_tx_wr_valid: transmit.output("tx_wr_valid"),
        afu_tx_intr_valid: never,
        afu_tx_wr_hdr: transmit.output("tx_wr_hdr"),
        afu_tx_data: transmit.output("tx_data"),
    };
    outputs(&graph, asked.named());
    graph.finish()
}
