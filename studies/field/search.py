"""Search for stops like the real train's.

In a family of assumptions: spread evenly, then narrowed about the closest. And with one assumption at a time,
added to the plainest: the library's ep-disc on a rail of constant friction.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from types import MappingProxyType
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from studies.field.assumptions import CARRY_OVERS, FAMILIES, SHAPES, Assumptions, Family, FieldStop
from studies.field.field_rig import FieldRig

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
    return min(trials, key=lambda trial: trial.stop.misfit)


def _centres(trials: Sequence[Trial], family: Family) -> Iterator[Trial]:
    for shape in SHAPES:
        own = [trial for trial in trials if trial.family is family and trial.assumptions.shape == shape]
        yield from sorted(own, key=lambda trial: trial.stop.misfit)[:_CENTRES]


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


FRICTIONS: Final = tuple(round(0.05 + 0.01 * k, 2) for k in range(16))
"""Tried with every value: the friction of the rail is not known, so that it is chosen anew for each."""
FINER: Final = (-0.0075, -0.005, -0.0025, 0.0, 0.0025, 0.005, 0.0075)
"""Tried about the closest of these."""


@dataclass(frozen=True, slots=True)
class Variation:
    """An assumption and its values.

    Args:
        name: for people.
        assumption: the field of :class:`Assumptions` that changes.
        values: SI, from the least change on.
        size: of `unit` in SI.
        unit: in which values are shown.
        together: what the assumption needs besides.
    """

    name: str
    assumption: str
    values: Sequence[float]
    size: float = 1.0
    unit: str = ""
    together: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))

    def added_to(self, base: Assumptions, value: float) -> Assumptions:
        """Return assumptions with a value of this one."""
        changes: Any = {self.assumption: value, **self.together}
        return replace(base, **changes)

    def text(self, value: float) -> str:
        """Return a value with its unit."""
        return f"{value / self.size:g} {self.unit}".rstrip()


VARIATIONS: Final = (
    Variation("stronger pads, factor", "pad_factor", (1.05, 1.1, 1.15, 1.2, 1.25, 1.3, 1.4, 1.5)),
    Variation("shorter build-up", "fill_time", (0.6, 0.4, 0.3, 0.2, 0.1, 0.05), unit="s"),
    Variation("longer build-up", "fill_time", (1.0, 1.5, 2.0, 3.0, 4.0, 5.0), unit="s"),
    Variation("earlier command", "lead", (0.1, 0.2, 0.3, 0.4, 0.6, 1.0), unit="s"),
    Variation(
        "cleaning, energy",
        "cleaning_energy",
        (42400.0, 21200.0, 10600.0, 5300.0, 2650.0, 1325.0),
        1e3,
        "kJ/m",
        MappingProxyType({"carry_over": 0.5}),
    ),
    Variation(
        "dry track first, up to",
        "place",
        (10.0, 30.0, 50.0, 70.0, 90.0, 110.0, 130.0, 150.0, 170.0),
        unit="m",
        together=MappingProxyType({"shape": "dry first"}),
    ),
    Variation(
        "dry track last, from",
        "place",
        (190.0, 170.0, 150.0, 130.0, 110.0, 90.0),
        unit="m",
        together=MappingProxyType({"shape": "dry last"}),
    ),
)


@dataclass(frozen=True, slots=True)
class Point:
    """A value of an assumption: the friction with which it comes closest to the real train, and that stop."""

    value: float
    assumptions: Assumptions
    stop: FieldStop


@dataclass(frozen=True, slots=True)
class Varied:
    """The points of a variation, in the order of its values."""

    variation: Variation
    points: Sequence[Point]

    @property
    def agreeing(self) -> list[Point]:
        """The points whose stop agrees with the real train's."""
        return [point for point in self.points if point.stop.agrees]

    @property
    def closest(self) -> Point:
        """The point with the least misfit."""
        return min(self.points, key=lambda point: point.stop.misfit)


def plainest(field_rig: FieldRig) -> Assumptions:
    """Return the assumptions to which one is added; their friction is that of the rail's first trial."""
    return Assumptions("constant", FRICTIONS[0], 0.0, "ep-disc", field_rig.build_up("ep-disc"))


def one_at_a_time(
    field_rig: FieldRig, variations: Sequence[Variation] = VARIATIONS
) -> tuple[Point, list[Varied]]:
    """Return the closest stop without any further assumption, and every variation's."""
    base = plainest(field_rig)
    values = [float("nan"), *(value for each in variations for value in each.values)]
    changed = [base, *(each.added_to(base, value) for each in variations for value in each.values)]
    coarse = _closest(field_rig, [[replace(one, friction=mu) for mu in FRICTIONS] for one in changed])
    about = [[replace(one, friction=one.friction + off) for off in FINER] for one, _ in coarse]
    points = iter(Point(value, *pair) for value, pair in zip(values, _closest(field_rig, about), strict=True))
    return next(points), [Varied(each, [next(points) for _ in each.values]) for each in variations]


def _closest(
    field_rig: FieldRig, groups: Sequence[Sequence[Assumptions]]
) -> list[tuple[Assumptions, FieldStop]]:
    """Return, of each group of assumptions, those with the least misfit and their stop."""
    stops = iter(field_rig.stops([each for group in groups for each in group]))
    pairs = [[(each, next(stops)) for each in group] for group in groups]
    return [min(group, key=lambda pair: pair[1].misfit) for group in pairs]
