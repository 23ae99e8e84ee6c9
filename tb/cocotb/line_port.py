"""Drives a job on the line port and checks it against PORTS.md."""

import random

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, RisingEdge

from records import PAIRS, PORTS, answer, expected, pack

SOURCE, DESTINATION, ROOM = 0x123456789AB, 0x3FF00000000, 1000


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
    # The counts have their levels from the second cycle on.
    later = {"contacts", "invalid", "first_invalid"}
    for in_time in (set(PORTS.levels) - later, set(PORTS.levels)):
        await RisingEdge(dut.clk)
        await FallingEdge(dut.clk)
        for name, level in PORTS.levels.items():
            if level != "any" and name in in_time:
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
