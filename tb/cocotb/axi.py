"""Drives jobs behind AXI4 with the masters and the memory of cocotbext-axi, by PORTS.md and REGISTERS.md alone."""

import itertools
import logging
import random

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, RisingEdge, with_timeout
from cocotbext.axi import AxiBus, AxiLiteBus, AxiLiteMaster, AxiRam

from records import PAIRS, answer, expected, pack
from registers import IDENTITY, OFFSETS, VERSION, bit

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


async def job(dut, host, ram, pairs, place, by_interrupt):
    """The steps of a job, as REGISTERS.md has them."""
    source, destination = place
    lines = b"".join(line.to_bytes(LINE_BYTES, "little") for line in pack(pairs, random.Random(len(pairs))))
    wanted = b"".join(line.to_bytes(LINE_BYTES, "little") for line in expected(pairs))
    around = bytes([0xA5]) * LINE_BYTES
    ram.write(source, lines)
    ram.write(destination - LINE_BYTES, around * (len(wanted) // LINE_BYTES + 2))
    await host.write("source", source, 2)
    await host.write("destination", destination, 2)
    await host.write("count", len(pairs))
    await host.write("destination_lines", 1000)
    await host.write("mode", 0)
    await host.write("watchdog", 10000)
    if by_interrupt:
        await host.write("interrupt_enable", bit("interrupt_enable", "done"))
        await host.write("global_interrupt_enable", bit("global_interrupt_enable", "enable"))
    await host.write("control", bit("control", "ap_start"))
    if by_interrupt:
        if not dut.interrupt.value:
            await with_timeout(RisingEdge(dut.interrupt), 1, "ms")
        await host.write("interrupt_status", bit("interrupt_status", "done"))
        await host.write("global_interrupt_enable", 0)
    for _ in range(1000):
        status = await host.read("status")
        if status & bit("status", "done"):
            break
    assert status == bit("status", "done"), f"status {status:#x}"
    ways = [answer(pair)[1] for pair in pairs]
    invalid = [number for number, way in enumerate(ways) if way == "invalid pair"]
    assert await host.read("contacts") == sum(way.startswith("contact") for way in ways)
    assert await host.read("invalid") == len(invalid)
    assert await host.read("first_invalid") == (invalid[0] if invalid else 0xFFFFFFFF)
    wrote = ram.read(destination - LINE_BYTES, len(wanted) + 2 * LINE_BYTES)
    assert wrote[:LINE_BYTES] == wrote[-LINE_BYTES:] == around, "a write beside the destination"
    for at in range(0, len(wanted), LINE_BYTES):
        line = wrote[at + LINE_BYTES : at + 2 * LINE_BYTES]
        assert line == wanted[at : at + LINE_BYTES], f"line {at // LINE_BYTES}: {line.hex()}"


@cocotb.test()
async def jobs(dut):
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
    for seed, pairs in enumerate([PAIRS[:1], [], PAIRS, PAIRS * 20, PAIRS[::-1] * 9]):
        hesitate(host, ram, seed, 0.4 if seed else 0)
        await job(dut, host, ram, pairs, PLACES[seed % 2], seed % 2 == 0)
