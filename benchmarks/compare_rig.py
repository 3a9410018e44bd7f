"""Our rig and the same rig in C, side by side: `python benchmarks/compare_rig.py [turns]`."""

import sys
from statistics import median
from typing import Any

import machine
import numpy as np
from c_library import PLAIN, STRICT, CStop, can_run
from stops import TIMED, Stop, shipped
from timing import side_by_side

from uictest.rig.backends.scalar import compiled_stop
from uictest.rig.single_stop import FinishedStop, run_to_end

TARGET = 1.3
"""Highest ratio of our time to that of C."""
_WHEELSETS = 4


def timed(name: str, stop: Stop, c_stop: CStop, turns: int) -> float:
    """Time one stop, print a line and return the ratio."""
    ours = compiled_stop()
    steps = run_to_end(ours, stop).car.steps
    comparison = side_by_side(lambda: run_to_end(ours, stop), lambda: run_to_end(c_stop, stop), turns)
    own, other = (
        1e9 * median(times) / (steps * _WHEELSETS) for times in (comparison.ours, comparison.theirs)
    )
    rate = 1.0 / median(comparison.ours)
    print(f"{name:32} {own:8.1f} {other:8.1f} {rate:10.1f} {comparison.ratio:8.2f}")
    return comparison.ratio


def disagreement(ours: FinishedStop, theirs: FinishedStop) -> float:
    """Largest relative difference of any measure and of any final state."""
    pairs = [
        (ours.measures, theirs.measures),
        (ours.wheelset_measures, theirs.wheelset_measures),
        (ours.car, theirs.car),
        (ours.wheelsets, theirs.wheelsets),
    ]
    return max(_difference(a[field], b[field]) for a, b in pairs for field in a.dtype.names)


def _difference(a: Any, b: Any) -> float:
    a, b = np.asarray(a, float), np.asarray(b, float)
    if np.array_equal(a, b, equal_nan=True):
        return 0.0
    if not np.array_equal(np.isnan(a), np.isnan(b)):
        return float("inf")
    return float(np.nanmax(np.abs(a - b) / np.maximum(np.abs(a), np.abs(b))))


def agreement(stops: dict[str, Stop], c_stop: CStop) -> None:
    """Print how far distance, time and everything else differ, for every shipped case."""
    print(f"\nagreement without contraction {'distance m':>21} {'time s':>10} {'largest difference':>20}")
    for name, stop in stops.items():
        if not can_run(stop.parameters):
            continue
        ours, theirs = run_to_end(compiled_stop(), stop), run_to_end(c_stop, stop)
        worst = disagreement(ours, theirs)
        verdict = "same bits" if worst == 0.0 else f"{worst:.1e}"
        m = ours.measures
        print(f"{name:38} {m.end_distance:12.3f} {m.end_time:10.3f} {verdict:>20}")


def main(turns: int) -> None:
    """Run the comparison."""
    stops = shipped()
    print(machine.description("numba", "llvmlite", "numpy"))
    for flags in (STRICT, PLAIN):
        c_stop = CStop(flags)
        print(f"\nC: gcc {' '.join(flags)}; ours: numba, strict floating point; {turns} turns")
        print(f"{'ns per wheelset and step':32} {'ours':>8} {'C':>8} {'our stops/s':>10} {'ours / C':>8}")
        worst = max(timed(name, stops[name], c_stop, turns) for name in TIMED)
        print(f"highest ratio {worst:.2f}, target at most {TARGET}")
    agreement(stops, CStop(STRICT))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 15)
