"""Pairs, the lines that hold them, and the lines that must come of them, by PORTS.md."""

import math
import os
from pathlib import Path

from ports import Ports

PORTS = Ports(Path(os.environ["AFU_PORTS"]).read_text(encoding="utf-8"))
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
