"""Measures along a parameter: smallest, mean and largest at each of its values."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.report import Trend
from uictest.sweeps.plan.plan import Plan
from uictest.sweeps.summaries.bins import ParameterBins
from uictest.sweeps.summaries.histograms import ReportedMeasure

if TYPE_CHECKING:
    import pyarrow as pa

MOST_VALUES: Final = 200
"""Largest number of values for which a parameter has trends; with more, plot the rows themselves."""


class TrendSums:
    """Measures over the bins of one parameter, added chunk by chunk."""

    def __init__(self, plan: Plan, bins: ParameterBins, measures: Sequence[ReportedMeasure]) -> None:
        self.bins, self.measures = bins, measures
        self._plan = plan
        shape = (len(measures), len(bins.values))
        self._cases, self._sum = np.zeros(shape, np.int64), np.zeros(shape)
        self._minimum, self._maximum = np.full(shape, np.inf), np.full(shape, -np.inf)

    def add(self, table: pa.Table) -> None:
        """Add the rows of a chunk; a case without a measure does not count in its trend."""
        bins = self.bins.of(self._plan, table.column("index").to_numpy(), table)
        for place, measure in enumerate(self.measures):
            values = measure.of(table)
            known = np.isfinite(values)
            at, values = bins[known], values[known]
            np.add.at(self._cases[place], at, 1)
            np.add.at(self._sum[place], at, values)
            np.minimum.at(self._minimum[place], at, values)
            np.maximum.at(self._maximum[place], at, values)

    def trends(self) -> Iterator[Trend]:
        """Yield the trend of each measure that any case has."""
        for place, measure in enumerate(self.measures):
            cases = self._cases[place]
            if cases.any():
                yield Trend(
                    parameter=self.bins.key,
                    values=self.bins.values,
                    measure=measure.name,
                    unit=measure.unit,
                    columns=measure.columns,
                    cases=cases.tolist(),
                    minimum=numbers_or_none(self._minimum[place]),
                    mean=numbers_or_none(self._sum[place] / np.where(cases > 0, cases, np.nan)),
                    maximum=numbers_or_none(self._maximum[place]),
                )


def numbers_or_none(values: NDArray[np.float64]) -> list[Any]:
    """Return an array as nested lists of floats, None for what is not finite."""
    objects: NDArray[Any] = values.astype(object)
    objects[~np.isfinite(values)] = None
    numbers: list[Any] = objects.tolist()
    return numbers
