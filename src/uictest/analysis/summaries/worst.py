"""The worst cases of a sweep: those not met, then those with the narrowest margins."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from uictest.plans.scenario import Case
from uictest.plans.sweeps import Plan
from uictest.running.chunked import ScenarioVariants

if TYPE_CHECKING:
    import pyarrow as pa

MOST: Final = 12
"""Cases that a page draws: each takes about 160 kB."""
_NOT_SIMULATED: Final = ("error", "skipped")
"""Outcomes of cases that have nothing to draw."""


class WorstCases:
    """The first cases not met, then those with the narrowest margins; added chunk by chunk."""

    def __init__(self) -> None:
        self._worst = np.zeros((0, 3))

    def add(self, table: pa.Table) -> None:
        """Consider the rows of a chunk."""
        rows = np.column_stack([_numbers(table, name) for name in ("index", "narrowest_margin", "met")])
        simulated = ~np.isin(np.array(table.column("outcome").to_pylist()), _NOT_SIMULATED)
        rows = np.concatenate([self._worst, rows[simulated]])
        # Cases without any margin come last; among equals the order is that of the plan.
        self._worst = rows[np.lexsort(rows.T)][:MOST]

    def indices(self) -> list[int]:
        """Return the indices of the cases, the worst first."""
        return [int(index) for index in self._worst[:, 0]]


def _numbers(table: pa.Table, name: str) -> Any:
    return np.array(table.column(name).to_numpy(zero_copy_only=False), float)


def full_cases(plan: Plan, indices: Sequence[int]) -> list[Case]:
    """Return cases of a plan with their whole scenarios, as `run` would run them."""
    places = np.array(indices, np.int64)
    settings = plan.settings(places)
    variants = ScenarioVariants(plan.base.scenario, settings, len(indices))
    return [
        Case(
            name, variants.at(place), plan.base.path, {key: settings[key][place].text for key in settings}, {}
        )
        for place, name in enumerate(plan.ids(places))
    ]
