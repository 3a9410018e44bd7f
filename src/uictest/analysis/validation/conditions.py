"""The conditions of a stop: every number as an interval, every setting as a text, every part by its name."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from uictest.judging.evaluation import EffectivePart, Parameter

_WITHOUT: Final = ("criteria", "measures")
"""Roles of parts that say how a stop is judged, not how it goes."""
_DRAWN: Final = ("seed", "simulation.maximum_duration")
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
        names: of its parts, by where they stand in a scenario.
        settings: texts and truth values by key.
        ranges: numbers by key.
    """

    names: Mapping[str, str] = field(default_factory=dict)
    settings: Mapping[str, str] = field(default_factory=dict)
    ranges: Mapping[str, Range] = field(default_factory=dict)


def is_condition(key: str) -> bool:
    """Return whether a key of a scenario can say something of the conditions of a stop."""
    return key not in _DRAWN and key.partition(".")[0] not in _WITHOUT


def conditions_of(parts: Mapping[str, EffectivePart]) -> Conditions:
    """Return the conditions that the parts of a simulated stop, by role, make up."""
    used = [part for role, part in parts.items() if role.partition(".")[0] not in _WITHOUT]
    parameters = [each for part in used for each in part.parameters if each.key not in _DRAWN]
    others = [each for each in parameters if not _of_friction(each.key)]
    return Conditions(
        names={part.key: part.name for part in used if part.name},
        settings={each.key: str(each.value) for each in others if not _is_number(each)},
        ranges={
            **{each.key: _range(each) for each in others if _is_number(each)},
            "rail.friction": _friction(parameters),
        },
    )


def _friction(parameters: Iterable[Parameter]) -> Range:
    """Return the initial friction coefficient of the rail, everywhere and at any time."""
    values = {each.key: float(each.value) for each in parameters if _is_number(each)}
    along = list(_matching(values, _FRICTION)) or [values[_FRICTION_OF_CONDITION]]
    over_time = list(_matching(values, _FACTOR)) or [1.0]
    return Range(min(along) * min(over_time), max(along) * max(over_time), "1")


def _matching(values: Mapping[str, float], key: re.Pattern[str]) -> Iterator[float]:
    return (value for name, value in values.items() if key.fullmatch(name))


def _of_friction(key: str) -> bool:
    in_scenario = any(key == each or key.startswith(f"{each}.") for each in _COURSE)
    return in_scenario or key == _FRICTION_OF_CONDITION


def _is_number(parameter: Parameter) -> bool:
    return isinstance(parameter.value, float | int) and not isinstance(parameter.value, bool)


def _range(parameter: Parameter) -> Range:
    value = float(parameter.value)
    return Range(value, value, parameter.unit)
