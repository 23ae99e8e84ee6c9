"""Drives jobs of spheres behind AXI4 with what others wrote (cocotbext-axi), by PORTS.md and REGISTERS.md alone."""

import math
import os
import random
import re
import struct
from pathlib import Path

import cocotb

from host import LINE_BYTES, PLACES, begin, hesitate
from registers import FIELDS, bit, rows

TEXT = Path(os.environ["AFU_PORTS"]).read_text(encoding="utf-8")
NAN = float("nan")
ROW = int(re.search(r"rows of (\d+) spheres", TEXT).group(1))
SPHERE_BYTES = int(re.search(r"A sphere is (\d+) bits", TEXT).group(1)) // 8
RECORD_BYTES = int(re.search(r"A record is (\d+) bits", TEXT).group(1)) // 8
MOST = int(re.search(r"first set has at most (\d+) spheres", TEXT).group(1))
TOO_LARGE = int(re.search(r"otherwise the job ends with error (\d+)", TEXT).group(1))
ADVICE = {what: int(code) for code, what, *_ in rows("error")}


def places(heading):
    """Names and lowest bits of a record's words."""
    table = TEXT.split(f"| {heading} |", 1)[1].split("\n\n", 1)[0].rstrip()
    cells = [[cell.strip().strip("`") for cell in row.strip("| ").split("|")] for row in table.split("\n")[2:]]
    return {name: int(bits.partition(":")[2]) for bits, name, *_ in cells if name}


OF_SPHERE, OF_RECORD = places("bits of a sphere"), places("bits of a record")


def touch(one, other):
    """Distances are exact: small multiples of a half."""
    return math.dist(one[:3], other[:3]) <= one[3] + other[3]


def valid(sphere):
    return all(map(math.isfinite, sphere)) and sphere[3] >= 0


def pack(spheres, junk):
    """The lines of a set, with random bits behind its last sphere."""
    whole = b""
    for values in spheres:
        words = dict(zip("xyzr", values))
        bits = sum(struct.unpack("<I", struct.pack("<f", words[name]))[0] << low for name, low in OF_SPHERE.items())
        whole += bits.to_bytes(SPHERE_BYTES, "little")
    return whole + junk.randbytes(-len(spheres) % ROW * SPHERE_BYTES)


def hits(first, second):
    """The pairs that touch, in the order of PORTS.md; `second` is None for one set."""
    others = first if second is None else second
    pairs = [(i, j) for j in range(len(others)) for i in range(len(first) if second is not None else j)]
    pairs = [(i, j) for i, j in pairs if valid(first[i]) and valid(others[j]) and touch(first[i], others[j])]
    return sorted(pairs, key=lambda pair: (pair[1] // ROW, pair[0] // ROW, pair[1], pair[0]))


def expected(pairs):
    """The lines of the contacts; what is behind the last is zero."""
    whole = b""
    for first, second in pairs:
        record = (first << OF_RECORD["first"]) | (second << OF_RECORD["second"])
        whole += record.to_bytes(RECORD_BYTES, "little")
    return whole + bytes(-len(whole) % LINE_BYTES)


async def run(host, place, count, others, mode, lines):
    """The steps of a job, as REGISTERS.md has them. Returns its error."""
    await host.write("source", place[0], 2)
    await host.write("destination", place[1], 2)
    await host.write("destination_lines", lines)
    await host.write("count", count)
    await host.write("others", others)
    await host.write("mode", mode)
    await host.write("watchdog", 10000)
    await host.write("control", bit("control", "ap_start"))
    for _ in range(5000):
        status = await host.read("status")
        if status & bit("status", "done"):
            return status >> FIELDS["status", "error"] & 0xF
    raise AssertionError("the job does not end")


async def job(host, ram, place, first, second, keeps=False, lines=None):
    """A job whose results are compared. With `keeps` the first set is still in the table."""
    junk = random.Random(len(first))
    source = (b"" if keeps else pack(first, junk)) + (b"" if second is None else pack(second, junk))
    wanted = expected(hits(first, second))
    room = len(wanted) // LINE_BYTES if lines is None else lines
    around = bytes([0xA5]) * LINE_BYTES
    ram.write(place[0], source)
    ram.write(place[1] - LINE_BYTES, around * (room + 2))
    mode = 0 if second is None else 2 if keeps else 1
    error = await run(host, place, 0 if keeps else len(first), len(second or []), mode, room)
    sent = ([] if keeps else first) + (second or [])
    invalid = [number for number, sphere in enumerate(sent) if not valid(sphere)]
    assert await host.read("contacts") == len(hits(first, second))
    assert await host.read("candidates") >= len(hits(first, second))
    assert await host.read("invalid") == len(invalid)
    assert await host.read("first_invalid") == (invalid[0] if invalid else 0xFFFFFFFF)
    wrote = ram.read(place[1] - LINE_BYTES, (room + 2) * LINE_BYTES)
    assert wrote[:LINE_BYTES] == wrote[-LINE_BYTES:] == around, "a write beside the destination"
    fits = wanted[: room * LINE_BYTES]
    assert wrote[LINE_BYTES : LINE_BYTES + len(fits)] == fits, "another record"
    return error


@cocotb.test()
async def jobs(dut):
    host, ram = await begin(dut)
    grid = [(0.5 * (place % 7), 0.5 * (place // 7), 0, 0.25) for place in range(50)]
    odd = grid[:5] + [(NAN, 0, 0, 1), (0, 0, 0, -1)] + grid[5:18] + [(1, 1, 0.5, -0.0), (1.5, 1, 2, 2)]
    probes = [(0.5 * place, 1, 0.5, 0.5) for place in range(20)]
    sets = [(grid[:2], None), ([], None), (odd, None), (grid, probes), (odd, grid[:17])]
    for seed, (first, second) in enumerate(sets):
        hesitate(host, ram, seed, 0.4 if seed else 0)
        assert await job(host, ram, PLACES[seed % 2], first, second) == 0
        # Against the table that stays.
        assert await job(host, ram, PLACES[seed % 2], first, probes[:9], keeps=True) == 0
    # Too little room: what fits is written, and all are counted.
    error = await job(host, ram, PLACES[0], grid, None, lines=2)
    assert error == ADVICE["more contacts than the destination has lines for"]
    assert await run(host, PLACES[0], MOST + 1, 0, 0, 1) == TOO_LARGE
    assert await run(host, PLACES[0], 1, 1, 3, 1) == ADVICE["unknown mode"]
    assert await job(host, ram, PLACES[1], odd, None) == 0
