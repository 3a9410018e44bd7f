"""Classes to count cases by: listed values as they are, drawn numbers in ten stretches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.report import STRETCH
from uictest.sweep.plan.group_reader import bounds_of
from uictest.sweep.plan.plan import ListedGroup, ParameterDraw, Plan
from uictest.sweep.running.table import text_column

if TYPE_CHECKING:
    import pyarrow as pa

STRETCHES: Final = 10


@dataclass(frozen=True)
class ParameterBins:
    """The classes of one parameter."""

    key: str
    labels: tuple[str, ...]
    place: tuple[int, int]
    """Which group of the plan the parameter is in, and where in it."""
    edges: tuple[float, ...] = ()
    """Where stretches of drawn numbers meet, in the unit of their distribution; none for listed values."""
    of_rows: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64), compare=False)
    """Class of each row of listed values: rows of a zip may share a value of one of their parameters."""

    def of(self, plan: Plan, indices: NDArray[np.int64], table: pa.Table) -> NDArray[np.int64]:
        """Return the class of each row; `indices` are those of the rows of the table."""
        if isinstance(plan.groups[self.place[0]], ListedGroup):
            found: NDArray[np.int64] = self.of_rows[plan.rows(indices)[self.place[0]]]
            return found
        texts = table.column(text_column(self.key)).to_pylist()
        if not self.edges:
            numbered = {label: number for number, label in enumerate(self.labels)}
            return np.array([numbered[text] for text in texts], np.int64)
        values = np.array([float(text.split(" ", 1)[0]) for text in texts])
        return np.searchsorted(self.edges, values, side="right").astype(np.int64)


def bins_of_plan(plan: Plan) -> dict[str, ParameterBins]:
    """Return the classes of every parameter of a plan."""
    found: dict[str, ParameterBins] = {}
    for number, group in enumerate(plan.groups):
        for place, key in enumerate(group.keys):
            if isinstance(group, ListedGroup):
                found[key] = _listed(key, [row[place].text for row in group.rows], (number, place))
            else:
                found[key] = _drawn(key, group.draws[place], (number, place))
    return found


def _listed(key: str, texts: Sequence[str], place: tuple[int, int]) -> ParameterBins:
    numbered = {text: number for number, text in enumerate(dict.fromkeys(texts))}
    return ParameterBins(key, tuple(numbered), place, of_rows=np.array([numbered[text] for text in texts]))


def _drawn(key: str, draw: ParameterDraw, place: tuple[int, int]) -> ParameterBins:
    if draw.choices:
        return ParameterBins(key, tuple(value.text for value in draw.choices), place)
    low, high = bounds_of(draw.distribution)
    ends: Any = np.linspace(float(low.number), float(high.number), STRETCHES + 1).tolist()
    shown = [f"{end:.10g}" for end in ends]
    unit = f" {low.unit}" if low.unit else ""
    labels = tuple(f"{shown[k]}{STRETCH}{shown[k + 1]}{unit}" for k in range(STRETCHES))
    return ParameterBins(key, labels, place, tuple(ends[1:-1]))
