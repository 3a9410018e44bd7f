"""The plan of a sweep: the values of each case, as a function of the number of the case alone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from uictest.scenario import Case
from uictest.scenario.yaml import parse_quantity, scalar_value
from uictest.sweep.plan.decimal_quantity import quantity_text, rounded_decimal
from uictest.sweep.plan.model import Distribution, Method

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class ParameterValue:
    """A value of a parameter: as written, as the scenario holds it, and as case ids show it."""

    text: str
    content: Any
    label: str = ""

    @property
    def number(self) -> float:
        """The value in SI units, NaN where it is not a number."""
        is_number = isinstance(self.content, float | int) and not isinstance(self.content, bool)
        return float(self.content) if is_number else math.nan


@dataclass(frozen=True)
class ListedGroup:
    """Listed rows of values of parameters that change together; usually of one parameter."""

    keys: tuple[str, ...]
    rows: tuple[tuple[ParameterValue, ...], ...]

    @property
    def size(self) -> int:
        """Number of rows."""
        return len(self.rows)

    def at(self, numbers: Numbers) -> list[list[ParameterValue]]:
        """Return the values of each parameter in the rows of the given numbers."""
        return [[self.rows[k][place] for k in numbers.tolist()] for place in range(len(self.keys))]

    def labels(self, numbers: Numbers, short: dict[str, str]) -> list[str]:
        """Return the part of a case id for the rows of the given numbers."""
        labels = [
            ",".join(f"{short[key]}={value.label}" for key, value in zip(self.keys, row, strict=True))
            for row in self.rows
        ]
        return [labels[k] for k in numbers.tolist()]


@dataclass(frozen=True)
class ParameterDraw:
    """The distribution of one parameter: of numbers with a unit, or a choice among values.

    `kind` is the kind of quantity, empty for plain numbers that no part of the rig reads.
    """

    distribution: Distribution
    unit: str = ""
    kind: str = ""
    choices: tuple[ParameterValue, ...] = ()

    def values(self, probabilities: NDArray[np.float64]) -> list[ParameterValue]:
        """Return the quantiles for the given probabilities (0 up to 1)."""
        from uictest.sweep.plan.distribution import quantile  # numpy, which checking a sweep does not need

        numbers = quantile(self.distribution)(probabilities).tolist()
        if self.choices:
            return [self.choices[int(number)] for number in numbers]
        texts = [quantity_text(rounded_decimal(number), self.unit) for number in numbers]
        # A value is read back from its text, so that a scenario with that text gives the same case.
        return [ParameterValue(text, content_of(text, self.kind)) for text in texts]


@dataclass(frozen=True)
class SampledGroup:
    """Parameters drawn together, point by point."""

    keys: tuple[str, ...]
    draws: tuple[ParameterDraw, ...]
    method: Method
    size: int
    points: int
    seed: int

    def at(self, numbers: Numbers) -> list[list[ParameterValue]]:
        """Return the values of each parameter in the rows of the given numbers."""
        from uictest.sweep.plan.sampling import points  # numpy, which checking a sweep does not need

        drawn = points(self.method, self.points, len(self.keys), self.seed, numbers)
        return [draw.values(drawn[:, place]) for place, draw in enumerate(self.draws)]

    def labels(self, numbers: Numbers, short: dict[str, str]) -> list[str]:
        """Return the part of a case id for the rows of the given numbers."""
        return [f"sample={k}" for k in numbers.tolist()]


Group = ListedGroup | SampledGroup


@dataclass(frozen=True)
class Plan:
    """All cases of a sweep: every combination of the rows of its groups, those of the first group slowest."""

    name: str
    title: str
    file: str
    """The sweep file, as shown to users."""
    base: Case
    """The case whose values are varied."""
    groups: tuple[Group, ...]
    short: dict[str, str]
    """The name of each key in case ids."""
    inputs: dict[str, str] = field(default_factory=dict)
    """SHA-256 of every file read, by the name shown to users."""

    @property
    def size(self) -> int:
        """Number of cases."""
        return math.prod(group.size for group in self.groups)

    @cached_property
    def keys(self) -> tuple[str, ...]:
        """The dotted keys that vary."""
        return tuple(key for group in self.groups for key in group.keys)

    def rows(self, indices: Numbers) -> list[Numbers]:
        """Return for each group which of its rows the cases with the given indices have."""
        rows: list[Numbers] = []
        for group in reversed(self.groups):
            rows.append(indices % group.size)
            indices = indices // group.size
        return rows[::-1]

    def settings(self, indices: Numbers) -> dict[str, list[ParameterValue]]:
        """Return the values of the cases with the given indices, by key."""
        columns: dict[str, list[ParameterValue]] = {}
        for group, rows in zip(self.groups, self.rows(indices), strict=True):
            columns.update(zip(group.keys, group.at(rows), strict=True))
        return columns

    def ids(self, indices: Numbers) -> list[str]:
        """Return the ids of the cases with the given indices: unique, and the same in every run."""
        labels_by_group = [
            group.labels(rows, self.short)
            for group, rows in zip(self.groups, self.rows(indices), strict=True)
        ]
        return [f"{self.name}[{','.join(labels)}]" for labels in zip(*labels_by_group, strict=True)]

    def listed(self) -> dict[str, tuple[ParameterValue, ...]]:
        """Return the values of every parameter that has a group of its own."""
        return {
            group.keys[0]: tuple(row[0] for row in group.rows)
            for group in self.groups
            if isinstance(group, ListedGroup) and len(group.keys) == 1
        }


def saltelli_sample(plan: Plan) -> SampledGroup | None:
    """Return the sample of a plan that Sobol indices can be computed from, None where there is none."""
    last = plan.groups[-1]
    return last if isinstance(last, SampledGroup) and last.method == "saltelli" else None


def content_of(text: str, kind: str) -> Any:
    """Return what a scenario holds where it says `text`: a quantity of a kind, or a plain number."""
    return parse_quantity(text, kind) if kind else scalar_value(text)


def is_numeric(values: Sequence[ParameterValue]) -> bool:
    """Return whether all values are numbers."""
    return all(isinstance(value.content, float | int) for value in values)
