"""Bins to count cases by: listed values one by one, drawn numbers in ten intervals.

Those of a log-uniform parameter have like ratios, so that they hold about as many cases each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.plans.sweeps import ListedGroup, ParameterDraw, Plan
from uictest.report import DrawnInterval, SweptValue, WrittenValue
from uictest.running.chunked import text_column

if TYPE_CHECKING:
    import pyarrow as pa

INTERVALS: Final = 10


@dataclass(frozen=True)
class ParameterBins:
    """The bins of one parameter."""

    key: str
    values: tuple[SweptValue, ...]
    place: tuple[int, int]
    """Group of the plan that holds the parameter, and its place in the group."""
    edges: tuple[float, ...] = ()
    """Inner edges of the intervals, in the unit of their distribution; none for listed values."""
    bin_of_row: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64), compare=False)
    """Bin of each row of listed values: rows of a zip may share a value of one of their parameters."""

    def of(self, plan: Plan, indices: NDArray[np.int64], table: pa.Table) -> NDArray[np.int64]:
        """Return the bin of each row; `indices` are those of the rows of the table."""
        if isinstance(plan.groups[self.place[0]], ListedGroup):
            bins: NDArray[np.int64] = self.bin_of_row[plan.rows(indices)[self.place[0]]]
            return bins
        texts = table.column(text_column(self.key)).to_pylist()
        if not self.edges:
            numbered = {value.label: number for number, value in enumerate(self.values)}
            return np.array([numbered[text] for text in texts], np.int64)
        numbers = np.array([float(text.split(" ", 1)[0]) for text in texts])
        return np.searchsorted(self.edges, numbers, side="right").astype(np.int64)


def bins_of_plan(plan: Plan) -> dict[str, ParameterBins]:
    """Return the bins of every parameter of a plan."""
    bins: dict[str, ParameterBins] = {}
    for number, group in enumerate(plan.groups):
        for place, key in enumerate(group.keys):
            if isinstance(group, ListedGroup):
                bins[key] = _listed_bins(key, [row[place].text for row in group.rows], (number, place))
            else:
                bins[key] = _drawn_bins(key, group.draws[place], (number, place))
    return bins


def _listed_bins(key: str, texts: Sequence[str], place: tuple[int, int]) -> ParameterBins:
    numbered = {text: number for number, text in enumerate(dict.fromkeys(texts))}
    bin_of_row = np.array([numbered[text] for text in texts])
    return ParameterBins(key, tuple(map(WrittenValue, numbered)), place, bin_of_row=bin_of_row)


def _drawn_bins(key: str, draw: ParameterDraw, place: tuple[int, int]) -> ParameterBins:
    if draw.choices:
        return ParameterBins(key, tuple(WrittenValue(value.text) for value in draw.choices), place)
    low, high = draw.distribution.bounds
    ends = float(low.number), float(high.number)
    edges: Any = _even_ratios(*ends) if draw.distribution.log_uniform else _even_steps(*ends)
    intervals = tuple(DrawnInterval(start, end, low.unit) for start, end in pairwise(edges))
    return ParameterBins(key, intervals, place, tuple(edges[1:-1]))


def _even_steps(low: float, high: float) -> list[float]:
    edges: list[float] = np.linspace(low, high, INTERVALS + 1).tolist()
    return edges


def _even_ratios(low: float, high: float) -> list[float]:
    """Return the ends of intervals that a log-uniform draw falls into equally often; inner ones rounded."""
    edges: list[float] = np.geomspace(low, high, INTERVALS + 1).tolist()
    rounded = [low, *(float(f"{edge:.3g}") for edge in edges[1:-1]), high]
    # Close to each other, three digits do not keep them apart.
    return (
        rounded if all(after > before for before, after in pairwise(rounded)) else [low, *edges[1:-1], high]
    )
