"""A sweep worked out: which values each of its cases has, as a function of the number of the case alone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from uictest.scenario import Case
from uictest.scenario.yaml import Quantity, parse_quantity
from uictest.sweep.plan.amount import rounded, written
from uictest.sweep.plan.model import Distribution, Method

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Value:
    """A value of a parameter: as written, as the scenario holds it, and as case ids show it."""

    text: str
    content: Any
    label: str = ""

    @property
    def number(self) -> float:
        """The value in SI units, NaN where it is no number."""
        known = isinstance(self.content, float | int) and not isinstance(self.content, bool)
        return float(self.content) if known else math.nan


@dataclass(frozen=True)
class Listed:
    """Parameters that move together through listed rows of values; usually it is one parameter."""

    keys: tuple[str, ...]
    rows: tuple[tuple[Value, ...], ...]

    @property
    def size(self) -> int:
        """How many rows."""
        return len(self.rows)

    def at(self, numbers: Numbers) -> list[list[Value]]:
        """Return the values of each parameter in the rows of the given numbers."""
        return [[self.rows[k][place] for k in numbers.tolist()] for place in range(len(self.keys))]

    def labels(self, numbers: Numbers, short: dict[str, str]) -> list[str]:
        """Return what the rows of the given numbers contribute to a case id."""
        each = [
            ",".join(f"{short[key]}={value.label}" for key, value in zip(self.keys, row, strict=True))
            for row in self.rows
        ]
        return [each[k] for k in numbers.tolist()]


@dataclass(frozen=True)
class Draw:
    """How one parameter is drawn: numbers with a unit, of a kind of quantity, or one of several values."""

    distribution: Distribution
    unit: str = ""
    kind: str = ""
    choices: tuple[Value, ...] = ()

    def values(self, shares: NDArray[np.float64]) -> list[Value]:
        """Return the values that stand for the given shares (0 up to 1)."""
        from uictest.sweep.plan.distribution import quantile

        numbers = quantile(self.distribution)(shares).tolist()
        if self.choices:
            return [self.choices[int(number)] for number in numbers]
        texts = [written(rounded(number), self.unit) for number in numbers]
        # A value is read back from its text, so that a scenario with that text gives the same case.
        return [Value(text, parse_quantity(text, self.kind)) for text in texts]


@dataclass(frozen=True)
class Sampled:
    """Parameters drawn together, point by point."""

    keys: tuple[str, ...]
    draws: tuple[Draw, ...]
    method: Method
    size: int
    points: int
    seed: int

    def at(self, numbers: Numbers) -> list[list[Value]]:
        """Return the values of each parameter in the rows of the given numbers."""
        from uictest.sweep.plan.sampling import points

        drawn = points(self.method, self.points, len(self.keys), self.seed, numbers)
        return [draw.values(drawn[:, place]) for place, draw in enumerate(self.draws)]

    def labels(self, numbers: Numbers, short: dict[str, str]) -> list[str]:
        """Return what the rows of the given numbers contribute to a case id."""
        return [f"sample={k}" for k in numbers.tolist()]


Group = Listed | Sampled


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
    """What ids call each key."""
    inputs: dict[str, str] = field(default_factory=dict)
    """Every file read, by shown name, and its SHA-256."""

    @property
    def size(self) -> int:
        """How many cases."""
        return math.prod(group.size for group in self.groups)

    @cached_property
    def keys(self) -> tuple[str, ...]:
        """The dotted keys that vary."""
        return tuple(key for group in self.groups for key in group.keys)

    def rows(self, indices: Numbers) -> list[Numbers]:
        """Return for each group which of its rows the cases with the given indices have."""
        found: list[Numbers] = []
        for group in reversed(self.groups):
            found.append(indices % group.size)
            indices = indices // group.size
        return found[::-1]

    def settings(self, indices: Numbers) -> dict[str, list[Value]]:
        """Return the values of the cases with the given indices, by key."""
        columns: dict[str, list[Value]] = {}
        for group, rows in zip(self.groups, self.rows(indices), strict=True):
            columns.update(zip(group.keys, group.at(rows), strict=True))
        return columns

    def ids(self, indices: Numbers) -> list[str]:
        """Return the ids of the cases with the given indices: unique, and the same for ever."""
        parts = [
            group.labels(rows, self.short)
            for group, rows in zip(self.groups, self.rows(indices), strict=True)
        ]
        return [f"{self.name}[{','.join(labels)}]" for labels in zip(*parts, strict=True)]

    def listed(self) -> dict[str, tuple[Value, ...]]:
        """Return the values of every parameter that has a group of its own."""
        return {
            group.keys[0]: tuple(row[0] for row in group.rows)
            for group in self.groups
            if isinstance(group, Listed) and len(group.keys) == 1
        }


def saltelli_sample(plan: Plan) -> Sampled | None:
    """Return the sample of a plan that indices can be computed from, None where there is none."""
    last = plan.groups[-1]
    return last if isinstance(last, Sampled) and last.method == "saltelli" else None


def is_numeric(values: Sequence[Value]) -> bool:
    """Return whether all values are quantities or whole numbers."""
    return all(isinstance(value.content, Quantity | int) for value in values)
