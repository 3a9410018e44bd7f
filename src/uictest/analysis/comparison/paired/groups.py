"""The stops of one side in groups: those that differ in nothing but the variant and the seed."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from uictest.analysis.comparison.paired.drawn_stops import Draw, Figures, drawn_stops
from uictest.judging.evaluation import CaseResult
from uictest.judging.series import SeriesResult, SpeedResult


@dataclass(frozen=True, slots=True)
class Side:
    """One side of a comparison: a run, or one variant in it."""

    name: str
    cases: Sequence[CaseResult]
    series: Sequence[SeriesResult] = ()


class GroupKey(NamedTuple):
    """What the stops of one group have in common; `speed_kmh` is None for cases, `rail` as in a series."""

    name: str
    parameters: frozenset[tuple[str, str]]
    speed_kmh: float | None = None
    rail: str = ""


@dataclass(frozen=True, slots=True)
class Group:
    """The stops of a group; `name` is for readers."""

    name: str
    stops: dict[Draw, Figures] = field(default_factory=dict)


def groups_of(side: Side, varied: Collection[str]) -> dict[GroupKey, Group]:
    """Return the groups of a side; `varied` are the keys in which the variants differ.

    Cases that differ in nothing but these and their seed are one group, and so are the wet stops of a series
    from one speed that count.
    """
    groups: dict[GroupKey, Group] = {}
    for case in side.cases:
        key = _key(case, {*varied, "seed"})
        groups.setdefault(key, Group(_name(case, key))).stops.update(drawn_stops(case))
    for series in side.series:
        key = _key(series, varied)
        for speed in series.speeds:
            name = f"{_name(series, key)}, wet stops from {speed.place}"
            place = key._replace(speed_kmh=speed.speed_kmh, rail=speed.rail)
            groups[place] = Group(name, _wet_stops(series, speed))
    return groups


def _wet_stops(series: SeriesResult, speed: SpeedResult) -> dict[Draw, Figures]:
    """Return the wet stops from a speed, and on its rail, that count."""
    not_counted = {(stop.case, stop.seed) for stop in series.not_counted}
    return {
        draw: figures
        for each in series.cases
        if (each.role, each.speed_kmh) == ("wet", speed.speed_kmh) and speed.rail in ("", each.rail)
        for draw, figures in drawn_stops(each.case, each.case.id.removeprefix(f"{series.id}."))
        # A stop that is not repeated stands there without its seed.
        if not_counted.isdisjoint({(each.case.id, draw.seed), (each.case.id, None)})
    }


def _key(item: CaseResult | SeriesResult, left_out: Collection[str]) -> GroupKey:
    kept = ((key, value) for key, value in item.parameters.items() if key not in left_out)
    return GroupKey(item.id.partition("[")[0], frozenset(kept))


def _name(item: CaseResult | SeriesResult, key: GroupKey) -> str:
    """Return the id with the values alone that the whole group has."""
    shown = [f"{name}={value}" for name, value in item.parameters.items() if (name, value) in key.parameters]
    return f"{key.name}[{','.join(shown)}]" if shown else key.name
