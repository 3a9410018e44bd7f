"""Whether one Newton step for the slip speed would do: `python benchmarks/newton_steps.py`.

The rig takes two. Every condition is run in lanes with one and with two, stop by stop with the same noise.
Where WSP cycling makes single stops differ, the mean of the differences counts: one step is equivalent if the
95 % interval of that mean lies within +-0.05 % of the distance, +-0.3 % of the air and +-0.1 vents of a
wheelset. Conditions that 256 stops do not show get as many as their spread asks for, up to `--stops N`.
`-k WORD` selects conditions, also several; `--compare 6,2` compares other numbers of steps; `--folder FOLDER`
keeps the stops, so that a later call adds to them.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
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
BATCH = 4096
"""Stops that are held in memory at once."""
LONG_LOCK = 1.0
"""Time for which a wheelset must stand while the train moves to count as a long lock, s."""
_QUANTILES = 1.96 + 1.645
"""Half an interval of 95 %, and what chance leaves room for nine times in ten, in standard errors."""


def conditions(*words: str) -> Iterator[tuple[str, StopInputs]]:
    """Yield the inputs of every condition by its name: shipped cases, then variants of some."""
    paths = [path for path in sorted(SCENARIOS.glob("*.yaml")) if path.name.count(".") == 1]
    cases = {case.id: case for case in load(paths)}
    for name, case in cases.items():
        if any(word in name for word in words):
            yield name, assemble(case)
    for variant, (names, settings) in VARIANTS.items():
        for name in names:
            if any(word in f"{name}, {variant}" for word in words):
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


def six_newton_steps(wheelsets: Any, thrusts: Any, p: Any) -> Any:
    """Do as :func:`uictest.rig.model.slip_search.find_slips`, with six steps: to convergence."""
    first, sliding_forces = one_newton_step(wheelsets, thrusts, p)
    second, _ = _refine_all(first, wheelsets, p)
    third, _ = _refine_all(second, wheelsets, p)
    fourth, _ = _refine_all(third, wheelsets, p)
    fifth, _ = _refine_all(fourth, wheelsets, p)
    sixth, _ = _refine_all(fifth, wheelsets, p)
    return sixth, sliding_forces


bracket_slip, _refine_all = slip_search.bracket_slip, slip_search._refine_all
SEARCHES = {1: one_newton_step, 2: slip_search.find_slips, 6: six_newton_steps}
"""Number of Newton steps -> search."""
RIGS_OWN = 2
"""Newton steps that the rig takes."""


def run(steps: int, wanted: dict[str, int], folder: Path) -> None:
    """Run stops until there are as many of each condition as wanted; leave what they came to in files."""
    for search in SEARCHES.values():
        search.__module__ = slip_search.__name__  # compiled as if it stood there
    step.find_slips = SEARCHES[steps]  # type: ignore[attr-defined]
    for name, inputs in conditions(""):
        file = folder / f"{steps} {name}.npy"
        while name in wanted and (have := len(np.load(file)) if file.exists() else 0) < wanted[name]:
            figures = _stops(inputs, np.arange(have, min(have + BATCH, wanted[name])) + 1)
            np.save(file, np.concatenate([np.load(file), figures]) if have else figures)


def _stops(inputs: StopInputs, keys: NDArray[np.int64]) -> NDArray[np.float64]:
    """Run a stop with each of these keys of the noise and return what they came to."""
    many = np.repeat(inputs.parameters.reshape(1), keys.size).view(inputs.parameters.dtype)
    many["noise_key"] = keys
    own, rail = np.tile(inputs.wheelset_parameters, (keys.size, 1)), np.tile(inputs.rail, (keys.size, 1, 1))
    return _figures(*run_in_lanes(many, own, rail))


def _figures(stops: Any, wheelsets: Any) -> NDArray[np.float64]:
    """Return distance, air, residual of energy, vents, mean and longest locked time; shape (n, 6)."""
    vents, locked = (wheelsets[name].mean(axis=1) for name in ("valve_actuations", "locked_time"))
    columns = [stops["end_distance"], stops["air_consumed"], stops["energy_residual"], vents, locked]
    return np.column_stack([*columns, wheelsets["locked_time"].max(axis=1)])


class Pairs:
    """Stops of one condition with one search and with another, in pairs that met the same noise."""

    def __init__(self, name: str, compared: Sequence[int], folder: Path) -> None:
        both = [np.load(folder / f"{steps} {name}.npy") for steps in compared]
        self.count = min(len(stops) for stops in both)
        self.one, self.two = (stops[: self.count] for stops in both)

    @property
    def differences(self) -> dict[str, NDArray[np.float64]]:
        """What the first search differs by from the second, stop by stop."""
        return {
            "distance, %": 100.0 * (self.one[:, 0] - self.two[:, 0]) / self.two[:, 0].mean(),
            "air, %": 100.0 * (self.one[:, 1] - self.two[:, 1]) / self.two[:, 1].mean(),
            "vents": self.one[:, 3] - self.two[:, 3],
        }

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """The 95 % intervals of the mean differences."""
        return {head: mean_interval(values.tolist()) for head, values in self.differences.items()}

    @property
    def are_equivalent(self) -> bool:
        """Whether the intervals lie within the bounds."""
        return all(
            -BOUNDS[head] < low and high < BOUNDS[head] for head, (low, high) in self.intervals.items()
        )

    @property
    def needed(self) -> int:
        """How many pairs show a difference of zero nine times in ten, by the spread of these."""
        spreads = {head: float(values.std(ddof=1)) for head, values in self.differences.items()}
        return max(math.ceil((_QUANTILES * spreads[head] / BOUNDS[head]) ** 2) for head in BOUNDS)

    @property
    def long_locks(self) -> tuple[int, int, float]:
        """Stops with a long lock, of either search, and how often chance alone parts them as far.

        The exact test of McNemar: of the pairs with one such stop, each search has half.
        """
        one, two = self.one[:, 5] > LONG_LOCK, self.two[:, 5] > LONG_LOCK
        only_one, only_two = int((one & ~two).sum()), int((two & ~one).sum())
        fewer, parted = min(only_one, only_two), only_one + only_two
        share = sum(math.comb(parted, k) for k in range(fewer + 1)) / 2**parted
        return int(one.sum()), int(two.sum()), min(1.0, 2.0 * share)


def report(names: Sequence[str], compared: Sequence[int], folder: Path) -> int:
    """Print a row for each condition and return how many are not shown to be equivalent."""
    heads = "".join(f"{head:>22}" for head in BOUNDS)
    print(
        f"{'mean difference and its 95 % interval':44}{'pairs':>6}{heads}{'locked, s':>20}{'energy, %':>18}"
        f"{'long locks':>14}{'chance':>8}"
    )
    missed = 0
    for name in names:
        pairs, cells = Pairs(name, compared, folder), ""
        for low, high in pairs.intervals.values():
            cells += f"{(low + high) / 2:+10.4f} +-{(high - low) / 2:8.4f} "
        locked = "  ".join(f"{each[:, 4].mean():.3f}" for each in (pairs.one, pairs.two))
        energy = "  ".join(f"{100.0 * abs(each[:, 2]).max():.1e}" for each in (pairs.one, pairs.two))
        *long, chance = pairs.long_locks
        missed += not pairs.are_equivalent
        verdict = "" if pairs.are_equivalent else f"NOT SHOWN, {pairs.needed} needed"
        print(
            f"{name[:43]:44}{pairs.count:6}{cells}{locked:>19} {energy:>17} {'  '.join(map(str, long)):>13}"
            f" {chance:7.2g} {verdict}"
        )
    first, second = compared
    print(f"{len(names) - missed} of {len(names)} conditions: {first} equivalent to {second} Newton steps")
    return missed


def main() -> int:
    """Run both kinds in processes of their own, with caches of their own, and compare."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--stops", type=int, default=4096)
    parser.add_argument("-k", dest="words", action="append")
    parser.add_argument("--compare", default="1,2")
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--steps", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--wanted", type=json.loads, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.steps:
        run(given.steps, given.wanted, given.folder)
        return 0
    print(machine.description("numba", "numpy"), flush=True)
    names = [name for name, _ in conditions(*given.words or [""])]
    compared = [int(steps) for steps in given.compare.split(",")]
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.folder or Path(temporary)
        folder.mkdir(exist_ok=True)
        run_until_shown(names, compared, given.stops, folder)
        return 1 if report(names, compared, folder) else 0


def run_until_shown(names: Sequence[str], compared: Sequence[int], most: int, folder: Path) -> None:
    """Run every condition with both searches, and on until it is shown or has as many stops as it may."""
    wanted = dict.fromkeys(names, min(FEWEST, most))
    while wanted:
        run_both(wanted, compared, folder)
        pairs = {name: Pairs(name, compared, folder) for name in wanted}
        wanted = {
            name: min(max(each.needed, 2 * each.count), most)
            for name, each in pairs.items()
            if each.count < most and not each.are_equivalent
        }


def run_both(wanted: dict[str, int], compared: Sequence[int], folder: Path) -> None:
    """Run conditions with both searches, each in a process and with a cache of its own, in turn."""
    for steps in compared:
        cache = {"UICTEST_CACHE": str(folder / f"cache-{steps}")} if steps != RIGS_OWN else {}
        words = ["--steps", str(steps), "--folder", str(folder), "--wanted", json.dumps(wanted)]
        subprocess.run([sys.executable, __file__, *words], env={**os.environ, **cache}, check=True)


if __name__ == "__main__":
    sys.exit(main())
