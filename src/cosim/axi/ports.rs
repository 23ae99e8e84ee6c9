//! The ports of the `axi` shell.

use crate::afu::Spec;
use crate::afu::shell::axi::{ControlInputs, ControlOutputs, MemoryInputs, MemoryOutputs};
use crate::config::Config;
use crate::cosim::error::SimulationError;
use crate::cosim::instance::Instance;
use crate::cosim::port::Port;
use crate::link::axi::{Address, FromMemory, LiteMaster, LiteSlave, ToMemory, WriteBeat};

/// The AFU's ports, fetched once.
#[derive(Debug)]
pub(super) struct Ports<'a> {
    /// Bits of the bus.
    pub(super) bus: u32,
    reset_n: Port<'a>,
    from_host: ControlInputs<Port<'a>>,
    to_host: ControlOutputs<Port<'a>>,
    from_memory: MemoryInputs<Port<'a>>,
    to_memory: MemoryOutputs<Port<'a>>,
}

impl<'a> Ports<'a> {
    pub(super) fn new(afu: &'a Instance) -> Result<Self, SimulationError> {
        let mut spec = Spec::from(Config::default());
        // A bus of another width is refused below: its port has another width than any AFU's.
        let data = afu.port_list().into_iter().find(|(name, ..)| name == "m_axi_gmem_rdata").map(|(_, bits, _)| bits);
        if let Some(bits) = data.filter(|bits| crate::config::BUSES.contains(bits)) {
            spec.config.bus = bits;
        }
        let ports = Self {
            bus: spec.config.bus,
            reset_n: afu.input("ap_rst_n", 1)?,
            from_host: ControlInputs::of(&spec).try_map(|port| afu.input(port.name, port.bits))?,
            to_host: ControlOutputs::of(&spec).try_map(|port| afu.output(port.name, port.bits))?,
            from_memory: MemoryInputs::of(&spec).try_map(|port| afu.input(port.name, port.bits))?,
            to_memory: MemoryOutputs::of(&spec).try_map(|port| afu.output(port.name, port.bits))?,
        };
        ports.from_memory.m_axi_gmem_bid.set(0);
        ports.from_memory.m_axi_gmem_rid.set(0);
        Ok(ports)
    }

    pub(super) fn reset(&self, active: bool) {
        self.reset_n.set((!active).into());
    }

    pub(super) fn interrupt(&self) -> bool {
        self.to_host.interrupt.is_high()
    }

    /// The AFU's outputs to memory in this cycle.
    #[inline]
    pub(super) fn to_memory(&self) -> ToMemory {
        let afu = &self.to_memory;
        let aw = afu.m_axi_gmem_awvalid.is_high().then(|| Address {
            id: afu.m_axi_gmem_awid.get() as u8,
            address: afu.m_axi_gmem_awaddr.get(),
            length: afu.m_axi_gmem_awlen.get() as u8,
            size: afu.m_axi_gmem_awsize.get() as u8,
            burst: afu.m_axi_gmem_awburst.get() as u8,
            lock: afu.m_axi_gmem_awlock.get() as u8,
            cache: afu.m_axi_gmem_awcache.get() as u8,
            prot: afu.m_axi_gmem_awprot.get() as u8,
            qos: afu.m_axi_gmem_awqos.get() as u8,
        });
        let ar = afu.m_axi_gmem_arvalid.is_high().then(|| Address {
            id: afu.m_axi_gmem_arid.get() as u8,
            address: afu.m_axi_gmem_araddr.get(),
            length: afu.m_axi_gmem_arlen.get() as u8,
            size: afu.m_axi_gmem_arsize.get() as u8,
            burst: afu.m_axi_gmem_arburst.get() as u8,
            lock: afu.m_axi_gmem_arlock.get() as u8,
            cache: afu.m_axi_gmem_arcache.get() as u8,
            prot: afu.m_axi_gmem_arprot.get() as u8,
            qos: afu.m_axi_gmem_arqos.get() as u8,
        });
        let w = afu.m_axi_gmem_wvalid.is_high().then(|| WriteBeat {
            data: afu.m_axi_gmem_wdata.words(),
            strobes: afu.m_axi_gmem_wstrb.get(),
            last: afu.m_axi_gmem_wlast.is_high(),
        });
        let (b_ready, r_ready) = (afu.m_axi_gmem_bready.is_high(), afu.m_axi_gmem_rready.is_high());
        ToMemory { aw, w, ar, b_ready, r_ready }
    }

    /// Sets the AFU's inputs from memory in this cycle. Without a VALID, data keep their old values, which the AFU must
    /// ignore.
    #[inline]
    pub(super) fn drive_memory(&self, memory: &FromMemory) {
        let afu = &self.from_memory;
        afu.m_axi_gmem_awready.set(memory.aw_ready.into());
        afu.m_axi_gmem_wready.set(memory.w_ready.into());
        afu.m_axi_gmem_arready.set(memory.ar_ready.into());
        afu.m_axi_gmem_bvalid.set(memory.b.is_some().into());
        afu.m_axi_gmem_rvalid.set(memory.r.is_some().into());
        if let Some(response) = memory.b {
            afu.m_axi_gmem_bresp.set(response.into());
        }
        if let Some(beat) = &memory.r {
            afu.m_axi_gmem_rdata.set_words(&beat.data);
            afu.m_axi_gmem_rresp.set(beat.response.into());
            afu.m_axi_gmem_rlast.set(beat.last.into());
        }
    }

    /// The AFU's outputs to the host in this cycle.
    #[inline]
    pub(super) fn to_host(&self) -> LiteSlave {
        let afu = &self.to_host;
        let b = afu.s_axi_control_bvalid.is_high().then(|| afu.s_axi_control_bresp.get() as u8);
        let r = afu
            .s_axi_control_rvalid
            .is_high()
            .then(|| (afu.s_axi_control_rdata.get() as u32, afu.s_axi_control_rresp.get() as u8));
        LiteSlave {
            aw_ready: afu.s_axi_control_awready.is_high(),
            w_ready: afu.s_axi_control_wready.is_high(),
            b,
            ar_ready: afu.s_axi_control_arready.is_high(),
            r,
        }
    }

    /// Sets the AFU's inputs from the host in this cycle.
    #[inline]
    pub(super) fn drive_host(&self, host: &LiteMaster) {
        let afu = &self.from_host;
        afu.s_axi_control_awvalid.set(host.aw.is_some().into());
        afu.s_axi_control_wvalid.set(host.w.is_some().into());
        afu.s_axi_control_arvalid.set(host.ar.is_some().into());
        afu.s_axi_control_bready.set(host.b_ready.into());
        afu.s_axi_control_rready.set(host.r_ready.into());
        if let Some(offset) = host.aw {
            afu.s_axi_control_awaddr.set(offset.into());
        }
        if let Some((data, strobes)) = host.w {
            afu.s_axi_control_wdata.set(data.into());
            afu.s_axi_control_wstrb.set(strobes.into());
        }
        if let Some(offset) = host.ar {
            afu.s_axi_control_araddr.set(offset.into());
        }
    }
}
