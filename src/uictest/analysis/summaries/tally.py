"""Counts over the rows of a sweep, added chunk by chunk: memory does not grow with the number of cases."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.summaries.bins import ParameterBins, bins_of_plan
from uictest.plans.sweeps import Plan
from uictest.report import MissedCase, OutcomeCount

if TYPE_CHECKING:
    import pyarrow as pa

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
        self._add_missed(table, met)

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

    def _add_missed(self, table: pa.Table, met: NDArray[np.bool_]) -> None:
        for place in np.flatnonzero(~met)[: MOST_EXAMPLES - len(self.missed)].tolist():
            texts = (str(table.column(name)[place].as_py()) for name in ("id", "outcome", "reason"))
            self.missed.append(MissedCase(*texts))


def _count(counts: NDArray[np.int64], bins: Any, outcomes: Any, met: Any) -> None:
    np.add.at(counts, (bins, outcomes), 1)
    np.add.at(counts, (bins[met], len(OUTCOMES)), 1)
