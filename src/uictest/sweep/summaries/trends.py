"""How figures change along a parameter: smallest, mean and largest at each of its values."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from uictest.sweep.plan.plan import Plan
from uictest.sweep.summaries.bins import ParameterBins
from uictest.sweep.summaries.histograms import ReportedMeasure

if TYPE_CHECKING:
    import pyarrow as pa

MOST_VALUES: Final = 200
"""Values up to which a parameter has trends: with more, the rows themselves tell better."""


class Trends:
    """Figures over the classes of one parameter, taken part by part."""

    def __init__(self, plan: Plan, classes: ParameterBins, figures: Sequence[ReportedMeasure]) -> None:
        self.classes, self.figures = classes, figures
        self._plan = plan
        shape = (len(figures), len(classes.labels))
        self._cases, self._sum = np.zeros(shape, np.int64), np.zeros(shape)
        self._least, self._most = np.full(shape, np.inf), np.full(shape, -np.inf)

    def take(self, table: pa.Table) -> None:
        """Add the rows of a part; a case without a figure has no part in its trend."""
        codes = self.classes.of(self._plan, table.column("index").to_numpy(), table)
        for place, figure in enumerate(self.figures):
            values = figure.of(table)
            known = np.isfinite(values)
            at, values = codes[known], values[known]
            np.add.at(self._cases[place], at, 1)
            np.add.at(self._sum[place], at, values)
            np.minimum.at(self._least[place], at, values)
            np.maximum.at(self._most[place], at, values)

    def forms(self) -> Iterator[dict[str, Any]]:
        """Yield the JSON form of each figure that any case has; null where a class has none."""
        for place, figure in enumerate(self.figures):
            cases = self._cases[place]
            if cases.any():
                known = cases > 0
                mean = np.divide(self._sum[place], cases, out=np.full(cases.shape, np.nan), where=known)
                yield {
                    "parameter": self.classes.key,
                    "values": list(self.classes.labels),
                    "measure": figure.name,
                    "unit": figure.unit,
                    "columns": list(figure.columns),
                    "cases": cases.tolist(),
                    "minimum": np.where(known, self._least[place], np.nan).tolist(),
                    "mean": mean.tolist(),
                    "maximum": np.where(known, self._most[place], np.nan).tolist(),
                }
