//! SPL2's ports, of Intel HARP v1.

use super::words::{RX_HEADER_BITS, TX_HEADER_BITS};
use crate::afu::port::interface;

interface! {
    /// Inputs from SPL.
    SplInputs(spec) {
        reset_n: T => 1, "the system's reset, active low; at least one cycle";
        spl_enable: T => 1, "low: everything but the registers rests, as in reset";
        spl_reset: T => 1, "reset, active high: a job that runs is forgotten";
        spl_tx_rd_almostfull: T => 1, "SPL's queue of reads is almost full: at most two reads follow";
        spl_tx_wr_almostfull: T => 1, "SPL's queue of writes is almost full: at most two writes follow";
        spl_rx_rd_valid: T => 1, "a read response, in any order; never refused";
        spl_rx_wr_valid0: T => 1, WRITE_RESPONSE;
        spl_rx_cfg_valid: T => 1, "a CSR write: header 13:0 its byte offset / 4, data 31:0 its value";
        spl_rx_intr_valid0: T => 1, NOT_USED;
        spl_rx_umsg_valid: T => 1, NOT_USED;
        spl_rx_hdr0: T => RX_HEADER_BITS, RX_HEADER;
        spl_rx_data: T => spec.line_bits, "the line, or the register's value";
        spl_rx_wr_valid1: T => 1, WRITE_RESPONSE;
        spl_rx_intr_valid1: T => 1, NOT_USED;
        spl_rx_hdr1: T => RX_HEADER_BITS, RX_HEADER;
    }
}

interface! {
    /// Outputs to SPL.
    SplOutputs(spec) {
        afu_tx_rd_valid: T => 1, "a read request, taken in this cycle";
        afu_tx_rd_hdr: T => TX_HEADER_BITS,
            "98:93 lines (1), 92:67 and 45:14 line address, 66 virtual, 55:52 type (4), 13:0 mdata";
        afu_tx_wr_valid: T => 1, "a write request or a fence, taken in this cycle";
        afu_tx_intr_valid: T => 1, "an interrupt: never";
        afu_tx_wr_hdr: T => TX_HEADER_BITS, "as `afu_tx_rd_hdr`; type 2 a line, 5 a fence";
        afu_tx_data: T => spec.line_bits, "the line";
    }
}

const WRITE_RESPONSE: &str = "a write response, in any order, on both channels if need be";
const RX_HEADER: &str = "17:14 type, 13:0 mdata of the request";
const NOT_USED: &str = "not used";
