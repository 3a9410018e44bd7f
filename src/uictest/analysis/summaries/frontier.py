"""Search where the verdict flips along one parameter, for every combination of the others."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.plans.scenario import Setting, value_label
from uictest.plans.scenario.yaml import (
    DecimalQuantity,
    Document,
    Entry,
    Location,
    Quantity,
    Scalar,
    common_unit,
    parse_decimal_quantity,
    quantity_text,
    rounded_decimal,
)
from uictest.plans.sweeps import ListedGroup, ParameterValue, Plan, content_of, is_free, kind_of
from uictest.report import Flip, FrontierScan, WrittenValue
from uictest.running.campaign import map_on_threads
from uictest.running.chunked import ChunkRunner

UNKNOWN: Final = -1
"""Verdict of a case that was not run."""
Verdicts = NDArray[np.int8]
"""1 met, 0 not met, -1 unknown."""
Judge = Callable[[Plan, NDArray[np.int64]], Verdicts]
_FINEST: Final = 64
"""Fraction of the smallest step of the scan that is the tolerance where none is stated."""
_CASES_AT_ONCE: Final = 256


class FrontierError(ValueError):
    """No frontier can be searched along the parameter; the message says why."""


@dataclass
class _Bracket:
    """An interval that contains a flip, halved until it is as narrow as the tolerance."""

    combination: int
    low: Decimal
    high: Decimal
    met_at_low: bool


class FrontierSearch:
    """The search along one parameter; the values that the sweep has for it are the scan."""

    def __init__(self, plan: Plan, key: str, tolerance: DecimalQuantity | None = None) -> None:
        """Raises FrontierError."""
        self.plan, self.key = plan, key
        self._place, self._group = _scanned_group(plan, key)
        self._scanned_values = [parse_decimal_quantity(row[0].text) for row in self._group.rows]
        unit = common_unit(self._scanned_values)
        if unit is None:
            raise FrontierError(f"the values of {key} have different units")
        if tolerance is not None and (tolerance.unit != unit or tolerance.number <= 0):
            raise FrontierError(
                f"the tolerance must be above zero and in {unit or 'no unit'}, as {key} is written"
            )
        self.unit = unit
        self._order = sorted(range(len(self._scanned_values)), key=lambda k: self._scanned_values[k].number)
        numbers = [self._scanned_values[k].number for k in self._order]
        smallest = min(b - a for a, b in pairwise(numbers))
        self.tolerance = tolerance.number if tolerance else smallest / _FINEST

    def run(self, verdicts: Verdicts, judge: Judge) -> list[FrontierScan]:
        """Return the flips for every combination of the other parameters.

        Args:
            verdicts: verdicts of every case of the plan.
            judge: gives the verdicts of further cases: those of a plan with the given indices.
        """
        # By combination of the others and rising value of the parameter.
        cube = np.moveaxis(verdicts.reshape([group.size for group in self.plan.groups]), self._place, -1)
        scanned = cube.reshape(-1, self._group.size)[:, self._order]
        brackets = [
            bracket for number, row in enumerate(scanned) for bracket in self._brackets_in_row(number, row)
        ]
        self._halve_brackets(brackets, judge)
        return [self._frontier_scan(number, row, brackets) for number, row in enumerate(scanned)]

    def _brackets_in_row(self, combination: int, row: Verdicts) -> list[_Bracket]:
        numbers = [self._scanned_values[k].number for k in self._order]
        return [
            _Bracket(combination, numbers[k], numbers[k + 1], bool(row[k]))
            for k in range(row.size - 1)
            if UNKNOWN not in (row[k], row[k + 1]) and row[k] != row[k + 1]
        ]

    def _halve_brackets(self, brackets: Sequence[_Bracket], judge: Judge) -> None:
        """Halve all brackets together, so that one batch of stops serves all of them."""
        while wide := [each for each in brackets if each.high - each.low > self.tolerance]:
            middles = [rounded_decimal(float((each.low + each.high) / 2)) for each in wide]
            plan, indices = self._plan_with_values([each.combination for each in wide], middles)
            for each, middle, met in zip(wide, middles, judge(plan, indices).tolist(), strict=True):
                if bool(met) == each.met_at_low:
                    each.low = middle
                else:
                    each.high = middle

    def _plan_with_values(
        self, combinations: Sequence[int], numbers: Sequence[Decimal]
    ) -> tuple[Plan, NDArray[np.int64]]:
        """Return a plan in which the parameter has these values, and the indices of its cases."""
        distinct = sorted(set(numbers))
        group = ListedGroup((self.key,), tuple((self._parameter_value(number),) for number in distinct))
        groups = list(self.plan.groups)
        other_sizes = [each.size for index, each in enumerate(groups) if index != self._place]
        groups[self._place] = group
        rows = list(np.unravel_index(np.array(combinations), other_sizes)) if other_sizes else []
        rows.insert(self._place, np.array([distinct.index(number) for number in numbers]))
        indices = np.ravel_multi_index(rows, [each.size for each in groups])
        return replace(self.plan, groups=tuple(groups)), np.asarray(indices, np.int64)

    def _parameter_value(self, number: Decimal) -> ParameterValue:
        text = quantity_text(number, self.unit)
        example = self._group.rows[0][0].content
        location = Location(Document("--frontier", Path(), text))
        setting = Setting(self.key, Entry(location, Scalar(text, text, location)), 1)
        return ParameterValue(text, content_of(text, kind_of(example, self.unit)), value_label(setting))

    def _frontier_scan(self, number: int, row: Verdicts, brackets: Sequence[_Bracket]) -> FrontierScan:
        flips = tuple(
            Flip(
                WrittenValue(quantity_text(bracket.low, self.unit)),
                WrittenValue(quantity_text(bracket.high, self.unit)),
                bracket.met_at_low,
            )
            for bracket in brackets
            if bracket.combination == number
        )
        plan, indices = self._plan_with_values([number], [self._scanned_values[0].number])
        settings = plan.settings(indices).items()
        circumstances = {key: WrittenValue(values[0].text) for key, values in settings if key != self.key}
        return FrontierScan(circumstances, flips, _flip_note(row, len(flips)))


def _scanned_group(plan: Plan, key: str) -> tuple[int, ListedGroup]:
    for index, group in enumerate(plan.groups):
        if group.keys == (key,) and isinstance(group, ListedGroup) and group.size > 1:
            if all(_is_continuous(plan, key, row[0].content) for row in group.rows):
                return index, group
            raise FrontierError(f"{key} is not a quantity")
    listed = ", ".join(each for each, values in plan.listed().items() if len(values) > 1) or "none"
    raise FrontierError(f"{key} needs two values or more under `matrix` or `ranges`; there are: {listed}")


def _is_continuous(plan: Plan, key: str, content: Any) -> bool:
    """Return whether a value is a quantity, or a number whose meaning only the controller knows."""
    if isinstance(content, Quantity):
        return True
    is_number = isinstance(content, float | int) and not isinstance(content, bool)
    return is_number and is_free(plan.base.scenario, key)


def _flip_note(row: Verdicts, flips: int) -> str:
    if UNKNOWN in row:
        return "some cases were not run"
    if flips == 0:
        return f"met at all {row.size} values" if row[0] else f"met at none of the {row.size} values"
    return "" if flips == 1 else f"flips {flips} times"


def verdicts_of(plan: Plan, indices: NDArray[np.int64], runner: ChunkRunner, jobs: int) -> Verdicts:
    """Return 1 for each case with the given indices that meets its expectation, else 0.

    `runner` is that of another plan of the same sweep.
    """
    runner = runner.of_plan(plan)

    def met(block: NDArray[np.int64]) -> list[bool]:
        results, _ = runner.results(block, plan.settings(block))
        return [result.met for result in results]

    blocks = np.array_split(indices, max(jobs, -(-indices.size // _CASES_AT_ONCE)))
    verdicts = map_on_threads(met, [block for block in blocks if block.size], jobs=jobs)
    return np.array([each for block in verdicts for each in block], np.int8)
