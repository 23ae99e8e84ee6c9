"""PORTS.md as data: tables by their first heading, and the cycles of its timing diagram."""

import re
import struct


class Ports:
    def __init__(self, text):
        self.tables = {}
        rows = None
        for line in text.splitlines():
            cells = [cell.strip().strip("`") for cell in line.strip().strip("|").split("|")]
            if not line.startswith("|"):
                rows = None
            elif rows is None:
                rows = self.tables.setdefault(cells[0], [])
            elif not set(line) <= set("|-"):
                rows.append(cells)
        self.widths = {name: int(bits) for name, _, bits, _, _ in self.tables["port"]}
        self.levels = {row[0]: row[3] for row in self.tables["port"] if row[3]}
        self.pair = self._words("bits of a pair")
        self.contact = self._words("bits of a record")
        self.pair_bits, self.pairs_per_line = self._sizes(text, r"A pair is (\d+) bits; a source line holds (\d+)")
        self.contact_bits, self.contacts_per_line = self._sizes(
            text, r"A record is (\d+) bits?; a destination line holds (\d+)"
        )
        self.flags = {meaning: int(value) for value, meaning in self.tables.get("flags", [])}
        self.number = re.search(r"Numbers are ([\w ]*\w)", text)[1]
        radius = re.search(r"Every sphere's radius is ([\d.e+-]+);", text)
        self.radius = float(radius[1]) if radius else None
        self.only_hits = "Only pairs in contact have a record" in text
        (self.line_bits,) = self._sizes(text, r"A line is (\d+) bits")
        # What only the line port has.
        if "wr_req_valid" not in self.widths:
            return
        self.reads, self.writes = self._sizes(text, r"At most (\d+) reads and (\d+) writes are outstanding")
        (self.slot_bits,) = self._sizes(text, r"`epoch` in bits \d+:(\d+)")
        (self.first_read,) = self._sizes(text, r"R = (\d+)")
        (self.fill,) = self._sizes(text, r"started in the first (\d+) cycles after a reset begins after them")
        (self.end,) = self._sizes(text, r"D = B \+ (\d+)")
        through = re.search(r"W = A \+ (\d+)(?: to A \+ (\d+))?", text)
        self.through = range(int(through[1]), int(through[2] or through[1]) + 1) if through else None

    @staticmethod
    def _sizes(text, pattern):
        return [int(number) for number in re.search(pattern, text).groups()]

    def _words(self, heading):
        """Name, lowest bit and width of each word."""
        words = []
        for bits, name, _ in self.tables[heading]:
            high, _, low = bits.partition(":")
            low = int(low or high)
            if name:
                words.append((name, low, int(high) - low + 1))
        return words

    def encode(self, value):
        """Encodes a number as a word."""
        if "binary16" in self.number:
            return int.from_bytes(struct.pack("<e", value), "little")
        word = int.from_bytes(struct.pack("<f", value), "little")
        return word >> 16 if "bfloat16" in self.number else word
