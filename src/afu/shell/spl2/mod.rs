//! The shell of Intel HARP v1, as in the paper: the core behind SPL2's port, with the handshake in memory.
//!
//! `registers` answers CSR writes, `sequence` runs jobs, `transmit` and `acknowledge` bring requests to SPL's ports and
//! write responses back; [`map`] says what lies where.

mod acknowledge;
pub mod map;
mod port;
mod registers;
mod sequence;
mod transmit;

use std::sync::Arc;

use crate::config::Results;
use crate::hdl::{BuildErrors, Graph, Module};

use crate::afu::control::{ERROR_BITS, JobError};
use crate::afu::{EPOCH_BITS, MAX_SCPUS, SCPU_BITS, Spec};
use port::{MDATA_BITS, RX_HEADER_BITS, is_core_s};

/// The top `afu_top` around `core`, the module that is the top of the shell `line`.
pub(in crate::afu) fn afu_top(spec: &Spec, core: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("afu_top");
    graph.about("collision-detection accelerator below SPL2 of Intel HARP v1");
    graph.parameter("SCPUS", spec.config.scpus, 1..=MAX_SCPUS, SCPU_BITS);
    let slot_bits = spec.max_outstanding.ilog2();

    let reset_n = graph.input("reset_n", 1);
    let spl_enable = graph.input("spl_enable", 1);
    let spl_reset = graph.input("spl_reset", 1);
    let rd_almostfull = graph.input("spl_tx_rd_almostfull", 1);
    let wr_almostfull = graph.input("spl_tx_wr_almostfull", 1);
    let rd_valid = graph.input("spl_rx_rd_valid", 1);
    let wr_valid0 = graph.input("spl_rx_wr_valid0", 1);
    let cfg_valid = graph.input("spl_rx_cfg_valid", 1);
    graph.input("spl_rx_intr_valid0", 1);
    graph.input("spl_rx_umsg_valid", 1);
    let header0 = graph.input("spl_rx_hdr0", RX_HEADER_BITS);
    let data = graph.input("spl_rx_data", spec.line_bits);
    let wr_valid1 = graph.input("spl_rx_wr_valid1", 1);
    graph.input("spl_rx_intr_valid1", 1);
    let header1 = graph.input("spl_rx_hdr1", RX_HEADER_BITS);

    // Everything but the registers rests until SPL is enabled, and begins anew when it is enabled again.
    graph.reset_by((!reset_n | spl_reset | !spl_enable).delay(1).named("in_reset"));
    let power_on = (!reset_n).named("power_on");
    let mdata0 = header0.low(MDATA_BITS);
    let mdata1 = header1.low(MDATA_BITS);

    let wire = |name: &str, width: u32| graph.wire(name, width);
    let (capability, start) = (wire("capability", 64), wire("start_job", 1));
    let (register_granted, end_granted) = (wire("register_granted", 1), wire("end_granted", 1));
    let (own_read_granted, read_number) = (wire("own_read_granted", 1), wire("own_read_number", port::NUMBER_BITS));
    let registers = graph.instance(
        "registers",
        &registers::registers(spec)?,
        &[
            ("power_on", power_on),
            ("spl_reset", spl_reset),
            ("cfg_valid", cfg_valid),
            ("cfg_offset", mdata0),
            ("cfg_data", data.low(32)),
            ("wr_granted", register_granted),
            ("capability", capability),
        ],
    );

    let received = data.delay(1).named("received");
    let (core_done, core_error) = (wire("core_done", 1), wire("core_error", ERROR_BITS));
    let (core_read, core_write) = (wire("core_read_answered", 1), wire("core_write_asked", 1));
    let counts = ["contacts", "invalid", "first_invalid"].map(|name| (name, wire(name, 32)));
    let cycles = ["cycles_busy", "cycles_input", "cycles_output"].map(|name| (name, wire(name, 64)));
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
    sequence_inputs.extend(counts);
    sequence_inputs.extend(cycles);
    let sequence = graph.instance("sequencer", &sequence::sequence(spec)?, &sequence_inputs);
    start.drive(sequence.output("start"));

    let epoch = wire("epoch", port::SHELL_EPOCH_BITS);
    let core_epoch = wire("core_epoch", EPOCH_BITS);
    let acknowledge = graph.instance(
        "acknowledge",
        &acknowledge::acknowledge(spec)?,
        &[
            ("start", start),
            ("epoch", epoch),
            ("valid_0", wr_valid0),
            ("mdata_0", mdata0),
            ("valid_1", wr_valid1),
            ("mdata_1", mdata1),
        ],
    );
    // What is received is compared with the epoch before the core hears of it.
    let core_answered = (rd_valid & is_core_s(mdata0, epoch, slot_bits)).delay(1).named("core_answered");
    let (rd_ready, wr_ready) = (wire("core_rd_ready", 1), wire("core_wr_ready", 1));
    let never = graph.constant(1, 0);
    let mut core_inputs = vec![
        ("start", start),
        ("source", sequence.output("source")),
        ("destination", sequence.output("destination")),
        ("count", sequence.output("count")),
        ("mode", sequence.output("mode")),
        ("epoch", core_epoch),
        ("watchdog", sequence.output("watchdog")),
        ("abort_job", sequence.output("abort_job")),
        ("rd_req_ready", rd_ready),
        ("rd_rsp_valid", core_answered),
        ("rd_rsp_tag", mdata0.low(EPOCH_BITS + slot_bits).delay(1)),
        ("rd_rsp_data", received),
        ("rd_rsp_error", never),
        ("wr_req_ready", wr_ready),
        ("wr_rsp_valid", acknowledge.output("valid")),
        ("wr_rsp_tag", acknowledge.output("tag")),
        ("wr_rsp_error", never),
    ];
    if spec.config.results == Results::Hits {
        core_inputs.push(("destination_lines", sequence.output("destination_lines")));
    }
    let core = graph.instance("core", core, &core_inputs);
    capability.drive(core.output("capability"));
    core_done.drive(core.output("done"));
    core_error.drive(core.output("error"));
    core_read.drive(core_answered);
    core_write.drive(core.output("wr_req_valid"));
    counts.into_iter().chain(cycles).for_each(|(name, wire)| wire.drive(core.output(name)));

    let transmit = graph.instance(
        "transmit",
        &transmit::transmit(spec)?,
        &[
            ("power_on", power_on),
            ("start", start),
            ("rd_almostfull", rd_almostfull),
            ("wr_almostfull", wr_almostfull),
            ("discard", core_error.is(JobError::Watchdog as u128).named("core_gave_up")),
            ("core_rd_valid", core.output("rd_req_valid")),
            ("core_rd_address", core.output("rd_req_address")),
            ("core_rd_tag", core.output("rd_req_tag")),
            ("own_rd_valid", sequence.output("rd_valid")),
            ("own_rd_address", sequence.output("rd_address")),
            ("core_wr_valid", core.output("wr_req_valid")),
            ("core_wr_address", core.output("wr_req_address")),
            ("core_wr_tag", core.output("wr_req_tag")),
            ("core_wr_data", core.output("wr_req_data")),
            ("register_wr_valid", registers.output("wr_valid")),
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
    epoch.drive(transmit.output("epoch"));
    core_epoch.drive(transmit.output("core_epoch"));
    rd_ready.drive(transmit.output("core_rd_ready"));
    wr_ready.drive(transmit.output("core_wr_ready"));

    graph.output("afu_tx_rd_valid", transmit.output("tx_rd_valid"));
    graph.output("afu_tx_rd_hdr", transmit.output("tx_rd_hdr"));
    graph.output("afu_tx_wr_valid", transmit.output("tx_wr_valid"));
    graph.output("afu_tx_intr_valid", never);
    graph.output("afu_tx_wr_hdr", transmit.output("tx_wr_hdr"));
    graph.output("afu_tx_data", transmit.output("tx_data"));
    graph.finish()
}
