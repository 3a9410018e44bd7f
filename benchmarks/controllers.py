"""Controllers from outside, side by side with the built-in: `python benchmarks/controllers.py [turns]`.

One stop from 80 km/h on one core, and a block of stops as a sweep runs them. Each kind of controller is a
function that builds one and yields what a scenario says of it; a C compiler is needed, FMPy for the FMU.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import machine
import numpy as np
from stops import SCENARIOS
from timing import Clock, Comparison, side_by_side

import uictest
from uictest.controllers import CONTROLLERS, ControllerError
from uictest.plans.scenario import Scenario, load
from uictest.rig import BlockInputs, StopInputs, Workers, assemble, run_block, run_in_process

HERE = Path(__file__).parent
EXAMPLES = HERE.parent / "examples"
HEADER = Path(uictest.__file__).parent / "controllers"
TWIN = "threshold"
"""The built-in controller that each candidate is timed beside."""
SCENARIO = SCENARIOS / "slide-80.yaml"
CASE = "slide-80[compensation=full]"
CASES = 128
"""Stops of a block."""
Built = Callable[[Path], AbstractContextManager[str]]
"""Builds a controller in a folder and yields `key: value` pairs of a scenario's `controller`."""
RunStop = Callable[[StopInputs], Any]


@dataclass(frozen=True)
class Limit:
    """How a comparison becomes a number, its form, and the bound of that number."""

    value: Callable[[Comparison], float]
    form: str
    bound: float
    highest: bool = True

    def text(self, comparison: Comparison) -> str:
        """Return the number, its bound, and whether it keeps it."""
        value = self.value(comparison)
        keeps = value <= self.bound if self.highest else value >= self.bound
        words = "at most" if self.highest else "at least"
        number, bound = (self.form.format(each) for each in (value, self.bound))
        return f"{number:>14}  {words} {bound:14} {'met' if keeps else 'MISSED'}"


def at_most_times(bound: float) -> Limit:
    """Bound the ratio to the built-in controller."""
    return Limit(lambda comparison: comparison.ratio, "{:.2f} times", bound)


def at_most_more(seconds: float) -> Limit:
    """Bound the time that a stop takes beyond one with the built-in controller."""
    return Limit(_more, "{:.3f} s more", seconds)


def stops_per_second(bound: float) -> Limit:
    """Bound the rate of stops from below."""
    return Limit(lambda comparison: 1.0 / median(comparison.ours), "{:.1f} stops/s", bound, highest=False)


def rate_of_cases(bound: float) -> Limit:
    """Bound the cases per second as a share of those with the built-in controller."""
    return Limit(lambda comparison: 1.0 / comparison.ratio, "{:.2f} of it", bound, highest=False)


def _more(comparison: Comparison) -> float:
    return median(ours - theirs for ours, theirs in zip(comparison.ours, comparison.theirs, strict=True))


@contextmanager
def c_library(folder: Path) -> Iterator[str]:
    """Yield the threshold controller in C."""
    compiled(EXAMPLES / "threshold-c" / "threshold.c", folder / "libwsp.so", "-fPIC", "-shared")
    yield "library: libwsp.so"


@contextmanager
def python_class(folder: Path) -> Iterator[str]:
    """Yield the threshold controller in Python."""
    shutil.copy(HERE / "threshold.py", folder)
    yield "python: threshold.py, class: Threshold"


@contextmanager
def fmu(folder: Path) -> Iterator[str]:
    """Yield the threshold controller in C as an FMU."""
    threshold = EXAMPLES / "threshold-c"
    shutil.copy(threshold / "threshold.yaml", folder)
    compiled(threshold / "threshold.c", folder / "libwsp.so", "-fPIC", "-shared")
    words = ["export-controller", "threshold.yaml", "-o", "wsp.fmu", "--force"]
    command = [sys.executable, "-m", "uictest", *words]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    yield "fmu: wsp.fmu"


@contextmanager
def socket_program(folder: Path) -> Iterator[str]:
    """Yield the threshold controller in C behind a socket."""
    threshold = EXAMPLES / "threshold-c" / "threshold.c"
    compiled(EXAMPLES / "socket" / "serve.c", folder / "wsp", threshold)
    with subprocess.Popen([folder / "wsp", "0"], stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None
        ports = re.findall(r"[0-9]+", program.stdout.readline())
        try:
            yield f"connect: 'tcp://127.0.0.1:{ports[-1]}'"
        finally:
            program.kill()


def compiled(source: Path, target: Path, *options: str | Path) -> None:
    """Compile a C file."""
    compiler = os.environ.get("CC", "gcc")
    flags = ["-O2", "-ffp-contract=off", f"-I{HEADER}", *options]
    subprocess.run([compiler, *flags, "-o", target, source, "-lm"], check=True)


def inputs_of(controller: str, *overrides: str) -> StopInputs:
    """Return the timed stop with a controller."""
    cases = load([SCENARIO], [f"controller={controller}", *overrides])
    return assemble(next(case for case in cases if case.id.startswith(CASE[:-1])))


def outside(written: str, twin: str) -> str:
    """Return a controller from outside with the numbers of its built-in twin."""
    scenario: Scenario = load([SCENARIO], [f"controller={twin}"])[0].scenario
    names = [name for name in CONTROLLERS[twin].declared_parameters() if name != "cycle_time"]
    numbers = ", ".join(f"{name}: {float(getattr(scenario.controller, name))!r}" for name in names)
    return f"{{{written}, parameters: {{{numbers}}}, free_parameters: true}}"


def timed(
    name: str, build: Built, run: RunStop, limit: Limit, turns: int, clock: Clock = time.perf_counter
) -> None:
    """Time the stop with a controller from outside in turns with its built-in twin, and print a line."""
    with build(Path.cwd()) as written:
        ours, theirs = inputs_of(outside(written, TWIN)), inputs_of(TWIN)
        bits = [bits_of(each.measures) for each in (run(ours), run_in_process(theirs))]
        comparison = side_by_side(lambda: run(ours), lambda: run_in_process(theirs), turns, clock)
    _print(name, comparison, limit, "same bits" if bits[0] == bits[1] else "OTHER BITS")


def timed_block(
    name: str,
    build: Built,
    run: Callable[[BlockInputs], Any],
    limit: Limit,
    turns: int,
    clock: Clock = time.perf_counter,
) -> None:
    """Time a block of stops in turns with its built-in twin in lanes, and print a line."""
    with build(Path.cwd()) as written:
        ours, theirs = Block.of(outside(written, TWIN), run), Block.of(TWIN, run_block)
        bits = [bits_of(each.run().measures) for each in (ours, theirs)]
        comparison = side_by_side(ours.run, theirs.run, turns, clock)
    _print(name, comparison, limit, "same bits" if bits[0] == bits[1] else "OTHER BITS")


def bits_of(measures: Any) -> bytes:
    """Return what stops measured, but whether the controller can report: one that is built in never can."""
    measures = measures.copy()
    measures["has_diagnosis"] = 0.0
    return bytes(measures.tobytes())


def _print(name: str, comparison: Comparison, limit: Limit, agreement: str) -> None:
    milliseconds = [1e3 * median(times) for times in (comparison.ours, comparison.theirs)]
    print(
        f"{name:30} {milliseconds[0]:10.1f} {milliseconds[1]:10.1f} {limit.text(comparison)}  {agreement}",
        flush=True,
    )


@dataclass(frozen=True)
class Block:
    """The timed stop on rails from 0.06 to 0.16, as the chunk of a sweep runs them."""

    stops: Sequence[StopInputs]
    run_block: Callable[[BlockInputs], Any]

    @classmethod
    def of(cls, controller: str, run_block: Callable[[BlockInputs], Any]) -> "Block":
        """Return the block with a controller, and what runs it."""
        frictions = ",".join(f"{each:.5f}" for each in np.linspace(0.06, 0.16, CASES))
        cases = load([SCENARIO], [f"controller={controller}", f"rail.friction={frictions}"])
        return cls([assemble(case) for case in cases if "compensation=full" in case.id], run_block)

    def run(self) -> Any:
        """Run all stops on this thread."""
        return self.run_block(BlockInputs.of(self.stops))


@contextmanager
def at_work(folder: Path) -> Iterator[None]:
    """Work in a folder, where paths on the command line start."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def attempt(time_candidate: Callable[..., None], name: str, *arguments: Any, **options: Any) -> None:
    """Time a candidate, or print why it cannot be built here."""
    try:
        time_candidate(name, *arguments, **options)
    except (OSError, subprocess.CalledProcessError, ImportError, ControllerError) as error:
        print(f"{name:30} not timed: {error}", flush=True)


def main(turns: int) -> None:
    """Time every kind of controller."""
    with tempfile.TemporaryDirectory() as folder, at_work(Path(folder)):
        report(turns)


def report(turns: int) -> None:
    """Print the table; controllers are built in the working folder."""
    print(machine.description("numpy", "fmpy"))
    measures = run_in_process(inputs_of("threshold")).measures
    print(f"\n{CASE}: {float(measures.end_time):.1f} s; {turns} turns")
    print(f"{'controller':30} {'ms':>10} {'built-in':>10}")
    with Workers() as workers:
        here, child = partial(attempt, timed, clock=time.thread_time), partial(attempt, timed)
        here("C, in process", c_library, run_in_process, at_most_times(1.1), turns)
        child("C, in a child process", c_library, workers.run, at_most_times(3.0), turns)
        here("Python, in process", python_class, run_in_process, stops_per_second(5.0), turns)
        child("Python, in a child process", python_class, workers.run, stops_per_second(5.0), turns)
        here("FMU, in process", fmu, run_in_process, at_most_more(0.1), turns)
        child("FMU, in a child process", fmu, workers.run, at_most_more(0.1), turns)
        child("TCP", socket_program, run_in_process, at_most_more(0.5), turns)
        print(f"\na block of {CASES} stops in lanes, one thread")
        here, child = partial(attempt, timed_block, clock=time.thread_time), partial(attempt, timed_block)
        rate, turns = rate_of_cases(0.7), max(turns // 3, 3)
        here("C, in process", c_library, run_block, rate, turns)
        child("C, in a child process", c_library, workers.run_block, rate, turns)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 15)
