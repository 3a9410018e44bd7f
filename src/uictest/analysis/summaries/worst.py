"""The worst cases of a sweep, and all rows as summary.parquet."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from uictest.core import files
from uictest.plans.scenario import Case
from uictest.plans.sweeps import Plan, in_survey_step
from uictest.running.chunked import surveyed_cases

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
        self._surveyed: set[int] = set()

    def add(self, table: pa.Table) -> None:
        """Consider the rows of a chunk."""
        rows = np.column_stack(
            [
                np.array(table.column(name).to_numpy(zero_copy_only=False), float)
                for name in ("index", "narrowest_margin", "met")
            ]
        )
        simulated = ~np.isin(np.array(table.column("outcome").to_pylist()), _NOT_SIMULATED)
        rows = np.concatenate([self._worst, rows[simulated]])
        # Cases without any margin come last; among equals the order is that of the plan.
        self._worst = rows[np.lexsort(rows.T)][:MOST]
        self._surveyed = (self._surveyed | surveyed_cases(table)).intersection(self.indices())

    def indices(self) -> list[int]:
        """Return the indices of the cases, the worst first."""
        return [int(index) for index in self._worst[:, 0]]

    def surveyed(self) -> frozenset[int]:
        """Return the indices of those whose row is of a survey step."""
        return frozenset(self._surveyed)


def full_cases(plan: Plan, indices: Sequence[int], surveyed: Collection[int] = ()) -> list[Case]:
    """Return cases of a plan with their whole scenarios; those that are `surveyed` in survey steps."""
    cases = [plan.cases(np.array([index], np.int64))[0] for index in indices]
    return [
        in_survey_step(case) if index in surveyed else case
        for index, case in zip(indices, cases, strict=True)
    ]


@contextlib.contextmanager
def summary_file(folder: Path) -> Iterator[Callable[[pa.Table], None]]:
    """Lend a function that appends rows to summary.parquet, which appears at the end. Raises OSError."""
    from pyarrow.parquet import ParquetWriter

    with files.new_file(folder, "summary.parquet") as file, contextlib.ExitStack() as opened:
        writers: list[ParquetWriter] = []

        def write(table: pa.Table) -> None:
            if not writers:
                writers.append(opened.enter_context(ParquetWriter(file, table.schema, compression="zstd")))
            writers[0].write_table(table)

        yield write
