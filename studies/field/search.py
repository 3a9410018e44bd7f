"""Search a family for stops like the real train's: spread evenly, then narrowed about the closest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from studies.field.families import CARRY_OVERS, FAMILIES, SHAPES, Assumptions, Family
from studies.field.field_rig import FieldRig
from studies.field.real_train import FieldStop

ROUNDS: Final = (0.12, 0.06, 0.03)
"""Distance of the farthest neighbours in each round of narrowing, share of a range."""
_CENTRES: Final = 2
"""The closest stops, for each shape of the friction, about which a round looks."""
_NEIGHBOURS: Final = 4
"""Power of two of the number of neighbours of a centre that are tried in a round."""


@dataclass(frozen=True, slots=True)
class Trial:
    """A stop under assumptions of a family, and the round that tried it: 0 for those spread evenly."""

    family: Family
    assumptions: Assumptions
    stop: FieldStop
    round: int


def search(field_rig: FieldRig, families: Sequence[Family] = FAMILIES) -> list[Trial]:
    """Return all stops that were tried, round by round; the same in every run."""
    spread = [(family, each) for family in families for each in evenly_spread(family, field_rig)]
    trials = _tried(field_rig, spread, 0)
    for number, distance in enumerate(ROUNDS, start=1):
        centres = [centre for family in families for centre in _centres(trials, family)]
        near = [(trial.family, each) for trial in centres for each in neighbours(trial, distance)]
        trials += _tried(field_rig, near, number)
    return trials


def _tried(field_rig: FieldRig, assumed: Sequence[tuple[Family, Assumptions]], number: int) -> list[Trial]:
    stops = field_rig.stops([assumptions for _, assumptions in assumed])
    return [Trial(*each, stop, number) for each, stop in zip(assumed, stops, strict=True)]


def closest(trials: Sequence[Trial]) -> Trial:
    """Return the first of those with the least misfit."""
    return min(trials, key=_misfit)


def _misfit(trial: Trial) -> float:
    return trial.stop.misfit


def _centres(trials: Sequence[Trial], family: Family) -> Iterator[Trial]:
    for shape in SHAPES:
        own = [trial for trial in trials if trial.family is family and trial.assumptions.shape == shape]
        yield from sorted(own, key=_misfit)[:_CENTRES]


def evenly_spread(family: Family, field_rig: FieldRig) -> Iterator[Assumptions]:
    """Yield assumptions that fill the ranges evenly; shapes and carry-overs take turns."""
    choices = list(product(SHAPES, CARRY_OVERS if family.cleans else (0.0,)))
    fixed = {"fill_time": field_rig.build_up(family.brake)}
    for number, shares in enumerate(_sobol(len(family.ranges), family.evenly)):
        shape, carry_over = choices[number % len(choices)]
        varied = {
            name: each.at(share) for (name, each), share in zip(family.ranges.items(), shares, strict=True)
        }
        yield Assumptions(shape=shape, brake=family.brake, carry_over=carry_over, **(fixed | varied))


def neighbours(trial: Trial, distance: float) -> Iterator[Assumptions]:
    """Yield assumptions spread evenly about those of a trial, up to a distance in shares of each range."""
    ranges = trial.family.ranges
    for shares in _sobol(len(ranges), _NEIGHBOURS):
        varied: Any = {
            name: each.near(getattr(trial.assumptions, name), distance * (2.0 * share - 1.0))
            for (name, each), share in zip(ranges.items(), shares, strict=True)
        }
        yield replace(trial.assumptions, **varied)


def _sobol(dimensions: int, power: int) -> list[list[float]]:
    """Return points of the unit cube, the first 2^power of the sequence of Sobol."""
    from scipy.stats import qmc

    engine: Any = qmc.Sobol(dimensions, scramble=False)
    points: NDArray[np.float64] = engine.random_base2(power)
    shares: list[list[float]] = points.tolist()
    return shares
