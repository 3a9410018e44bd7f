"""Draws per second of a dry stop, and what K_dry costs: `python benchmarks/tails.py [--draws 512,2048]`.

Three ways, each with its processor time: the lanes alone, a sweep with tables only, a sweep with its page.
The draws are those of `scenarios/dry-120-k-dry.sweep.yaml`. Larger samples are not run: their time is
extrapolated from the difference of two sizes, which leaves out start-up and the page.
"""

import argparse
import os
import subprocess
import sys
import sysconfig
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import machine
import numpy as np

from uictest import rig
from uictest.core.statistics import draws_needed
from uictest.plans.sweeps import load_sweep
from uictest.running.chunked import chunk_runner

PROGRAM = Path(sysconfig.get_path("scripts"), "uictest")
SWEEP = Path(__file__).parent.parent / "scenarios" / "dry-120-k-dry.sweep.yaml"
LANES = 256
"""Stops of one block: a chunk of a large sweep."""
PUBLISHED_DRAWS, PUBLISHED_SECONDS = 10_000_000, 24_465
"""ShuntingBrakingCurves, brake mode G: five wagons and 64 m, a model of another kind and another size."""
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Cost:
    """What draws cost: seconds on the wall and of the processor, all threads together."""

    wall: float
    processor: float

    def per_draw(self, smaller: "Cost", draws: int) -> "Cost":
        """Return the cost of one of the draws that this run has more than a smaller one."""
        return Cost((self.wall - smaller.wall) / draws, (self.processor - smaller.processor) / draws)


def lanes(turns: int) -> Cost:
    """Return the cost of one stop of a block in lanes, one thread, nothing judged; the median of turns."""
    runner = chunk_runner(load_sweep(SWEEP), rig.run_block)
    block = runner.assembler.block(np.arange(LANES))
    inputs = block.parameters, block.wheelset_parameters, block.rail
    runner.simulate(*inputs)  # compiles
    walls, processors = [], []
    for _ in range(turns):
        wall, processor = time.perf_counter(), time.thread_time()
        runner.simulate(*inputs)
        walls.append(time.perf_counter() - wall)
        processors.append(time.thread_time() - processor)
    return Cost(median(walls) / LANES, median(processors) / LANES)


def sweep(draws: int, jobs: int, reports: str) -> Cost:
    """Return the cost of a whole sweep as a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        text = SWEEP.read_text()
        scenario = os.path.relpath(SWEEP.parent / "dry-120.yaml", folder)
        text = text.replace("scenario: dry-120.yaml", f"scenario: {scenario}")
        file = Path(folder, SWEEP.name)
        file.write_text(text.replace("size: 3000", f"size: {draws}"))
        options = ["-q", "-n", str(jobs), "-o", folder, "--report", reports, "--trust", SWEEP.parent]
        began = time.perf_counter()
        process = subprocess.Popen([PROGRAM, "sweep", file, *options], stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - began
    if os.waitstatus_to_exitcode(status) not in (0, 1):
        sys.exit(f"the sweep of {draws} draws ended with status {os.waitstatus_to_exitcode(status)}")
    return Cost(wall, usage.ru_utime + usage.ru_stime)


def show(name: str, each: Cost) -> None:
    """Print the cost of one draw and the draws per second."""
    print(
        f"{name:34} {1e3 * each.wall:9.2f} {1e3 * each.processor:11.2f} {1 / each.wall:9.0f}"
        f" {1 / each.processor:15.0f}",
        flush=True,
    )


def extrapolate(name: str, per_draw: Cost, draws: int) -> None:
    """Print what a sample would cost: the time alone is extrapolated, never a result."""
    hours = draws * per_draw.processor / 3600
    print(f"{name:34} {draws:11} {hours:11.2f} {draws * per_draw.wall / 3600:11.2f}")


def main() -> None:
    """Time the three ways, and extrapolate the last."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", default="512,2048", help="the two sizes of the sweeps")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--turns", type=int, default=5)
    arguments = parser.parse_args()
    few, many = map(int, arguments.draws.split(","))
    print(machine.description("numba", "llvmlite", "numpy", "pyarrow"), flush=True)
    print(f"load average {os.getloadavg()[0]:.1f}; {arguments.jobs} threads in sweeps")
    print(f"{'':34} {'wall, ms':>9} {'CPU, ms':>11} {'draws/s':>9} {'draws/CPU-s':>15}")
    show("lanes alone, one thread", lanes(arguments.turns))
    costs = {}
    for name, reports in (("sweep, tables only", "csv"), ("sweep with its page", "csv,html")):
        smaller, larger = (sweep(draws, arguments.jobs, reports) for draws in (few, many))
        costs[name] = larger.per_draw(smaller, many - few)
        show(f"{name}, each further draw", costs[name])
        show(f"{name}, {many} draws in all", Cost(larger.wall / many, larger.processor / many))
    per_draw = costs["sweep, tables only"]
    print(f"\n{'extrapolated':34} {'draws':>11} {'CPU, h':>11} {'wall, h':>11}")
    for level in range(3, 8):
        extrapolate(f"EBCL {level}", per_draw, draws_needed(float(f"1e-{level}"), CONFIDENCE, "lower"))
    extrapolate("as many as the published run", per_draw, PUBLISHED_DRAWS)
    rate = PUBLISHED_DRAWS / PUBLISHED_SECONDS
    print(f"published run, five wagons: {PUBLISHED_SECONDS} s, {rate:.0f} draws/s")


if __name__ == "__main__":
    main()
