"""Whole processes of the command line against a bare interpreter: `python benchmarks/start_up.py [turns]`."""

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from statistics import median

import machine
from stops import SCENARIOS
from timing import side_by_side

SLIDE_TEST = [str(SCENARIOS / "slide-80.yaml"), "-k", "full"]
"""One stop from 80 km/h."""
ENTRY_POINT = "import sys; from uictest.cli import main; sys.exit(main())"
"""What the installed script `uictest` does."""
TARGETS = {"--help": 0.3, "check": 0.3, "run": 0.6}
"""Longest times in s."""


def process(*arguments: str) -> Callable[[], None]:
    """Return a call that runs the interpreter with these arguments and waits for it."""

    def call() -> None:
        subprocess.run([sys.executable, *arguments], check=True, capture_output=True)

    return call


def processor_time() -> float:
    """Return the processor time of all processes waited for, s."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def main(turns: int) -> None:
    """Time each command in turns with a bare interpreter."""
    bare = process("-c", "")
    print(machine.description("numba", "numpy", "pydantic", "typer"))
    print(f"\n{turns} turns, warm{'wall clock, s':>24} {'target':>8} {'processor, s':>14} {'times bare':>11}")
    with tempfile.TemporaryDirectory() as reports:
        arguments = {
            "--help": ["--help"],
            "check": ["check", str(SCENARIOS)],
            "run": ["run", *SLIDE_TEST, "-o", reports],
        }
        for name, words in arguments.items():
            command = process("-c", ENTRY_POINT, *words)
            wall = median(side_by_side(command, bare, turns, time.perf_counter).ours)
            busy = side_by_side(command, bare, turns, processor_time)
            own = median(busy.ours)
            print(f"{name:12} {wall:23.3f} {TARGETS[name]:8.1f} {own:14.3f} {busy.ratio:11.1f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 9)
