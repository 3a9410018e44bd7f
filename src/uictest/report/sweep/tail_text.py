"""Quantiles and K_dry as lines of text."""

from __future__ import annotations

from collections.abc import Iterator

from uictest.report.sweep.result import SweepResult
from uictest.report.sweep.tail_tables import tables_left_out, tail_tables
from uictest.report.terminal.fitted_columns import aligned_rows


def tail_lines(result: SweepResult) -> Iterator[str]:
    """Yield the quantiles and K_dry of a sweep, a blank line behind each table."""
    for table in tail_tables(result):
        yield f"{table.title}: {table.basis}"
        yield from (f"  {line}" for line in aligned_rows([table.columns, *table.rows]))
        yield ""
    for sentence in tables_left_out(result):
        yield sentence
        yield ""
