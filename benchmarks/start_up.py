"""Whole processes of the command line against a bare interpreter: `python benchmarks/start_up.py [turns]`.

With `--check` it ends with 1 where a command takes more bare interpreters than it may, twice in a row.
Processor time of processes that alternate within a minute is compared: a slow machine slows both, and other
work that comes and goes seldom lasts until the second time.
"""

import os
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
LIMITS = {"--help": 17.0, "check": 40.0, "run": 75.0}
"""Most bare interpreters that a command may take: some six tenths more than on an idle machine when this was
written; beside other work, which takes the cache of the processor, the ratio grows by up to a half."""
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
"""Of the processes: a warm start finds its modules compiled, as an installation does."""
TARGETS = {"check": 25.0, "run": 40.0}
"""Bare interpreters that are aimed at."""


def process(*arguments: str) -> Callable[[], None]:
    """Return a call that runs the interpreter with these arguments and waits for it."""

    def call() -> None:
        subprocess.run([sys.executable, *arguments], check=True, capture_output=True, env=ENVIRONMENT)

    return call


def processor_time() -> float:
    """Return the processor time of all processes waited for, s."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def main(turns: int) -> list[str]:
    """Time each command in turns with a bare interpreter, and return those that take too many."""
    bare = process("-c", "")
    print(machine.description("numpy", "pydantic", "typer"))
    heads = (
        f"{'wall clock, s':>14}",
        f"{'processor, s':>13}",
        f"{'times bare':>11}",
        f"{'limit':>6}",
        f"{'aim':>4}",
    )
    print(f"\n{f'{turns} turns, warm':16}", *heads)
    beyond = []
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
            own, aim = median(busy.ours), f"{TARGETS[name]:.0f}" if name in TARGETS else ""
            print(f"{name:16} {wall:14.3f} {own:13.3f} {busy.ratio:11.1f} {LIMITS[name]:6.0f} {aim:>4}")
            if busy.ratio > LIMITS[name]:
                again = side_by_side(command, bare, turns, processor_time).ratio
                print(f"{name:16} {'again':>28} {again:11.1f}")
                beyond += [name] if again > LIMITS[name] else []
    return beyond


if __name__ == "__main__":
    numbers = [word for word in sys.argv[1:] if word.isdecimal()]
    slow = main(int(numbers[0]) if numbers else 9)
    if "--check" in sys.argv and slow:
        sys.exit(f"slower to start than the limit: {', '.join(slow)}")
