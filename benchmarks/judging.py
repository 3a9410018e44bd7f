"""What a sweep does around its stops: assembling and judging, and writing, in us per case.

`python benchmarks/judging.py [--cases 256,4096] [--turns 9] [--simulate]`

The measures are those of one simulated chunk, so that reasons and texts are as in a real sweep. Times are
processor times of this thread, medians over turns. `--simulate` adds the stops themselves.
"""

import argparse
import os
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from statistics import median
from textwrap import indent
from typing import Any

import machine
import numpy as np
from growth import SCENARIO

from uictest import rig
from uictest.plans.sweeps import Plan, load_sweep
from uictest.running.chunked import ChunkRunner, chunk_runner
from uictest.running.chunked.chunk import parquet_bytes
from uictest.running.chunked.table import rows

SIMULATED = 256
"""Cases whose measures are repeated."""
TARGET = 1500.0
"""us per case for assembling, judging and writing together; chosen."""
_HEAD = """\
schema: uictest/scenario/1
name: judging
extends: {scenario}
rig: {{compensation: full}}
vary:
"""
SWEEPS = {
    "friction and command drawn": """\
sample:
  method: random
  size: 1000000
  parameters:
    rail.friction: {uniform: [0.08, 0.16]}
    brake.command: {uniform: [80 %, 100 %]}
""",
    "eight numbers drawn": """\
sample:
  method: random
  size: 1000000
  parameters:
    rail.friction: {uniform: [0.08, 0.16]}
    brake.command: {uniform: [80 %, 100 %]}
    initial_speed: {uniform: [75 km/h, 85 km/h]}
    vehicle.body.mass: {uniform: [30 t, 36 t]}
    vehicle.wheelset.radius: {uniform: [0.42 m, 0.46 m]}
    rail.gradient: {uniform: [-5 permille, 5 permille]}
    brake.system.wsp_valve.vent_conductance: {uniform: [1.0e-8 m3/(s Pa), 1.2e-8 m3/(s Pa)]}
    brake.system.air.temperature: {uniform: [-10 degC, 30 degC]}
""",
    "grid of friction, controller and seed": """\
matrix:
  rail.friction: [0.08, 0.10, 0.12, 0.14]
  controller: [threshold, slip-band]
ranges:
  seed: {first: 0, last: 99999, step: 1}
""",
}


def plan_of(text: str, folder: Path) -> Plan:
    """Return the plan of a sweep."""
    file = folder / "judging.sweep.yaml"
    file.write_text(_HEAD.format(scenario=os.path.relpath(SCENARIO, folder)) + indent(text, "  "))
    return load_sweep(file, trusted=[SCENARIO.parent.parent])


def repeated_measures(runner: ChunkRunner) -> ChunkRunner:
    """Return a runner that repeats the measures of some simulated cases instead of simulating."""
    simulated: list[Any] = []

    def simulate(*inputs: Any) -> Any:
        simulated.append(rig.run_in_lanes(*inputs))
        return simulated[0]

    replace(runner, stops=replace(runner.stops, simulate=simulate)).run(np.arange(SIMULATED))

    @cache  # what repeating takes is not judging
    def repeated(cases: int) -> Any:
        indices = np.arange(cases) % SIMULATED
        return tuple(column[indices] for column in simulated[0])

    def repeat(parameters: Any, *others: Any) -> Any:
        return repeated(parameters.size)

    return replace(runner, stops=replace(runner.stops, simulate=repeat))


def seconds(call: Callable[[], Any]) -> tuple[float, Any]:
    """Return the time that a call takes, and what it returns."""
    begin = time.thread_time()
    result = call()
    return time.thread_time() - begin, result


def turn(runner: ChunkRunner, indices: Any) -> tuple[list[float], Counter[str]]:
    """Return the times of assembling and judging the cases of a chunk and of writing it, and its outcomes."""
    settings = runner.plan.settings(indices)
    judging, (results, repeated) = seconds(lambda: runner.results(indices, settings))
    writing, _ = seconds(lambda: parquet_bytes(rows(runner.plan, indices, settings, results, repeated)))
    return [judging, writing], Counter(result.outcome for result in results)


def measure(runner: ChunkRunner, cases: int, turns: int) -> None:
    """Print the medians of a number of chunks, the first of which does not count."""
    times, outcomes = [], Counter[str]()
    for number in range(turns + 1):
        found, of_chunk = turn(runner, np.arange(number * cases, (number + 1) * cases))
        if number:
            times.append([1e6 * each / cases for each in found])
            outcomes += of_chunk
    steps = [median(column) for column in zip(*times, strict=True)]
    shares = ", ".join(f"{name} {count / outcomes.total():.0%}" for name, count in outcomes.most_common())
    print(
        f"{cases:8}" + "".join(f"{each:11.1f}" for each in (*steps, sum(steps))) + f"   {shares}", flush=True
    )


def main() -> None:
    """Print a table per sweep."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", default="256,4096")
    parser.add_argument("--turns", type=int, default=9)
    parser.add_argument("--simulate", action="store_true")
    arguments = parser.parse_args()
    print(machine.description("numpy", "pyarrow"), flush=True)
    print(f"target: {TARGET} us per case for all together")
    for name, text in SWEEPS.items():
        print(f"\n{name}\n   cases    judging    writing   together", flush=True)
        with tempfile.TemporaryDirectory() as folder:
            simulating = chunk_runner(plan_of(text, Path(folder)), rig.run_block)
            repeating = repeated_measures(simulating)
            for cases in map(int, arguments.cases.split(",")):
                measure(repeating, cases, arguments.turns)
            if arguments.simulate:
                measure(simulating, SIMULATED, 3)


if __name__ == "__main__":
    main()
