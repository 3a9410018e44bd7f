"""Counts over the rows of a sweep, taken part by part: memory does not grow with the number of cases."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.sweep.plan.plan import Plan
from uictest.sweep.summaries.bins import ParameterBins, bins_of_plan

if TYPE_CHECKING:
    import pyarrow as pa

OUTCOMES: Final = ("pass", "fail", "invalid", "inconclusive", "error", "skipped")
MOST_EXAMPLES: Final = 10
COLUMNS: Final = ("index", "id", "outcome", "met", "reason")


@dataclass(frozen=True)
class OutcomeCount:
    """How the cases of one class came out."""

    label: str
    cases: int
    met: int
    outcomes: dict[str, int]

    @property
    def share_met(self) -> float:
        """Share of the cases that met their expectation; NaN without any."""
        return self.met / self.cases if self.cases else float("nan")


@dataclass
class Tally:
    """Counts by outcome, overall and for each class of each parameter, with the first cases that missed."""

    plan: Plan
    classes: dict[str, ParameterBins] = field(init=False)
    missed: list[tuple[str, str, str]] = field(default_factory=list)
    """Id, outcome and reason of the first cases that did not meet their expectation."""

    def __post_init__(self) -> None:
        self.classes = bins_of_plan(self.plan)
        # The last column counts the cases that met their expectation.
        self._counts = {
            key: np.zeros((len(each.labels), len(OUTCOMES) + 1), np.int64)
            for key, each in self.classes.items()
        }
        self._total = np.zeros(len(OUTCOMES) + 1, np.int64)

    def take(self, table: pa.Table) -> None:
        """Count the rows of a part."""
        indices = table.column("index").to_numpy()
        outcomes = np.array([OUTCOMES.index(name) for name in table.column("outcome").to_pylist()], np.int64)
        met = np.array(table.column("met").to_pylist(), bool)
        _count(self._total[None], np.zeros_like(outcomes), outcomes, met)
        for key, each in self.classes.items():
            _count(self._counts[key], each.of(self.plan, indices, table), outcomes, met)
        self._keep_missed(table, met)

    def total(self) -> OutcomeCount:
        """Return the counts over all cases."""
        return _as_count("all", self._total)

    def by_class(self, key: str) -> list[OutcomeCount]:
        """Return the counts for each class of a parameter."""
        labels = self.classes[key].labels
        return [_as_count(label, row) for label, row in zip(labels, self._counts[key], strict=True)]

    def _keep_missed(self, table: pa.Table, met: NDArray[np.bool_]) -> None:
        for place in np.flatnonzero(~met)[: MOST_EXAMPLES - len(self.missed)].tolist():
            row = (str(table.column(name)[place].as_py()) for name in ("id", "outcome", "reason"))
            self.missed.append((next(row), next(row), next(row)))


def _count(counts: NDArray[np.int64], codes: Any, outcomes: Any, met: Any) -> None:
    np.add.at(counts, (codes, outcomes), 1)
    np.add.at(counts, (codes[met], len(OUTCOMES)), 1)


def _as_count(label: str, row: NDArray[np.int64]) -> OutcomeCount:
    *outcomes, met = row.tolist()
    named = dict(zip(OUTCOMES, outcomes, strict=True))
    return OutcomeCount(label, sum(outcomes), met, named)
