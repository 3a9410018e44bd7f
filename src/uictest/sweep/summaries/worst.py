"""The cases of a sweep that are most worth looking at, and these cases in full."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from uictest.scenario import Case
from uictest.sweep.plan.plan import Plan
from uictest.sweep.running.case_blocks import ScenarioVariants

if TYPE_CHECKING:
    import pyarrow as pa

MOST: Final = 12
"""Cases that a page draws in full: each takes about 160 kB of it."""
_UNSEEN: Final = ("error", "skipped")
"""Outcomes of cases of which there is nothing to look at."""


class WorstCases:
    """The first cases not met, then those that came closest to it; taken part by part."""

    def __init__(self) -> None:
        self._kept = np.zeros((0, 3))

    def take(self, table: pa.Table) -> None:
        """Consider the rows of a part."""
        rows = np.column_stack([_numbers(table, name) for name in ("index", "narrowest_margin", "met")])
        seen = ~np.isin(np.array(table.column("outcome").to_pylist()), _UNSEEN)
        rows = np.concatenate([self._kept, rows[seen]])
        # Cases without any margin come last; among equals the order is that of the plan.
        self._kept = rows[np.lexsort(rows.T)][:MOST]

    def indices(self) -> list[int]:
        """Return the indices of the cases, the worst first."""
        return [int(index) for index in self._kept[:, 0]]


def _numbers(table: pa.Table, name: str) -> Any:
    return np.array(table.column(name).to_numpy(zero_copy_only=False), float)


def cases_of(plan: Plan, indices: list[int]) -> list[Case]:
    """Return cases of a plan with their whole scenarios, as `run` would examine them."""
    places = np.array(indices, np.int64)
    settings = plan.settings(places)
    variants = ScenarioVariants(plan.base.scenario, settings, len(indices))
    return [
        Case(
            name, variants.at(place), plan.base.path, {key: settings[key][place].text for key in settings}, {}
        )
        for place, name in enumerate(plan.ids(places))
    ]
