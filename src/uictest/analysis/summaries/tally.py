"""Counts over the rows of a sweep, in bins of each parameter.

Those of a log-uniform parameter have like ratios, so that they hold about as many cases each.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.plans.sweeps import Group, ListedGroup, ParameterDraw, Plan
from uictest.report import DrawnInterval, MissedCase, OutcomeCount, SweptValue, WrittenValue, interval_indices
from uictest.running.chunked import number_column, text_column

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
    bin_of_row: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64), compare=False)
    """Bin of each row of listed values: rows of a zip may share a value of one of their parameters."""

    def of(self, plan: Plan, indices: NDArray[np.int64], table: pa.Table) -> NDArray[np.int64]:
        """Return the bin of each row; `indices` are those of the rows of the table."""
        if isinstance(plan.groups[self.place[0]], ListedGroup):
            bins: NDArray[np.int64] = self.bin_of_row[plan.rows(indices)[self.place[0]]]
            return bins
        intervals = [value for value in self.values if isinstance(value, DrawnInterval)]
        values = table.column(self.column)
        if intervals:
            return interval_indices(intervals, values.to_numpy())
        numbered = {value.label: number for number, value in enumerate(self.values)}
        return np.array([numbered[text] for text in values.to_pylist()], np.int64)

    @property
    def column(self) -> str:
        """The column of the rows that says in which bin they are."""
        drawn = isinstance(self.values[0], DrawnInterval)
        return number_column(self.key) if drawn else text_column(self.key)


def bins_of_plan(plan: Plan) -> dict[str, ParameterBins]:
    """Return the bins of every parameter of a plan."""
    bins: dict[str, ParameterBins] = {}
    for number, group in enumerate(plan.groups):
        for place, key in enumerate(group.keys):
            if isinstance(group, ListedGroup):
                texts = [row[place].text for row in group.rows]
                numbered = {text: index for index, text in enumerate(dict.fromkeys(texts))}
                bin_of_row = np.array([numbered[text] for text in texts])
                values = tuple(map(WrittenValue, numbered))
                bins[key] = ParameterBins(key, values, (number, place), bin_of_row)
            else:
                bins[key] = _drawn_bins(key, group.draws[place], (number, place))
    return bins


def _drawn_bins(key: str, draw: ParameterDraw, place: tuple[int, int]) -> ParameterBins:
    if draw.choices:
        return ParameterBins(key, tuple(WrittenValue(value.text) for value in draw.choices), place)
    low, high = draw.distribution.bounds
    ends = float(low.number), float(high.number)
    even_steps: list[float] = np.linspace(*ends, INTERVALS + 1).tolist()
    edges = _even_ratios(*ends) if draw.distribution.log_uniform else even_steps
    intervals = tuple(DrawnInterval(start, end, low.unit) for start, end in pairwise(edges))
    return ParameterBins(key, intervals, place)


def _even_ratios(low: float, high: float) -> list[float]:
    """Return the ends of intervals that a log-uniform draw falls into equally often; inner ones rounded."""
    edges: list[float] = np.geomspace(low, high, INTERVALS + 1).tolist()
    rounded = [low, *(float(f"{edge:.3g}") for edge in edges[1:-1]), high]
    # Close to each other, three digits do not keep them apart.
    return (
        rounded if all(after > before for before, after in pairwise(rounded)) else [low, *edges[1:-1], high]
    )


OUTCOMES: Final = ("pass", "fail", "invalid", "inconclusive", "error", "skipped")
MOST_EXAMPLES: Final = 10


@dataclass
class Tally:
    """Counts by outcome, overall and for each bin of each parameter, with the first missed cases."""

    plan: Plan
    bins: dict[str, ParameterBins] = field(init=False)
    missed: list[MissedCase] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.bins = bins_of_plan(self.plan)
        # The last column counts the cases that met their expectation.
        self._counts = {
            key: np.zeros((len(each.values), len(OUTCOMES) + 1), np.int64) for key, each in self.bins.items()
        }
        self._total = np.zeros(len(OUTCOMES) + 1, np.int64)

    def add(self, table: pa.Table) -> None:
        """Count the rows of a chunk."""
        indices = table.column("index").to_numpy()
        outcomes = np.array([OUTCOMES.index(name) for name in table.column("outcome").to_pylist()], np.int64)
        met = np.array(table.column("met").to_pylist(), bool)
        _count(self._total[None], np.zeros_like(outcomes), outcomes, met)
        for key, each in self.bins.items():
            _count(self._counts[key], each.of(self.plan, indices, table), outcomes, met)
        for row in np.flatnonzero(~met)[: MOST_EXAMPLES - len(self.missed)].tolist():
            texts = (str(table.column(name)[row].as_py()) for name in ("id", "outcome", "reason"))
            self.missed.append(MissedCase(*texts))

    @property
    def cases(self) -> int:
        """Number of cases."""
        return int(self._total[:-1].sum())

    @property
    def met(self) -> int:
        """Number of cases that met their expectation."""
        return int(self._total[-1])

    @property
    def outcomes(self) -> dict[str, int]:
        """Number of cases by outcome."""
        return dict(zip(OUTCOMES, self._total[:-1].tolist(), strict=True))

    def rates(self, key: str) -> tuple[OutcomeCount, ...]:
        """Return the counts for each bin of a parameter."""
        rows = zip(self.bins[key].values, self._counts[key].tolist(), strict=True)
        return tuple(
            OutcomeCount(value, sum(outcomes), met, dict(zip(OUTCOMES, outcomes, strict=True)))
            for value, (*outcomes, met) in rows
        )


def _count(counts: NDArray[np.int64], bins: Any, outcomes: Any, met: Any) -> None:
    np.add.at(counts, (bins, outcomes), 1)
    np.add.at(counts, (bins[met], len(OUTCOMES)), 1)


_MOST_UNEVEN: Final = 1.5
"""Largest over smallest logarithm of the ratios of neighbours: 1, 2, 5, 10 have 1.32. Chosen."""
_MORE_EVEN: Final = 1.6
"""So many times more uneven the differences must be than these logarithms. Chosen."""


def logarithmic_keys(plan: Plan) -> tuple[str, ...]:
    """Return the keys that are drawn log-uniformly, or whose listed numbers rise or fall by like ratios."""
    return tuple(key for group in plan.groups for key in _logarithmic_in(group))


def _logarithmic_in(group: Group) -> Iterator[str]:
    for place, key in enumerate(group.keys):
        if isinstance(group, ListedGroup):
            chosen = spaced_logarithmically([row[place].text for row in group.rows])
        else:
            chosen = group.draws[place].distribution.log_uniform is not None
        if chosen:
            yield key


def spaced_logarithmically(texts: Sequence[str]) -> bool:
    """Return whether values as written are at least three numbers of one unit in like ratios."""
    values = [WrittenValue(text) for text in dict.fromkeys(texts)]
    numbers = np.array([value.number for value in values], float)
    if len(values) < 3 or len({value.unit for value in values}) > 1 or not np.all(numbers > 0.0):
        return False
    differences, ratios = np.diff(numbers), np.diff(np.log(numbers))
    if not (np.all(ratios > 0.0) or np.all(ratios < 0.0)):
        return False
    unevenness = _unevenness(ratios)
    return unevenness <= _MOST_UNEVEN and _unevenness(differences) >= _MORE_EVEN * unevenness


def _unevenness(steps: NDArray[np.float64]) -> float:
    return float(np.abs(steps).max() / np.abs(steps).min())
