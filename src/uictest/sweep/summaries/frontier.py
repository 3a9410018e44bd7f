"""Where the verdict flips along one parameter, for every combination of the others."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.scenario import Setting, value_label
from uictest.scenario.yaml import Document, Entry, Place, Quantity, Scalar, parse_quantity
from uictest.sweep.plan.decimal_quantity import (
    DecimalQuantity,
    common_unit,
    parse_decimal_quantity,
    quantity_text,
    rounded_decimal,
)
from uictest.sweep.plan.plan import ListedGroup, ParameterValue, Plan
from uictest.units import KINDS

UNKNOWN: Final = -1
"""Verdict of a case that was not run."""
Verdicts = NDArray[np.int8]
"""1 met, 0 not met, -1 unknown."""
Judge = Callable[[Plan, NDArray[np.int64]], Verdicts]
_FINEST: Final = 64
"""Parts that the smallest step of the scan is divided into where no tolerance is stated."""


class FrontierError(ValueError):
    """The parameter has no frontier that could be looked for; the message says why."""


@dataclass(frozen=True)
class Flip:
    """Two neighbouring values with different verdicts; the verdict flips between them."""

    low: str
    high: str
    met_at_low: bool


@dataclass(frozen=True)
class FrontierScan:
    """What was found along the parameter for one combination of the others."""

    circumstances: dict[str, str]
    flips: tuple[Flip, ...]
    note: str


@dataclass
class _Bracket:
    """An interval that a flip lies in, halved until it is small enough."""

    combination: int
    low: Decimal
    high: Decimal
    met_at_low: bool


class FrontierSearch:
    """The search along one parameter; the values that the sweep has for it are the scan."""

    def __init__(self, plan: Plan, key: str, tolerance: DecimalQuantity | None = None) -> None:
        """Raises FrontierError."""
        self.plan, self.key = plan, key
        self._place, self._group = _scanned(plan, key)
        self._amounts = [parse_decimal_quantity(row[0].text) for row in self._group.rows]
        unit = common_unit(self._amounts)
        if unit is None:
            raise FrontierError(f"the values of {key} have different units")
        if tolerance is not None and (tolerance.unit != unit or tolerance.number <= 0):
            raise FrontierError(
                f"the tolerance must be above zero and in {unit or 'no unit'}, as {key} is written"
            )
        self.unit = unit
        self._order = sorted(range(len(self._amounts)), key=lambda k: self._amounts[k].number)
        numbers = [self._amounts[k].number for k in self._order]
        smallest = min(b - a for a, b in pairwise(numbers))
        self.tolerance = tolerance.number if tolerance else smallest / _FINEST

    def run(self, verdicts: Verdicts, judge: Judge) -> list[FrontierScan]:
        """Return what is found for every combination of the other parameters.

        Args:
            verdicts: of every case of the plan.
            judge: gives the verdicts of further cases: those of a plan with the given indices.
        """
        scanned = self._scanned_verdicts(verdicts)
        brackets = [found for number, row in enumerate(scanned) for found in self._brackets(number, row)]
        self._narrow(brackets, judge)
        return [self._stretch(number, row, brackets) for number, row in enumerate(scanned)]

    def _scanned_verdicts(self, verdicts: Verdicts) -> Verdicts:
        """Return the verdicts by combination of the others and rising value of the parameter."""
        cube = np.moveaxis(verdicts.reshape([group.size for group in self.plan.groups]), self._place, -1)
        return cube.reshape(-1, self._group.size)[:, self._order]

    def _brackets(self, combination: int, row: Verdicts) -> list[_Bracket]:
        numbers = [self._amounts[k].number for k in self._order]
        return [
            _Bracket(combination, numbers[k], numbers[k + 1], bool(row[k]))
            for k in range(row.size - 1)
            if UNKNOWN not in (row[k], row[k + 1]) and row[k] != row[k + 1]
        ]

    def _narrow(self, brackets: Sequence[_Bracket], judge: Judge) -> None:
        """Halve all brackets together, so that one batch of stops serves all of them."""
        while wide := [each for each in brackets if each.high - each.low > self.tolerance]:
            middles = [rounded_decimal(float((each.low + each.high) / 2)) for each in wide]
            plan, indices = self._cases([each.combination for each in wide], middles)
            for each, middle, met in zip(wide, middles, judge(plan, indices).tolist(), strict=True):
                if bool(met) == each.met_at_low:
                    each.low = middle
                else:
                    each.high = middle

    def _cases(
        self, combinations: Sequence[int], numbers: Sequence[Decimal]
    ) -> tuple[Plan, NDArray[np.int64]]:
        """Return a plan with the given values of the parameter, and the indices of the cases meant."""
        distinct = sorted(set(numbers))
        group = ListedGroup((self.key,), tuple((self._value(number),) for number in distinct))
        groups = list(self.plan.groups)
        others = [each.size for place, each in enumerate(groups) if place != self._place]
        groups[self._place] = group
        rows = list(np.unravel_index(np.array(combinations), others)) if others else []
        rows.insert(self._place, np.array([distinct.index(number) for number in numbers]))
        indices = np.ravel_multi_index(rows, [each.size for each in groups])
        return replace(self.plan, groups=tuple(groups)), np.asarray(indices, np.int64)

    def _value(self, number: Decimal) -> ParameterValue:
        text = quantity_text(number, self.unit)
        like = self._group.rows[0][0].content
        place = Place(Document("--frontier", Path(), text))
        setting = Setting(self.key, Entry(place, Scalar(text, text, place)), 1)
        return ParameterValue(text, parse_quantity(text, _kind_of(like, self.unit)), value_label(setting))

    def _stretch(self, number: int, row: Verdicts, brackets: Sequence[_Bracket]) -> FrontierScan:
        flips = tuple(
            Flip(quantity_text(each.low, self.unit), quantity_text(each.high, self.unit), each.met_at_low)
            for each in brackets
            if each.combination == number
        )
        return FrontierScan(self._circumstances(number), flips, _note(row, len(flips)))

    def _circumstances(self, combination: int) -> dict[str, str]:
        plan, indices = self._cases([combination], [self._amounts[0].number])
        return {key: values[0].text for key, values in plan.settings(indices).items() if key != self.key}


def _scanned(plan: Plan, key: str) -> tuple[int, ListedGroup]:
    for place, group in enumerate(plan.groups):
        if group.keys != (key,):
            continue
        if isinstance(group, ListedGroup) and group.size > 1:
            if all(isinstance(row[0].content, Quantity) for row in group.rows):
                return place, group
            raise FrontierError(f"{key} is no quantity")
    listed = ", ".join(each for each, values in plan.listed().items() if len(values) > 1) or "none"
    raise FrontierError(f"{key} needs two values or more under grid or ranges; there are: {listed}")


def _kind_of(like: Quantity, unit: str) -> str:
    """Return a kind of quantity in which the unit means what it means for a value at hand."""
    kinds = (kind for kind in KINDS.values() if kind.canonical == like.unit)
    return next(kind.name for kind in kinds if (unit in kind.units if unit else kind.bare))


def _note(row: Verdicts, flips: int) -> str:
    if UNKNOWN in row:
        return "some cases were not run"
    if flips == 0:
        return f"met at all {row.size} values" if row[0] else f"met at none of the {row.size} values"
    return "" if flips == 1 else f"flips {flips} times"
