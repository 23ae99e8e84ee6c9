"""Drives a job on the line port and checks it against PORTS.md."""

import math
import os
import random
from pathlib import Path

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, RisingEdge

from ports import Ports

PORTS = Ports(Path(os.environ["AFU_PORTS"]).read_text(encoding="utf-8"))
SOURCE, DESTINATION, ROOM = 0x123456789AB, 0x3FF00000000, 1000
NAN = float("nan")

# x1 y1 z1 r1 x2 y2 z2 r2; distances are powers of two, so that every result is exact.
PAIRS = [
    (0, 0, 0, 1, 1, 0, 0, 1),
    (0, 0, 0, 1, 4, 0, 0, 1),
    (1, 2, 3, 0.5, 1, 2, 3, 0.25),
    (0, 0, 0, 1, 0, 2, 0, 1),
    (0, 0, 0, -1, 0, 0, 1, 1),
    (3, 0, 0, 0.5, 3, 0, 0.5, 2),
    (NAN, 0, 0, 1, 0, 0, 0, 1),
    (-1, -1, -1, 2, -1, 1, -1, 4),
    (0, 0, 0, -0.0, 0, 0, 1, 1),
]


def answer(pair):
    """The expected results by the words' names, and the flow by the meaning of its flags."""
    p1, r1, p2, r2 = pair[0:3], pair[3], pair[4:7], pair[7]
    none = dict.fromkeys(["pos_x", "pos_y", "pos_z", "normal_x", "normal_y", "normal_z", "depth"], 0)
    if not all(map(math.isfinite, pair)) or r1 < 0 or r2 < 0:
        return none, "invalid pair"
    d = math.dist(p1, p2)
    if d > r1 + r2:
        return none, "no contact"
    if d == 0:
        normal, position, way = (1, 0, 0), p1, "contact, coincident centres"
    else:
        normal, way = [(a - b) / d for a, b in zip(p1, p2)], "contact"
        position = [a + n * ((r2 - r1) - d) / 2 for a, n in zip(p1, normal)]
    words = dict(zip(none, [*position, *normal, r1 + r2 - d]))
    return words, way


def pack(pairs, junk):
    """Source lines, with random bits in their unused parts."""
    lines = []
    for first in range(0, len(pairs), PORTS.pairs_per_line):
        line = junk.getrandbits(PORTS.line_bits)
        for place, pair in enumerate(pairs[first : first + PORTS.pairs_per_line]):
            at = place * PORTS.pair_bits
            values = dict(zip(["x1", "y1", "z1", "r1", "x2", "y2", "z2", "r2"], pair))
            for name, low, width in PORTS.pair:
                mask = (1 << width) - 1
                line = line & ~(mask << at + low) | PORTS.encode(values[name]) << at + low
        lines.append(line)
    return lines


def expected(pairs):
    """The expected destination lines."""
    records = []
    for number, pair in enumerate(pairs):
        words, way = answer(pair)
        hit = way.startswith("contact")
        if PORTS.only_hits and not hit:
            continue
        raw = {name: PORTS.encode(value) for name, value in words.items()}
        raw.update(number=number, hit=int(hit), flags=PORTS.flags.get(way, 0))
        records.append(sum(raw[name] << low for name, low, _ in PORTS.contact))
    lines = []
    for first in range(0, len(records), PORTS.contacts_per_line):
        chunk = records[first : first + PORTS.contacts_per_line]
        lines.append(sum(record << place * PORTS.contact_bits for place, record in enumerate(chunk)))
    return lines


class Memory:
    """Answers requests. If `stalls` is set, it refuses some and answers late and in any order."""

    def __init__(self, dut, lines, epoch, seed, stalls):
        self.dut, self.lines, self.epoch, self.stalls = dut, lines, epoch, stalls
        self.random = random.Random(seed)
        self.reads, self.writes, self.read, self.written = [], [], 0, {}
        self.pending = {"rd": None, "wr": None}
        self.ready = {}
        self.cycles = {}
        self.cycle = 0

    def refuses(self):
        return self.stalls and self.random.random() < 0.4

    def junk(self, port):
        getattr(self.dut, port).value = self.random.getrandbits(PORTS.widths[port])

    def drive(self):
        """Sets the inputs of the next cycle."""
        dut = self.dut
        for side, waiting in (("rd", self.reads), ("wr", self.writes)):
            self.ready[side] = not self.refuses()
            getattr(dut, f"{side}_req_ready").value = int(self.ready[side])
            valid = bool(waiting) and not self.refuses()
            getattr(dut, f"{side}_rsp_valid").value = int(valid)
            for name in (["tag", "data", "error"] if side == "rd" else ["tag", "error"]):
                self.junk(f"{side}_rsp_{name}")
            if valid:
                tag, data = waiting.pop(self.random.randrange(len(waiting)) if self.stalls else 0)
                getattr(dut, f"{side}_rsp_tag").value = tag
                getattr(dut, f"{side}_rsp_error").value = 0
                if side == "rd":
                    dut.rd_rsp_data.value = data
                self.mark(f"{side}_rsp")

    def mark(self, what):
        self.cycles.setdefault(what, self.cycle)

    def sample(self):
        """Samples the requests of this cycle before its end."""
        for side, waiting, most in (("rd", self.reads, PORTS.reads), ("wr", self.writes, PORTS.writes)):
            get = lambda name: getattr(self.dut, f"{side}_req_{name}").value
            if self.pending[side] is not None:
                assert get("valid") == 1, f"{side}: a request was withdrawn"
            if get("valid") != 1:
                assert get("valid") == 0, f"{side}: valid is unknown"
                continue
            request = [int(get("address")), int(get("tag")), int(get("data")) if side == "wr" else None]
            assert self.pending[side] in (None, request), f"{side}: a request changed"
            self.pending[side] = request
            if self.ready[side]:
                self.pending[side] = None
                self.take(side, waiting, most, *request)

    def take(self, side, waiting, most, address, tag, data):
        self.mark(f"{side}_req")
        assert tag >> PORTS.slot_bits == self.epoch, f"{side}: another epoch"
        assert tag not in [other for other, _ in waiting], f"{side}: a tag in use"
        assert len(waiting) < most, f"{side}: too many outstanding"
        if side == "rd":
            assert address - SOURCE == self.read, f"a read of line {address - SOURCE}, not {self.read}"
            waiting.append((tag, self.lines[self.read]))
            self.read += 1
        else:
            assert address - DESTINATION == len(self.written), f"a write of line {address - DESTINATION}"
            self.written[address - DESTINATION] = data
            waiting.append((tag, None))


async def reset(dut):
    active = 1
    port = getattr(dut, "rst", None)
    if port is None:
        port, active = dut.rst_n, 0
    for name in PORTS.widths:
        if [row[1] for row in PORTS.tables["port"] if row[0] == name] == ["in"] and name != "clk":
            getattr(dut, name).value = 0
    port.value = active
    await RisingEdge(dut.clk)
    await FallingEdge(dut.clk)
    for name, level in PORTS.levels.items():
        if level != "any":
            want = (1 << PORTS.widths[name]) - 1 if level == "all ones" else int(level)
            assert getattr(dut, name).value == want, f"{name} in reset"
    port.value = 1 - active


async def job(dut, pairs, epoch, seed, stalls):
    """Runs a job and checks it. Returns the cycles of its events, counted from the start."""
    if PORTS.radius is not None:
        pairs = [(*pair[0:3], PORTS.radius, *pair[4:7], PORTS.radius) for pair in pairs]
    memory = Memory(dut, pack(pairs, random.Random(seed)), epoch, seed, stalls)
    inputs = dict(source=SOURCE, destination=DESTINATION, count=len(pairs), mode=0, epoch=epoch, watchdog=0)
    if PORTS.only_hits:
        inputs["destination_lines"] = ROOM
    for _ in range(20000):
        # Halfway through a cycle its inputs are set. Its outputs follow and are sampled before its end.
        await FallingEdge(dut.clk)
        dut.start.value = int(memory.cycle == 0)
        for name, value in inputs.items():
            if memory.cycle == 0:
                getattr(dut, name).value = value
            else:
                memory.junk(name)
        memory.drive()
        if memory.cycle == 0:
            assert dut.busy.value == 0, "busy before the start"
        if memory.cycle == 1:
            assert dut.busy.value == 1 and dut.done.value == 0, "not busy after the start"
        if memory.cycle > 0 and dut.done.value == 1:
            break
        memory.sample()
        memory.cycle += 1
    else:
        raise AssertionError("the job does not end")
    ways = [answer(pair)[1] for pair in pairs]
    invalid = [number for number, way in enumerate(ways) if way == "invalid pair"]
    assert dut.busy.value == 0 and dut.error.value == 0
    assert dut.contacts.value == sum(way.startswith("contact") for way in ways)
    assert dut.invalid.value == len(invalid)
    assert dut.first_invalid.value == (invalid[0] if invalid else 0xFFFFFFFF)
    assert memory.read == len(memory.lines), f"{memory.read} lines read, not {len(memory.lines)}"
    assert not memory.writes and not memory.reads, "the job ended before its last answer"
    want = dict(enumerate(expected(pairs)))
    for line in sorted(want.keys() | memory.written.keys()):
        wrote = memory.written.get(line)
        assert wrote == want.get(line), f"line {line}: {wrote and hex(wrote)} instead of {hex(want.get(line, 0))}"
    return dict(memory.cycles, done=memory.cycle)


@cocotb.test()
async def jobs(dut):
    cocotb.start_soon(Clock(dut.clk, 10, "ns").start())
    await reset(dut)
    # A job right after a reset waits until the delay lines are filled.
    early = await job(dut, PAIRS[:1], 1, 1, False)
    assert early["rd_req"] > PORTS.fill, f"begun before the delay lines are filled: {early}"
    # A single pair with a memory that answers at once gives the timing diagram, cycle by cycle.
    cycles = await job(dut, PAIRS[:1], 1, 1, False)
    assert cycles["rd_req"] == PORTS.first_read, f"R is not {PORTS.first_read}: {cycles}"
    if PORTS.through:
        assert cycles["wr_req"] - cycles["rd_rsp"] in PORTS.through, f"W - A is not in {PORTS.through}: {cycles}"
    assert cycles["done"] - cycles["wr_rsp"] == PORTS.end, f"D - B is not {PORTS.end}: {cycles}"
    for seed, pairs in enumerate([[], PAIRS, PAIRS * 5, PAIRS[1:2], PAIRS[::-1] * 9]):
        await job(dut, pairs, 2 + seed, seed, True)
