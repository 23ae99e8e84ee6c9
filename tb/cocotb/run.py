"""Runs a cocotb bench: run.py FOLDER [SIMULATOR], FOLDER as `afu rtl --shell line` or `--shell axi` wrote it.

The bench depends only on PORTS.md and REGISTERS.md in FOLDER, and on nothing else of this project. The simulator is
icarus, or verilator. Exit status 1 if the bench fails.
"""

import os
import sys
import tempfile
from pathlib import Path

from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner


def main() -> int:
    folder = Path(sys.argv[1]).resolve()
    here = Path(__file__).resolve().parent
    ports = (folder / "PORTS.md").read_text(encoding="utf-8")
    top = ports.split("`")[1]
    os.environ["AFU_PORTS"] = str(folder / "PORTS.md")
    registers = folder / "REGISTERS.md"
    os.environ["AFU_REGISTERS"] = str(registers)
    bench = "line_port"
    if registers.exists():
        bench = "axi_spheres" if "`others`" in registers.read_text(encoding="utf-8") else "axi"
    simulator = sys.argv[2] if len(sys.argv) > 2 else "icarus"
    # The pin `interrupt` has the name of a word of C++ libraries.
    options = ["-Wno-SYMRSVDWORD"] if simulator == "verilator" else []
    os.environ["PYTHONPATH"] = str(here)
    with tempfile.TemporaryDirectory() as build:
        runner = get_runner(simulator)
        sources = sorted(folder.glob("*.v"))
        runner.build(
            sources=sources, hdl_toplevel=top, build_dir=build, timescale=("1ns", "1ps"), build_args=options
        )
        results = runner.test(hdl_toplevel=top, test_module=bench, build_dir=build, test_dir=build)
        tests, failed = get_results(results)
    return 1 if failed or tests == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
