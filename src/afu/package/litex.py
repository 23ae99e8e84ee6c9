# SPDX-License-Identifier: MIT OR Apache-2.0
# @ORIGIN@
"""The accelerator @TOP@ as a module of LiteX, with its AXI4-Lite slave and its AXI4 master.

In a SoC, with this folder on Python's path:

    from @FILE@ import ContactAfu

    self.contact_afu = ContactAfu(platform)
    self.contact_afu.connect(self, origin=0x9000_0000)

Registers are then in 4 KB from the origin on, as in REGISTERS.md, and the accelerator reads and writes memory at the
addresses of the SoC's bus. For more bandwidth, leave `connect` out: connect `control` alone to the bus, and `memory` to
a port of memory that is as wide as it.

LiteX's bridges from AXI4 to Wishbone and AXI4-Lite do not pass errors on: an access of an address without memory is
then answered as if all were well. Caches of a CPU are not coherent with the master.
"""

from pathlib import Path

from migen import ClockSignal, Instance, ResetSignal, Signal

from litex.gen import LiteXModule
from litex.soc.integration.soc import SoCRegion
from litex.soc.interconnect import axi
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourceLevel

FOLDER = Path(__file__).resolve().parent
# Bits of the master, of an address that it puts out, and of an address of the registers.
BUS_BITS = @BUS@
MASTER_ADDRESS_BITS = 64
REGISTER_ADDRESS_BITS = 12
# A burst has at most this many bits.
BURST_BITS = @BURST_LINES@ * 512
# Beats that a burst can have, by AXI4.
MOST_BEATS = 256


class ContactAfu(LiteXModule):
    """`control` is the AXI4-Lite slave, `memory` the AXI4 master, `interrupt` a level; `ev` tells a CPU of it."""

    def __init__(self, platform, @ARGUMENT@address_width=32):
        self.control = axi.AXILiteInterface(data_width=32, address_width=address_width)
        self.memory = axi.AXIInterface(data_width=BUS_BITS, address_width=address_width, id_width=1)
        self.interrupt = Signal()
        self.ev = EventManager()
        self.ev.done = EventSourceLevel()
        self.ev.finalize()
        self.comb += self.ev.done.trigger.eq(self.interrupt)

        control, memory = self.control, self.memory
        awaddr, araddr = Signal(MASTER_ADDRESS_BITS), Signal(MASTER_ADDRESS_BITS)
        self.comb += [memory.aw.addr.eq(awaddr), memory.ar.addr.eq(araddr)]
        ports = {
            "i_ap_clk": ClockSignal("sys"),
            "i_ap_rst_n": ~ResetSignal("sys"),
            "o_interrupt": self.interrupt,
            "i_s_axi_control_awaddr": control.aw.addr[:REGISTER_ADDRESS_BITS],
            "i_s_axi_control_wdata": control.w.data,
            "i_s_axi_control_wstrb": control.w.strb,
            "o_s_axi_control_bresp": control.b.resp,
            "i_s_axi_control_araddr": control.ar.addr[:REGISTER_ADDRESS_BITS],
            "o_s_axi_control_rdata": control.r.data,
            "o_s_axi_control_rresp": control.r.resp,
            "o_m_axi_gmem_awaddr": awaddr,
            "o_m_axi_gmem_wdata": memory.w.data,
            "o_m_axi_gmem_wstrb": memory.w.strb,
            "o_m_axi_gmem_wlast": memory.w.last,
            "i_m_axi_gmem_bid": memory.b.id,
            "i_m_axi_gmem_bresp": memory.b.resp,
            "o_m_axi_gmem_araddr": araddr,
            "i_m_axi_gmem_rid": memory.r.id,
            "i_m_axi_gmem_rdata": memory.r.data,
            "i_m_axi_gmem_rresp": memory.r.resp,
            "i_m_axi_gmem_rlast": memory.r.last,
        }
        for channel in ["aw", "ar"]:
            signals = getattr(memory, channel)
            for name in ["id", "len", "size", "burst", "lock", "cache", "prot", "qos"]:
                ports[f"o_m_axi_gmem_{channel}{name}"] = getattr(signals, name)
        # The master drives address and data, and is driven responses; the slave is the other way round.
        for channel in ["aw", "w", "ar", "b", "r"]:
            is_request = channel in ("aw", "w", "ar")
            buses = [(memory, "m_axi_gmem", is_request), (control, "s_axi_control", not is_request)]
            for interface, prefix, drives in buses:
                signals = getattr(interface, channel)
                valid, ready = ("o", "i") if drives else ("i", "o")
                ports[f"{valid}_{prefix}_{channel}valid"] = signals.valid
                ports[f"{ready}_{prefix}_{channel}ready"] = signals.ready
        self.specials += Instance("@TOP@", @PARAMETER@**ports)

        for line in (FOLDER / "@LIST@").read_text(encoding="utf-8").splitlines():
            if line and not line.startswith("//"):
                platform.add_source(str(FOLDER / line))

    def connect(self, soc, origin, name="contact_afu"):
        """Puts the registers into 4 KB of the SoC's bus, and lets the accelerator master that bus."""
        beats = BURST_BITS // soc.bus.data_width
        if beats > MOST_BEATS:
            raise ValueError(
                f"a burst would be {beats} beats of the SoC's bus, and AXI4 allows {MOST_BEATS}: "
                "generate the accelerator with a smaller --outstanding, or the SoC with a wider bus"
            )
        region = SoCRegion(origin=origin, size=1 << REGISTER_ADDRESS_BITS, cached=False)
        soc.bus.add_slave(name, self.control, region)
        soc.bus.add_master(name, self.memory)
