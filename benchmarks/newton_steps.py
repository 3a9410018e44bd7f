"""Whether one Newton step for the slip speed would do: `python benchmarks/newton_steps.py`.

The rig takes two. Every condition is run in lanes with one and with two, stop by stop with the same noise.
Where WSP cycling makes single stops differ, the mean of the differences counts: one step is equivalent if the
95 % interval of that mean lies within +-0.05 % of the distance, +-0.3 % of the air and +-0.1 vents of a
wheelset. Conditions of which 256 stops do not show it are run with four times as many, up to `--stops N`;
`-k WORD` selects conditions.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Any

import machine
import numpy as np
from numpy.typing import NDArray
from stops import SCENARIOS

from uictest.core.statistics import mean_interval
from uictest.plans.scenario import load
from uictest.rig import StopInputs, assemble, run_in_lanes
from uictest.rig.model import slip_search, step

BOUNDS = {"distance, %": 0.05, "air, %": 0.3, "vents": 0.1}
"""Half widths within which the mean difference must lie; chosen before a stop was run."""
_FAULTS = (
    "[{at: 3 s, wheelset: 2, part: speed-sensor, kind: lost}, {at: 5 s, wheelset: 3, part: vent-magnet,"
    " kind: shorted}]"
)
_WET = ("slip-120", "low-adhesion-80", "slide-80[compensation=full]")
VARIANTS = {
    "slip-band": (_WET, ["controller=slip-band"]),
    "cleaned rail": (_WET, ["rail.condition=wet-cleaning", "rail.friction=0.07"]),
    "faults": (_WET, [f"faults={_FAULTS}"]),
    "modelled air": (_WET, ["rig.compensation=thermal"]),
    "pole wheels": (_WET, ["rig.sensors=pole-wheel"]),
    "walking pace": (("low-adhesion-80",), ["initial_speed=5 km/h"]),
    "slow": (("low-adhesion-80",), ["initial_speed=15 km/h"]),
    "locked": (("low-adhesion-80",), ["rig.wsp=bypassed", "rail.friction=0.03"]),
    "downhill": (("low-adhesion-80",), ["rail.gradient=-10 permille", "rail.friction=0.08"]),
    "stiff contact": (_WET[:2], ["rail.condition={extends: wet, reduction_adhesion: 1, reduction_slip: 1}"]),
    "soft contact": (
        _WET[:2],
        ["rail.condition={extends: wet, reduction_adhesion: 0.1, reduction_slip: 0.02}"],
    ),
    "falling friction": (
        _WET[:2],
        ["rail.condition={extends: wet, friction_ratio: 0.2, friction_decay: 1 s/m}"],
    ),
    "large contact": (
        _WET[:2],
        ["rail.condition={extends: wet, contact: {semi_axis_longitudinal: 9 mm, semi_axis_lateral: 9 mm}}"],
    ),
    "small contact": (
        _WET[:2],
        ["rail.condition={extends: wet, contact: {semi_axis_longitudinal: 3 mm, semi_axis_lateral: 3 mm}}"],
    ),
}
"""Name -> shipped cases and what is set in them."""
FEWEST = 256
"""Stops of every condition."""


def conditions(word: str) -> Iterator[tuple[str, StopInputs]]:
    """Yield the inputs of every condition by its name: shipped cases, then variants of some."""
    paths = [path for path in sorted(SCENARIOS.glob("*.yaml")) if path.name.count(".") == 1]
    cases = {case.id: case for case in load(paths)}
    for name, case in cases.items():
        if word in name:
            yield name, assemble(case)
    for variant, (names, settings) in VARIANTS.items():
        for name in names:
            if word in f"{name}, {variant}":
                [case] = load([cases[name].path], [*_parameters(cases[name]), *settings])[:1]
                yield f"{name}, {variant}", assemble(case)


def _parameters(case: Any) -> list[str]:
    return [f"{key}={value}" for key, value in case.parameters.items()]


def one_newton_step(wheelsets: Any, thrusts: Any, p: Any) -> Any:
    """Do as :func:`uictest.rig.model.slip_search.find_slips`, with one step."""
    slips = (
        bracket_slip(wheelsets[0], thrusts[0], p),
        bracket_slip(wheelsets[1], thrusts[1], p),
        bracket_slip(wheelsets[2], thrusts[2], p),
        bracket_slip(wheelsets[3], thrusts[3], p),
    )
    return _refine_all(slips, wheelsets, p)


bracket_slip, _refine_all = slip_search.bracket_slip, slip_search._refine_all


def run(steps: int, names: Collection[str], count: int, folder: Path) -> None:
    """Run stops of some conditions and leave what they came to, one file for each."""
    if steps == 1:
        one_newton_step.__module__ = slip_search.__name__  # compiled as if it stood there
        step.find_slips = one_newton_step  # type: ignore[attr-defined]
    for name, inputs in conditions(""):
        if name in names:
            many = np.repeat(inputs.parameters.reshape(1), count).view(inputs.parameters.dtype)
            many["noise_key"] = np.arange(count) + 1
            own, rail = np.tile(inputs.wheelset_parameters, (count, 1)), np.tile(inputs.rail, (count, 1, 1))
            np.save(folder / f"{steps} {name}.npy", _figures(*run_in_lanes(many, own, rail)))


def _figures(stops: Any, wheelsets: Any) -> NDArray[np.float64]:
    """Return distance, air, air's residual of energy, vents and locked time of each stop; shape (n, 5)."""
    vents, locked = (wheelsets[name].mean(axis=1) for name in ("valve_actuations", "locked_time"))
    return np.column_stack(
        [stops["end_distance"], stops["air_consumed"], stops["energy_residual"], vents, locked]
    )


def differences(one: NDArray[np.float64], two: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Return what one step differs by from two, stop by stop."""
    return {
        "distance, %": 100.0 * (one[:, 0] - two[:, 0]) / two[:, 0].mean(),
        "air, %": 100.0 * (one[:, 1] - two[:, 1]) / two[:, 1].mean(),
        "vents": one[:, 3] - two[:, 3],
    }


def is_shown(name: str, folder: Path) -> bool:
    """Return whether the stops of a condition show that one step is equivalent."""
    intervals = {
        head: mean_interval(each.tolist()) for head, each in differences(*_both(name, folder)).items()
    }
    return all(-BOUNDS[head] < low and high < BOUNDS[head] for head, (low, high) in intervals.items())


def _both(name: str, folder: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return np.load(folder / f"1 {name}.npy"), np.load(folder / f"2 {name}.npy")


def report(names: Sequence[str], folder: Path) -> int:
    """Print a row for each condition and return how many are not shown to be equivalent."""
    heads = "".join(f"{head:>22}" for head in BOUNDS)
    print(
        f"{'mean difference and its 95 % interval':44}{'stops':>6}{heads}{'locked, s':>20}{'energy, %':>18}"
    )
    missed = 0
    for name in names:
        (one, two), cells, holds = _both(name, folder), "", is_shown(name, folder)
        for values in differences(one, two).values():
            low, high = mean_interval(values.tolist())
            cells += f"{(low + high) / 2:+10.4f} +-{(high - low) / 2:8.4f} "
        missed += not holds
        locked = "  ".join(f"{each[:, 4].mean():.3f}" for each in (one, two))
        energy = "  ".join(f"{100.0 * abs(each[:, 2]).max():.1e}" for each in (one, two))
        print(f"{name[:43]:44}{len(one):6}{cells}{locked:>19} {energy:>17} {'' if holds else 'NOT SHOWN'}")
    print(f"{len(names) - missed} of {len(names)} conditions: one step is equivalent to two")
    return missed


def main() -> int:
    """Run both kinds in processes of their own, with caches of their own, and compare."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--stops", type=int, default=4096)
    parser.add_argument("-k", dest="word", default="")
    parser.add_argument("--steps", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("names", nargs="*", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.steps:
        run(given.steps, given.names, given.stops, given.folder)
        return 0
    print(machine.description("numba", "numpy"))
    names = [name for name, _ in conditions(given.word)]
    with tempfile.TemporaryDirectory() as folder:
        count, left = FEWEST, names
        while left and count <= given.stops:
            run_both(left, count, Path(folder))
            count, left = 4 * count, [name for name in left if not is_shown(name, Path(folder))]
        return 1 if report(names, Path(folder)) else 0


def run_both(names: Sequence[str], count: int, folder: Path) -> None:
    """Run conditions with one and with two steps, each in a process and with a cache of its own."""
    started = []
    for steps in (1, 2):
        cache = {"UICTEST_CACHE": str(folder / "one")} if steps == 1 else {}
        words = ["--steps", str(steps), "--folder", str(folder), "--stops", str(count), *names]
        command = [sys.executable, __file__, *words]
        started.append(subprocess.Popen(command, env={**os.environ, **cache}))
    codes = [process.wait() for process in started]
    if any(codes):
        raise SystemExit(2)


if __name__ == "__main__":
    sys.exit(main())
