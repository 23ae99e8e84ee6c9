"""Generates a SoC of LiteX without a CPU: soc.py FOLDER OUT, FOLDER as `afu rtl --package litex` wrote it.

The SoC has a bridge from a UART to its bus, 16 KB of memory, and the accelerator. Writes OUT/soc.v, and into
OUT/soc.json the files and the places that a bench needs to know.
"""

import json
import sys
from pathlib import Path

from litex.build.generic_platform import Pins, Subsignal
from litex.build.io import CRG
from litex.build.sim import SimPlatform
from litex.soc.integration.soc_core import SoCMini

CYCLES_PER_BIT = 8
CLOCK_HZ = 16_000_000
MEMORY, MEMORY_BYTES = 0x4000_0000, 0x4000
REGISTERS = 0x9000_0000

IO = [
    ("sys_clk", 0, Pins(1)),
    ("sys_rst", 0, Pins(1)),
    ("serial", 0, Subsignal("tx", Pins(1)), Subsignal("rx", Pins(1))),
    ("done", 0, Pins(1)),
]


class Soc(SoCMini):
    def __init__(self, platform, accelerator):
        super().__init__(platform, clk_freq=CLOCK_HZ, ident="contact-afu", ident_version=False)
        self.crg = CRG(platform.request("sys_clk"), platform.request("sys_rst"))
        self.add_uartbone(baudrate=CLOCK_HZ // CYCLES_PER_BIT)
        self.add_ram("memory", origin=MEMORY, size=MEMORY_BYTES)
        self.contact_afu = accelerator(platform)
        self.contact_afu.connect(self, origin=REGISTERS)
        self.comb += platform.request("done").eq(self.contact_afu.interrupt)


def main():
    folder, out = (Path(argument).resolve() for argument in sys.argv[1:3])
    sys.path.insert(0, str(folder))
    from contact_afu_litex import ContactAfu

    platform = SimPlatform("SIM", IO)
    soc = Soc(platform, ContactAfu)
    soc.finalize()
    verilog = platform.get_verilog(soc, name="soc", regular_comb=False)
    out.mkdir(parents=True, exist_ok=True)
    verilog.write(str(out / "soc.v"))
    for name, data in verilog.data_files.items():
        (out / name).write_text(data, encoding="utf-8")
    facts = {
        "sources": [str(source) for source, *_ in platform.sources],
        "cycles_per_bit": CYCLES_PER_BIT,
        "memory": MEMORY,
        "registers": REGISTERS,
    }
    (out / "soc.json").write_text(json.dumps(facts, indent=2), encoding="utf-8")


if __name__ == "__main__":
    main()
