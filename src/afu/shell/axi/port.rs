//! The ports of the shell: an AXI4 master, an AXI4-Lite slave and an interrupt, named as Vitis expects them.

use crate::afu::port::interface;

/// Bits of an address of the AXI4-Lite slave: a page of 4 KB.
pub(super) const REGISTER_ADDRESS_BITS: u32 = 12;
/// Bits of an address of the AXI4 master.
pub(super) const BYTE_ADDRESS_BITS: u32 = 64;

interface! {
    /// Inputs from the host, over AXI4-Lite.
    ControlInputs(_spec) {
        s_axi_control_awvalid: T => 1, "a write address";
        s_axi_control_awaddr: T => REGISTER_ADDRESS_BITS, "byte offset of the register; its low two bits are ignored";
        s_axi_control_wvalid: T => 1, "written data";
        s_axi_control_wdata: T => 32, "the register's value";
        s_axi_control_wstrb: T => 4, "the bytes of it that are written";
        s_axi_control_bready: T => 1, "the host takes the response of a write";
        s_axi_control_arvalid: T => 1, "a read address";
        s_axi_control_araddr: T => REGISTER_ADDRESS_BITS, "byte offset of the register; its low two bits are ignored";
        s_axi_control_rready: T => 1, "the host takes the data of a read";
    }
}

interface! {
    /// Outputs to the host.
    ControlOutputs(_spec) {
        s_axi_control_awready: T => 1, "the write address is taken";
        s_axi_control_wready: T => 1, "the written data are taken";
        s_axi_control_bvalid: T => 1, "the response of a write";
        s_axi_control_bresp: T => 2, "0, OKAY; an offset without a register too";
        s_axi_control_arready: T => 1, "the read address is taken";
        s_axi_control_rvalid: T => 1, "the data of a read";
        s_axi_control_rdata: T => 32, "the register's value; 0 at an offset without a register";
        s_axi_control_rresp: T => 2, "0, OKAY";
        interrupt: T => 1, "high while an enabled event is pending: see REGISTERS.md";
    }
}

interface! {
    /// Inputs from memory, over AXI4.
    MemoryInputs(spec) {
        m_axi_gmem_awready: T => 1, "the write address is taken";
        m_axi_gmem_wready: T => 1, "the written beat is taken";
        m_axi_gmem_bvalid: T => 1, "the response of a write burst";
        m_axi_gmem_bid: T => ID_BITS, "not used: always 0";
        m_axi_gmem_bresp: T => 2, "0 OKAY; 2 SLVERR and 3 DECERR end the job";
        m_axi_gmem_arready: T => 1, "the read address is taken";
        m_axi_gmem_rvalid: T => 1, "a beat of a read burst";
        m_axi_gmem_rid: T => ID_BITS, "not used: always 0";
        m_axi_gmem_rdata: T => spec.config.bus, "the beat; byte i is bits 8·i+7 to 8·i";
        m_axi_gmem_rresp: T => 2, "0 OKAY; 2 SLVERR and 3 DECERR end the job";
        m_axi_gmem_rlast: T => 1, "the last beat of its burst";
    }
}

interface! {
    /// Outputs to memory.
    MemoryOutputs(spec) {
        m_axi_gmem_awvalid: T => 1, "a write burst; it stays as it is until ready";
        m_axi_gmem_awid: T => ID_BITS, "0";
        m_axi_gmem_awaddr: T => BYTE_ADDRESS_BITS, "byte address of the burst, a multiple of 64";
        m_axi_gmem_awlen: T => 8, "beats of the burst, less one";
        m_axi_gmem_awsize: T => 3, SIZE;
        m_axi_gmem_awburst: T => 2, "1, INCR";
        m_axi_gmem_awlock: T => 1, "0";
        m_axi_gmem_awcache: T => 4, CACHE;
        m_axi_gmem_awprot: T => 3, PROTECTION;
        m_axi_gmem_awqos: T => 4, "0";
        m_axi_gmem_wvalid: T => 1, "a beat of a write burst; it stays as it is until ready";
        m_axi_gmem_wdata: T => spec.config.bus, "the beat; byte i is bits 8·i+7 to 8·i";
        m_axi_gmem_wstrb: T => spec.config.bus / 8, "all ones";
        m_axi_gmem_wlast: T => 1, "the last beat of its burst";
        m_axi_gmem_bready: T => 1, "1: there is room for the response of every burst";
        m_axi_gmem_arvalid: T => 1, "a read burst; it stays as it is until ready";
        m_axi_gmem_arid: T => ID_BITS, "0";
        m_axi_gmem_araddr: T => BYTE_ADDRESS_BITS, "byte address of the burst, a multiple of 64";
        m_axi_gmem_arlen: T => 8, "beats of the burst, less one";
        m_axi_gmem_arsize: T => 3, SIZE;
        m_axi_gmem_arburst: T => 2, "1, INCR";
        m_axi_gmem_arlock: T => 1, "0";
        m_axi_gmem_arcache: T => 4, CACHE;
        m_axi_gmem_arprot: T => 3, PROTECTION;
        m_axi_gmem_arqos: T => 4, "0";
        m_axi_gmem_rready: T => 1, "1: there is room for every line that was asked for";
    }
}

/// Bits of an AXI ID.
const ID_BITS: u32 = 1;
const SIZE: &str = "bytes of a beat, as a power of two: the width of the bus";
const CACHE: &str = "3: normal memory, not cacheable, bufferable";
const PROTECTION: &str = "0: data, secure, unprivileged";
