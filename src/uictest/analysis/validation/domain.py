"""The domain of a validation, and what of a case, or of many in columns, lies outside of it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.judging.evaluation import Deviation, EffectivePart, Parameter

_JUDGING_ROLES: Final = ("criteria", "measures")
"""Roles of parts that say how a stop is judged, not how it goes."""
_NO_CONDITIONS: Final = ("seed", "simulation.maximum_duration")
"""Keys that say nothing of the conditions."""
_FRICTION: Final = re.compile(r"rail\.friction(\.points\.\d+\.friction)?")
_FRICTION_OF_CONDITION: Final = "rail.condition.friction"
_FACTOR: Final = re.compile(r"rail\.friction_over_time\.points\.\d+\.factor")
_COURSE: Final = ("rail.friction", "rail.friction_over_time")
"""What describes the course of the friction, of which the lowest and the highest value count."""


@dataclass(frozen=True, slots=True)
class Range:
    """An interval of a number, both ends belong to it; `unit` is SI."""

    lowest: float
    highest: float
    unit: str

    def joined(self, other: Range) -> Range:
        """Return the smallest interval that holds both."""
        return Range(min(self.lowest, other.lowest), max(self.highest, other.highest), self.unit)


@dataclass(frozen=True, slots=True)
class Conditions:
    """What a stop was run under.

    Attributes:
        names: names of its parts, by where they stand in a scenario.
        settings: texts and truth values by key.
        ranges: numbers by key.
    """

    names: Mapping[str, str] = field(default_factory=dict)
    settings: Mapping[str, str] = field(default_factory=dict)
    ranges: Mapping[str, Range] = field(default_factory=dict)


def is_condition(key: str) -> bool:
    """Return whether a key of a scenario may describe the conditions of a stop."""
    return key not in _NO_CONDITIONS and key.partition(".")[0] not in _JUDGING_ROLES


def conditions_of(parts: Mapping[str, EffectivePart]) -> Conditions:
    """Return the conditions that the parts of a simulated stop, by role, make up."""
    used = [part for role, part in parts.items() if role.partition(".")[0] not in _JUDGING_ROLES]
    parameters = [each for part in used for each in part.parameters if each.key not in _NO_CONDITIONS]
    beyond_friction = [each for each in parameters if not _describes_friction(each.key)]
    numbers = {each.key: (float(each.value), each.unit) for each in beyond_friction if _is_number(each)}
    ranges = {key: Range(value, value, unit) for key, (value, unit) in numbers.items()}
    return Conditions(
        names={part.key: part.name for part in used if part.name},
        settings={each.key: str(each.value) for each in beyond_friction if not _is_number(each)},
        ranges={**ranges, "rail.friction": _friction_range(parameters)},
    )


def _friction_range(parameters: Iterable[Parameter]) -> Range:
    """Return the initial friction coefficient of the rail, everywhere and at any time."""
    values = {each.key: float(each.value) for each in parameters if _is_number(each)}
    along = list(_matching(values, _FRICTION)) or [values[_FRICTION_OF_CONDITION]]
    over_time = list(_matching(values, _FACTOR)) or [1.0]
    return Range(min(along) * min(over_time), max(along) * max(over_time), "1")


def _matching(values: Mapping[str, float], key: re.Pattern[str]) -> Iterator[float]:
    return (value for name, value in values.items() if key.fullmatch(name))


def _describes_friction(key: str) -> bool:
    in_scenario = any(key == each or key.startswith(f"{each}.") for each in _COURSE)
    return in_scenario or key == _FRICTION_OF_CONDITION


def _is_number(parameter: Parameter) -> bool:
    return isinstance(parameter.value, float | int) and not isinstance(parameter.value, bool)


_ROUNDING: Final = 1e-9
"""Relative: a number that is written with another unit may differ in its last bit."""


@dataclass(frozen=True, slots=True)
class Domain:
    """Stops with the same parts and settings: their number, and the interval of each number among them.

    Each interval stands alone: not every combination inside of all was among the stops.
    """

    stops: int
    conditions: Conditions


def domains_of(stops: Iterable[Sequence[Conditions]]) -> tuple[Domain, ...]:
    """Return the domains of stops, each with its conditions as planned and as recorded."""
    domains: list[Domain] = []
    for each in stops:
        conditions = _spanning_conditions(each)
        for index, domain in enumerate(domains):
            if _same_parts_and_settings(domain.conditions, conditions):
                spanned = _spanning_conditions((domain.conditions, conditions))
                domains[index] = Domain(domain.stops + 1, spanned)
                break
        else:
            domains.append(Domain(1, conditions))
    return tuple(domains)


def deviations(domains: Sequence[Domain], conditions: Conditions) -> tuple[Deviation, ...]:
    """Return the deviations of a stop from the domain that it comes nearest to; none inside of a domain.

    Raises ValueError without any domain.
    """
    return min((tuple(outside_of(domain.conditions, conditions)) for domain in domains), key=len)


def outside_of(validated: Conditions, stop: Conditions) -> Iterator[Deviation]:
    """Yield the deviations of a stop from validated conditions; of a part of another name the name alone."""
    yield from _changed_entries(validated.names, stop.names)
    inside = inside_of_other_parts(validated, stop)
    settings = _changed_entries(validated.settings, stop.settings)
    for deviation in (*settings, *_ranges_beyond(validated.ranges, stop.ranges)):
        if not deviation.key.startswith(inside):
            yield deviation


def inside_of_other_parts(validated: Conditions, stop: Conditions) -> tuple[str, ...]:
    """Return the prefixes of the keys inside of parts of another name: these need no line of their own."""
    return tuple(f"{each.key}." for each in _changed_entries(validated.names, stop.names))


def _changed_entries(validated: Mapping[str, str], stop: Mapping[str, str]) -> Iterator[Deviation]:
    for key in dict.fromkeys((*stop, *validated)):
        if stop.get(key) != validated.get(key):
            yield Deviation(key, stop.get(key), validated.get(key))


def _ranges_beyond(validated: Mapping[str, Range], stop: Mapping[str, Range]) -> Iterator[Deviation]:
    for key in dict.fromkeys((*stop, *validated)):
        found, bounds = stop.get(key), validated.get(key)
        if found is None or bounds is None or not bool(holds(bounds, found.lowest, found.highest)):
            unit = (found or bounds or Range(0.0, 0.0, "")).unit
            yield Deviation(key, _interval_ends(found), _interval_ends(bounds), unit)


def holds(bounds: Range, lowest: Any, highest: Any) -> Any:
    """Return whether an interval holds another one, or each of several that are given as arrays."""
    slack = _ROUNDING * max(abs(bounds.lowest), abs(bounds.highest))
    return (bounds.lowest - slack <= lowest) & (highest <= bounds.highest + slack)


def _interval_ends(interval: Range | None) -> tuple[float, float] | None:
    return None if interval is None else (interval.lowest, interval.highest)


def _same_parts_and_settings(one: Conditions, other: Conditions) -> bool:
    same = one.names == other.names and one.settings == other.settings
    return same and one.ranges.keys() == other.ranges.keys()


def _spanning_conditions(stops: Sequence[Conditions]) -> Conditions:
    """Return conditions whose intervals hold those of all of these, which are alike."""
    first, *others = stops
    ranges = dict(first.ranges)
    for other in others:
        ranges = {key: each.joined(other.ranges[key]) for key, each in ranges.items()}
    return Conditions(first.names, first.settings, ranges)


Columns = Mapping[str, NDArray[np.float64]]
"""Key of a number -> its value in each stop, SI."""


@dataclass(frozen=True, slots=True)
class DeviationOfStops:
    """One condition beyond what was validated, and in which of the stops; `found` holds those of all."""

    deviation: Deviation
    stops: NDArray[np.bool_]


def deviations_of_stops(
    domains: Sequence[Domain], stops: int, conditions: Conditions, columns: Columns
) -> Iterator[DeviationOfStops]:
    """Yield the deviations of each stop from the domain that it comes nearest to, as :func:`deviations`.

    Args:
        domains: at least one.
        stops: their number.
        conditions: conditions of one of the stops; the others differ in the numbers of `columns` alone.
        columns: numbers of every stop, by keys that `conditions` have.
    """
    outside = [_Outside.of(domain.conditions, stops, conditions, columns) for domain in domains]
    nearest = np.argmin([each.counts for each in outside], axis=0)
    for place, each in enumerate(outside):
        yield from each.deviations(nearest == place, conditions, columns)


@dataclass(frozen=True, slots=True)
class _Outside:
    """What of stops lies outside of one domain: the same in all of them, and by number in which."""

    shared: Sequence[Deviation]
    by_key: Mapping[str, NDArray[np.bool_]]
    bounds: Mapping[str, Range]
    counts: NDArray[np.int64]

    @classmethod
    def of(cls, validated: Conditions, stops: int, stop: Conditions, columns: Columns) -> _Outside:
        shared = list(outside_of(_without_columns(validated, columns), _without_columns(stop, columns)))
        inside = inside_of_other_parts(validated, stop)
        by_key = {
            key: _rows_beyond(validated.ranges.get(key), values)
            for key, values in columns.items()
            if not key.startswith(inside)
        }
        counts = np.full(stops, len(shared)) + sum(by_key.values(), np.zeros(stops, np.int64))
        return cls(shared, by_key, validated.ranges, counts)

    def deviations(
        self, nearest: NDArray[np.bool_], stop: Conditions, columns: Columns
    ) -> Iterator[DeviationOfStops]:
        """Yield the deviations of those stops that come nearest to this domain."""
        if nearest.any():
            yield from (DeviationOfStops(each, nearest) for each in self.shared)
        for key, beyond in self.by_key.items():
            stops = beyond & nearest
            if stops.any():
                found = (float(columns[key][stops].min()), float(columns[key][stops].max()))
                bounds = self.bounds.get(key)
                validated = None if bounds is None else (bounds.lowest, bounds.highest)
                yield DeviationOfStops(Deviation(key, found, validated, stop.ranges[key].unit), stops)


def _without_columns(conditions: Conditions, columns: Columns) -> Conditions:
    ranges = {key: each for key, each in conditions.ranges.items() if key not in columns}
    return replace(conditions, ranges=ranges)


def _rows_beyond(bounds: Range | None, values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return a mask of the values outside of the bounds; all of them where there are none."""
    inside: NDArray[np.bool_] = (
        np.zeros(values.size, bool) if bounds is None else holds(bounds, values, values)
    )
    return ~inside
