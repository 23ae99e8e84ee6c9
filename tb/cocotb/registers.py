"""REGISTERS.md as data: registers and fields by name, the identity, the version."""

import os
import re
from pathlib import Path

MAP = Path(os.environ["AFU_REGISTERS"]).read_text(encoding="utf-8")


def rows(heading):
    """The rows of the table that begins with this heading."""
    table = MAP.split(f"| {heading} |", 1)[1].split("\n\n", 1)[0]
    return [[cell.strip().strip("`") for cell in row.strip("| ").split("|")] for row in table.split("\n")[2:]]


OFFSETS = {name: int(offset, 16) for offset, _, name, *_ in rows("offset")}
FIELDS = {(register, name): int(bits.partition(":")[2]) for register, bits, name, *_ in rows("register")}
IDENTITY, VERSION = re.search(r"AFU_ID `([0-9a-f]+)`, version (\d+)", MAP).groups()


def bit(register, field):
    return 1 << FIELDS[register, field]
