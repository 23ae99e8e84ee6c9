"""Drives jobs behind AXI4 with the masters and the memory of cocotbext-axi, by PORTS.md and REGISTERS.md alone."""

import random

import cocotb
from cocotb.triggers import RisingEdge, with_timeout

from host import LINE_BYTES, PLACES, begin, hesitate
from records import PAIRS, answer, expected, pack
from registers import bit


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
    host, ram = await begin(dut)
    for seed, pairs in enumerate([PAIRS[:1], [], PAIRS, PAIRS * 20, PAIRS[::-1] * 9]):
        hesitate(host, ram, seed, 0.4 if seed else 0)
        await job(dut, host, ram, pairs, PLACES[seed % 2], seed % 2 == 0)
