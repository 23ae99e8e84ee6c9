"""The host and the memory of a job behind AXI4: masters and RAM of cocotbext-axi, by REGISTERS.md alone."""

import itertools
import logging
import random

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, RisingEdge
from cocotbext.axi import AxiBus, AxiLiteBus, AxiLiteMaster, AxiRam

from registers import IDENTITY, OFFSETS, VERSION

LINE_BYTES = 64
SIZE = 1 << 18
# In the middle of 4 KB, and at its end.
PLACES = [(0x1_0840, 0x2_0000), (0x1_0FC0, 0x2_2FC0)]


class Host:
    """Registers by name."""

    def __init__(self, dut):
        bus = AxiLiteBus.from_prefix(dut, "s_axi_control")
        self.master = AxiLiteMaster(bus, dut.ap_clk, dut.ap_rst_n, reset_active_level=False)

    async def write(self, name, value, words=1):
        await self.master.write(OFFSETS[name], value.to_bytes(4 * words, "little"))

    async def read(self, name, words=1):
        data = await self.master.read(OFFSETS[name], 4 * words)
        return int.from_bytes(data.data, "little")


def pauses(seed, share):
    """A random pattern: true in this share of cycles, in which a channel pauses."""
    chance = random.Random(seed)
    return (chance.random() < share for _ in itertools.count())


def hesitate(host, ram, seed, share):
    """Lets every channel of both buses pause at random."""
    write, read = host.master.write_if, host.master.read_if
    channels = [write.aw_channel, write.w_channel, write.b_channel, read.ar_channel, read.r_channel]
    write, read = ram.write_if, ram.read_if
    channels += [write.aw_channel, write.w_channel, write.b_channel, read.ar_channel, read.r_channel]
    for number, channel in enumerate(channels):
        channel.set_pause_generator(pauses(10 * seed + number, share))


async def begin(dut):
    """Resets the accelerator, and checks which it is. Returns host and memory."""
    logging.getLogger("cocotb").setLevel(logging.WARNING)
    dut.ap_rst_n.value = 0
    cocotb.start_soon(Clock(dut.ap_clk, 10, "ns").start())
    host = Host(dut)
    ram = AxiRam(AxiBus.from_prefix(dut, "m_axi_gmem"), dut.ap_clk, dut.ap_rst_n, reset_active_level=False, size=SIZE)
    await ClockCycles(dut.ap_clk, 16)
    dut.ap_rst_n.value = 1
    await RisingEdge(dut.ap_clk)
    assert f"{await host.read('afu_id', 4):032x}" == IDENTITY, "another accelerator"
    assert await host.read("version") == int(VERSION)
    return host, ram
