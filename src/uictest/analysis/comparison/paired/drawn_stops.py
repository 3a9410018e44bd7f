"""Single stops, each under the noise that it met."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from uictest.core.measures import column_unit
from uictest.judging import evaluation

LARGEST: Final = "largest_"
"""Before the name of a column of wheelsets: its largest value of the four."""

_BALANCES: Final = frozenset({"energy_residual", "air_residual", "air_energy_residual"})
"""Columns that check the simulation and say nothing of the stop."""

_SPREADS: Final = ("rail.variation.spread", "rail.condition.variation.spread")
"""Keys of the spread of a random rail; the first replaces the second."""

Figures = Mapping[str, float]
"""Quantities of one stop -> number in the unit of the column, NaN where there is none."""


@dataclass(frozen=True, slots=True)
class Draw:
    """What two stops must share to be a pair.

    `conditions` tells the stops of a series apart; it is empty for the stops of one case. `noise_key` is
    empty where it is not known. `random_rail` says whether friction varies at random, by the seed alone.
    """

    conditions: str
    noise_key: str
    seed: int | None
    random_rail: bool = field(default=False, compare=False)


def drawn_stops(case: evaluation.CaseResult, conditions: str = "") -> Iterator[tuple[Draw, Figures]]:
    """Yield the stops of a case that have measures: a case without repeats is one stop."""
    random_rail = _has_random_rail(case)
    for seed, measures, wheelsets in _stops(case):
        if measures is not None:
            yield Draw(conditions, case.noise_key, seed, random_rail), _figures(measures, wheelsets)


def _has_random_rail(case: evaluation.CaseResult) -> bool:
    spreads = {
        each.key: each.value
        for part in case.parts.values()
        for each in part.parameters
        if each.key in _SPREADS
    }
    return next((bool(spreads[key]) for key in _SPREADS if key in spreads), False)


def quantity_unit(quantity: str) -> str:
    """Return the unit of a quantity of stops."""
    return column_unit(quantity.removeprefix(LARGEST))


Observed = tuple[int | None, Mapping[str, float] | None, tuple[Mapping[str, float], ...]]


def _stops(case: evaluation.CaseResult) -> Iterator[Observed]:
    if case.repeats is None:
        yield _seed_of(case), case.measures, case.wheelsets
    else:
        yield from ((stop.seed, stop.measures, stop.wheelsets) for stop in case.repeats.stops)


def _seed_of(case: evaluation.CaseResult) -> int | None:
    """Return the seed of a case with one stop; None where its parameters are not known."""
    part = case.parts.get("scenario")
    values = [each.value for each in part.parameters if each.key == "seed"] if part else []
    return int(values[0]) if values else None


def _figures(measures: Mapping[str, float], wheelsets: tuple[Mapping[str, float], ...]) -> Figures:
    of_stop = {name: value for name, value in measures.items() if name not in _BALANCES}
    columns = wheelsets[0] if wheelsets else ()
    return of_stop | {f"{LARGEST}{name}": _largest([each[name] for each in wheelsets]) for name in columns}


def _largest(values: list[float]) -> float:
    return math.nan if any(map(math.isnan, values)) else max(values)
