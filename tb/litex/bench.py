"""Drives a SoC of LiteX from its UART bridge to the first contact, by PORTS.md and REGISTERS.md of the accelerator."""

import json
import logging
import os
import random
from pathlib import Path

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, FallingEdge, Timer, with_timeout

from records import PAIRS, expected, pack
from registers import IDENTITY, OFFSETS, VERSION, bit

FACTS = json.loads(Path(os.environ["SOC_FACTS"]).read_text(encoding="utf-8"))
LINE_BYTES = 64
WRITE, READ = 1, 2
CLOCK_NS = 10
# Words of an access, which the bridge's protocol counts in a byte.
MOST_WORDS = 16


class Bridge:
    """LiteX's UART bridge: a command, the number of words, the address of the first, then words; bytes big-endian."""

    def __init__(self, dut):
        self.dut = dut
        dut.serial_rx.value = 1

    async def bits(self, number):
        await Timer(number * FACTS["cycles_per_bit"] * CLOCK_NS, "ns")

    async def send(self, data):
        for byte in data:
            for value in [0, *(byte >> number & 1 for number in range(8)), 1]:
                self.dut.serial_rx.value = value
                await self.bits(1)

    async def receive(self, count):
        data = bytearray()
        for _ in range(count):
            await with_timeout(FallingEdge(self.dut.serial_tx), 200, "us")
            await self.bits(0.5)
            byte = 0
            for number in range(8):
                await self.bits(1)
                byte |= int(self.dut.serial_tx.value) << number
            await self.bits(1)
            data.append(byte)
        return bytes(data)

    async def write(self, address, words):
        for first in range(0, len(words), MOST_WORDS):
            chunk = words[first : first + MOST_WORDS]
            head = bytes([WRITE, len(chunk)]) + (address // 4 + first).to_bytes(4, "big")
            await self.send(head + b"".join(word.to_bytes(4, "big") for word in chunk))

    async def read(self, address, count):
        words = []
        while len(words) < count:
            chunk = min(MOST_WORDS, count - len(words))
            reply = cocotb.start_soon(self.receive(4 * chunk))
            await self.send(bytes([READ, chunk]) + (address // 4 + len(words)).to_bytes(4, "big"))
            data = await reply
            words += [int.from_bytes(data[at : at + 4], "big") for at in range(0, len(data), 4)]
        return words


def words(lines):
    """Lines as words of 32 bits, as memory has them."""
    return [line >> 32 * number & 0xFFFFFFFF for line in lines for number in range(LINE_BYTES // 4)]


@cocotb.test()
async def from_the_bridge_to_the_first_contact(dut):
    logging.getLogger("cocotb").setLevel(logging.WARNING)
    dut.sys_rst.value = 1
    cocotb.start_soon(Clock(dut.sys_clk, CLOCK_NS, "ns").start())
    bridge = Bridge(dut)
    await ClockCycles(dut.sys_clk, 20)
    dut.sys_rst.value = 0
    await ClockCycles(dut.sys_clk, 20)

    async def write(name, *values):
        await bridge.write(FACTS["registers"] + OFFSETS[name], list(values))

    async def read(name, count=1):
        return await bridge.read(FACTS["registers"] + OFFSETS[name], count)

    identity = await read("afu_id", 4)
    assert f"{sum(word << 32 * number for number, word in enumerate(identity)):032x}" == IDENTITY, "another accelerator"
    assert await read("version") == [int(VERSION)]
    await write("scratch", 0x1234ABCD)
    assert await read("scratch") == [0x1234ABCD]

    # Pairs from the middle of 4 KB on, and results where memory has other words.
    pairs = PAIRS
    source, destination = FACTS["memory"] + 0x840, FACTS["memory"] + 0x1000
    wanted = words(expected(pairs))
    await bridge.write(source, words(pack(pairs, random.Random(1))))
    await bridge.write(destination, [0xA5A5A5A5] * (len(wanted) + 1))
    await write("source", source, 0)
    await write("destination", destination, 0)
    await write("count", len(pairs), 64, 0, 10000)
    await write("interrupt_enable", bit("interrupt_enable", "done"))
    await write("global_interrupt_enable", bit("global_interrupt_enable", "enable"))
    await write("control", bit("control", "ap_start"))
    status = 0
    for _ in range(20):
        (status,) = await read("status")
        if status & bit("status", "done"):
            break
    assert status == bit("status", "done"), f"status {status:#x}"
    assert dut.done.value == 1, "no interrupt"
    found = await bridge.read(destination, len(wanted) + 1)
    for number, word in enumerate(wanted):
        assert found[number] == word, f"word {number}: {found[number]:#x}, not {word:#x}"
    assert found[-1] == 0xA5A5A5A5, "a write beside the destination"
    assert await read("unasked") == [0]
