"""Time and memory of a sweep as it grows: `python benchmarks/growth.py [--cases 100,1000,...] [--jobs 1,2]`.

Each size runs `uictest sweep` as a process of its own on stops from 80 km/h with drawn friction and command.
Beside the time on the clock there is that of the processor, which other load on the machine changes less.
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

import machine

PROGRAM = Path(sysconfig.get_path("scripts"), "uictest")
SCENARIO = Path(__file__).parent.parent / "scenarios" / "slide-80.yaml"
MOST_MEMORY = 1.0
"""GB that a sweep may take at most, of any size."""
_SWEEP = """\
schema: uictest/scenario/1
name: growth
extends: {scenario}
rig: {{compensation: full}}
vary:
  sample:
    method: random
    size: {cases}
    parameters:
      rail.friction: {{uniform: [0.08, 0.16]}}
      brake.command: {{uniform: [80 %, 100 %]}}
"""


@dataclass(frozen=True)
class Run:
    """One sweep: its size, its threads, what it took."""

    cases: int
    jobs: int
    seconds: float
    processor: float
    """Time of the processor, all threads together, s."""
    memory: float
    """Highest resident size, GB."""

    @property
    def rate(self) -> float:
        """Cases per second, start-up included."""
        return self.cases / self.seconds


def timed_sweep(cases: int, jobs: int) -> Run:
    """Run a sweep in a folder that is removed afterwards."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "growth.sweep.yaml")
        scenario = os.path.relpath(SCENARIO, folder)
        file.write_text(_SWEEP.format(scenario=scenario, cases=cases))
        began = time.perf_counter()
        process = subprocess.Popen(
            [PROGRAM, "sweep", file, "-q", "-n", str(jobs), "-o", folder, "--trust", SCENARIO.parents[1]],
            stdout=subprocess.DEVNULL,
        )
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - began
    if os.waitstatus_to_exitcode(status) not in (0, 1):
        raise SystemExit(f"the sweep of {cases} cases ended with status {os.waitstatus_to_exitcode(status)}")
    return Run(cases, jobs, seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * _RSS_UNIT)


_RSS_UNIT = 1e-9 if sys.platform == "darwin" else 1024e-9
"""GB per unit of ru_maxrss."""


def table(sizes: list[int], jobs: list[int]) -> list[Run]:
    """Run all sizes; print what each run took as soon as it is measured, and the gain over one thread."""
    names = "   cases  threads         s   cases/s     CPU s  CPU ms/case  peak GB  speed-up"
    print(names, flush=True)
    runs: list[Run] = []
    for cases in sizes:
        for threads in sorted(jobs):
            run = timed_sweep(cases, threads)
            runs.append(run)
            alone = [other for other in runs if (other.cases, other.jobs) == (run.cases, 1)]
            gain = f"{alone[0].seconds / run.seconds:9.2f}" if alone and run.jobs > 1 else ""
            print(
                f"{run.cases:8} {run.jobs:8} {run.seconds:9.2f} {run.rate:9.1f} {run.processor:9.2f}"
                f" {1e3 * run.processor / run.cases:12.3f} {run.memory:8.3f} {gain}",
                flush=True,
            )
    return runs


def judgement(runs: list[Run]) -> None:
    """Print how time and memory grow from the second largest size to the largest."""
    most = max(run.memory for run in runs)
    print(f"highest memory {most:.3f} GB, target below {MOST_MEMORY} GB")
    for jobs in sorted({run.jobs for run in runs}):
        before, last = sorted((run for run in runs if run.jobs == jobs), key=lambda run: run.cases)[-2:]
        times = last.seconds / before.seconds
        each = 1e3 * (last.processor - before.processor) / (last.cases - before.cases)
        print(
            f"{jobs} threads, {before.cases} to {last.cases} cases: time x {times:.2f}"
            f" for cases x {last.cases / before.cases:.0f},"
            f" memory {1e3 * (last.memory - before.memory):+.0f} MB, each further case {each:.3f} CPU ms"
        )


def main() -> None:
    """Run all sizes and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", default="100,1000,10000,100000")
    parser.add_argument("--jobs", default="1,2")
    arguments = parser.parse_args()
    sizes, jobs = ([int(text) for text in option.split(",")] for option in (arguments.cases, arguments.jobs))
    print(machine.description("numpy", "pyarrow"), flush=True)
    runs = table(sizes, jobs)
    if len(sizes) > 1:
        judgement(runs)


if __name__ == "__main__":
    main()
