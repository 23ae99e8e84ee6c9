"""Drives a SoC of LiteX in Icarus: run.py FOLDER, FOLDER as `afu rtl --shell axi --package litex` wrote it.

Exit status 1 if the bench fails.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner


def main() -> int:
    folder = Path(sys.argv[1]).resolve()
    here = Path(__file__).resolve().parent
    os.environ["AFU_PORTS"] = str(folder / "PORTS.md")
    os.environ["AFU_REGISTERS"] = str(folder / "REGISTERS.md")
    # The simulator's Python has this path too.
    sys.path.append(str(here.parent / "cocotb"))
    with tempfile.TemporaryDirectory() as build:
        made = subprocess.run([sys.executable, str(here / "soc.py"), str(folder), build], capture_output=True, text=True)
        if made.returncode:
            sys.exit(made.stdout + made.stderr)
        facts = Path(build) / "soc.json"
        os.environ["SOC_FACTS"] = str(facts)
        sources = [Path(build) / "soc.v", *json.loads(facts.read_text(encoding="utf-8"))["sources"]]
        runner = get_runner("icarus")
        runner.build(sources=sources, hdl_toplevel="soc", build_dir=build, timescale=("1ns", "1ps"))
        results = runner.test(hdl_toplevel="soc", test_module="bench", build_dir=build, test_dir=build)
        tests, failed = get_results(results)
    return 1 if failed or tests == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
