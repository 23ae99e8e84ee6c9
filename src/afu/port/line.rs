//! The core's ports for memory: requests and responses of reads and writes, one line each.

use super::interface;
use crate::afu::{ADDRESS_BITS, JobError};

interface! {
    /// The responses to reads.
    ReadInputs(spec) {
        rd_req_ready: T => 1, READY;
        rd_rsp_valid: T => 1, "a read response, in any order; never refused";
        rd_rsp_tag: T => spec.tag_bits(), RESPONSE_TAG;
        rd_rsp_data: T => spec.line_bits, DATA;
        rd_rsp_error: T => 1,
            format!("the line could not be read: the job ends with error {}", JobError::Read.code());
    }
}

interface! {
    /// The responses to writes.
    WriteInputs(spec) {
        wr_req_ready: T => 1, READY;
        wr_rsp_valid: T => 1, "a write acknowledgement, in any order; never refused";
        wr_rsp_tag: T => spec.tag_bits(), RESPONSE_TAG;
        wr_rsp_error: T => 1,
            format!("the line could not be written: the job ends with error {}", JobError::Write.code());
    }
}

interface! {
    /// Read requests.
    ReadOutputs(spec) {
        rd_req_valid: T => 1, "a read request; it stays as it is until ready";
        rd_req_address: T => ADDRESS_BITS, "line address to read";
        rd_req_tag: T => spec.tag_bits(), REQUEST_TAG;
    }
}

interface! {
    /// Write requests.
    WriteOutputs(spec) {
        wr_req_valid: T => 1, "a write request; it stays as it is until ready";
        wr_req_address: T => ADDRESS_BITS, "line address to write";
        wr_req_tag: T => spec.tag_bits(), REQUEST_TAG;
        wr_req_data: T => spec.line_bits, DATA;
    }
}

const READY: &str = "the request is taken at this clock edge";
const REQUEST_TAG: &str = "epoch and slot; not used again before its response";
const RESPONSE_TAG: &str = "the tag of its request";
const DATA: &str = "the line";
