"""Tolerances, the comparison of two numbers, and which cases a run selects."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from fnmatch import fnmatchcase
from pathlib import PurePosixPath
from typing import NamedTuple

from uictest.report import Difference

_WRITTEN = re.compile(r"(?:(?P<name>[^=]+)=)?(?P<number>[\d.]+(?:[eE][+-]?\d+)?)\s*(?P<per_cent>%?)")


class Tolerance(NamedTuple):
    """An allowance: the larger of `absolute` (in the unit of what is compared) and `relative` times a range.

    The range is the larger one that a channel has in two recordings; for single numbers the larger magnitude.
    """

    absolute: float
    relative: float

    def allowed(self, extent: float) -> float:
        """Return the largest difference allowed between two values with this range."""
        return max(self.absolute, self.relative * extent if math.isfinite(extent) else 0.0)


DEFAULT = Tolerance(absolute=1e-6, relative=1e-3)
"""Chosen: far below what an engineer would act on, far above the rounding of different compilers."""


class Tolerances(NamedTuple):
    """A tolerance for everything, and others for quantities whose name matches a pattern; the last wins."""

    general: Tolerance = DEFAULT
    special: tuple[tuple[str, Tolerance], ...] = ()

    def of(self, quantity: str) -> Tolerance:
        """Return the tolerance of a quantity."""
        matching = (tolerance for name, tolerance in reversed(self.special) if fnmatchcase(quantity, name))
        return next(matching, self.general)

    def names(self, quantity: str) -> bool:
        """Return whether a tolerance was given for a quantity by its name, not only for everything."""
        return any(fnmatchcase(quantity, name) for name, _ in self.special)

    @classmethod
    def read(cls, texts: Iterable[str]) -> Tolerances:
        """Return the tolerances that texts like `0.5 %`, `braking_*=2` and `slide_1=0.01` stand for.

        A bare number is absolute, one with a per cent sign relative; both may be set for the same name. An
        absolute part that is not set has its default, so that the last digits of a number near zero do not
        count; a relative part that is not set is 0. Raises ValueError naming the text that cannot be read.
        """
        parts_by_name: dict[str | None, dict[str, float]] = {}
        for text in texts:
            name, part, number = _parsed_tolerance(text)
            # To the end: the last pattern that matches counts.
            parts_by_name[name] = {**parts_by_name.pop(name, {}), part: number}
        tolerances = {
            name: Tolerance(parts.get("absolute", DEFAULT.absolute), parts.get("relative", 0.0))
            for name, parts in parts_by_name.items()
        }
        general = tolerances.pop(None, DEFAULT)
        return cls(general, tuple((name, each) for name, each in tolerances.items() if name is not None))


def _parsed_tolerance(text: str) -> tuple[str | None, str, float]:
    """Return the name, the part (absolute or relative) and the number of a tolerance."""
    match = _WRITTEN.fullmatch(text.strip())
    try:
        number = float(match["number"]) if match else math.nan
    except ValueError:
        number = math.nan
    if match is None or not math.isfinite(number):
        raise ValueError(f"{text!r} is not a tolerance; write '0.5' (absolute), '1%' (relative) or NAME=...")
    name = match["name"] and match["name"].strip()
    return (name, "relative", number / 100) if match["per_cent"] else (name, "absolute", number)


def compare_numbers(
    case: str, quantity: str, first: float, second: float, tolerances: Tolerances, unit: str = ""
) -> Difference | None:
    """Return the difference of two numbers, None where they are the same. NaN equals NaN alone."""
    if first == second or (math.isnan(first) and math.isnan(second)):
        return None
    if not (math.isfinite(first) and math.isfinite(second)):
        remark = "there is one on one side only"
        return Difference(case, quantity, first, second, within=False, unit=unit, remark=remark)
    deviation = abs(second - first)
    allowed = tolerances.of(quantity).allowed(max(abs(first), abs(second)))
    return Difference(case, quantity, first, second, deviation <= allowed, unit, deviation, allowed)


class Scope(NamedTuple):
    """The cases and series that a run selects.

    Args:
        selected: ids of the cases and series to be run.
        searched: scenario files and folders of which every case was selected; none where an expression, a tag
            or the last failures chose among them.

    """

    selected: frozenset[str]
    searched: Sequence[str] = ()

    def misses(self, own_id: str, file: str) -> bool:
        """Return whether the files searched should contain a case or a series and do not."""
        path = PurePosixPath(file)
        places = (path, *path.parents)
        return own_id not in self.selected and any(PurePosixPath(name) in places for name in self.searched)
