"""The domain in which a model was validated, and what of other stops lies outside of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from uictest.analysis.validation.conditions import Conditions, Range
from uictest.judging.evaluation import Deviation

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
        conditions = _joined(each)
        place = next((k for k, known in enumerate(domains) if _alike(known.conditions, conditions)), None)
        if place is None:
            domains.append(Domain(1, conditions))
        else:
            known = domains[place]
            domains[place] = Domain(known.stops + 1, _joined((known.conditions, conditions)))
    return tuple(domains)


def deviations(domains: Sequence[Domain], conditions: Conditions) -> tuple[Deviation, ...]:
    """Return what of a stop lies outside of the domain that it comes nearest to; nothing inside of one.

    Raises ValueError without any domain.
    """
    return min((tuple(outside_of(domain.conditions, conditions)) for domain in domains), key=len)


def outside_of(validated: Conditions, stop: Conditions) -> Iterator[Deviation]:
    """Yield what of a stop lies outside of conditions; of a part of another name the name alone."""
    yield from _different(validated.names, stop.names)
    inside = inside_of_other_parts(validated, stop)
    for each in (*_different(validated.settings, stop.settings), *_beyond(validated.ranges, stop.ranges)):
        if not each.key.startswith(inside):
            yield each


def inside_of_other_parts(validated: Conditions, stop: Conditions) -> tuple[str, ...]:
    """Return how the keys inside of parts of another name begin: they need no line of their own."""
    return tuple(f"{each.key}." for each in _different(validated.names, stop.names))


def _different(validated: Mapping[str, str], stop: Mapping[str, str]) -> Iterator[Deviation]:
    for key in dict.fromkeys((*stop, *validated)):
        if stop.get(key) != validated.get(key):
            yield Deviation(key, stop.get(key), validated.get(key))


def _beyond(validated: Mapping[str, Range], stop: Mapping[str, Range]) -> Iterator[Deviation]:
    for key in dict.fromkeys((*stop, *validated)):
        found, bounds = stop.get(key), validated.get(key)
        if found is None or bounds is None or not bool(holds(bounds, found.lowest, found.highest)):
            unit = (found or bounds or Range(0.0, 0.0, "")).unit
            yield Deviation(key, _ends(found), _ends(bounds), unit)


def holds(bounds: Range, lowest: Any, highest: Any) -> Any:
    """Return whether an interval holds another one, or each of several that are given as arrays."""
    slack = _ROUNDING * max(abs(bounds.lowest), abs(bounds.highest))
    return (bounds.lowest - slack <= lowest) & (highest <= bounds.highest + slack)


def _ends(interval: Range | None) -> tuple[float, float] | None:
    return None if interval is None else (interval.lowest, interval.highest)


def _alike(one: Conditions, other: Conditions) -> bool:
    same = one.names == other.names and one.settings == other.settings
    return same and one.ranges.keys() == other.ranges.keys()


def _joined(stops: Sequence[Conditions]) -> Conditions:
    """Return conditions whose intervals hold those of all of these, which are alike."""
    first, *others = stops
    ranges = dict(first.ranges)
    for other in others:
        ranges = {key: each.joined(other.ranges[key]) for key, each in ranges.items()}
    return Conditions(first.names, first.settings, ranges)
