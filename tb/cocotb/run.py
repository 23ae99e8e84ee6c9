"""Runs the cocotb bench of the line port in Icarus: run.py FOLDER, which `afu rtl --shell line` wrote.

The bench depends only on FOLDER/PORTS.md, and on nothing else of this project. Exit status 1 if it fails.
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
    os.environ["PYTHONPATH"] = str(here)
    with tempfile.TemporaryDirectory() as build:
        runner = get_runner("icarus")
        sources = sorted(folder.glob("*.v"))
        runner.build(sources=sources, hdl_toplevel=top, build_dir=build, timescale=("1ns", "1ps"))
        results = runner.test(hdl_toplevel=top, test_module="line_port", build_dir=build, test_dir=build)
        tests, failed = get_results(results)
    return 1 if failed or tests == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
