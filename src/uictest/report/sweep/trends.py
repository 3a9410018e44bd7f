"""Trends of a sweep as rows of a table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

from uictest.report.csv_text import Cell

TREND_COLUMNS: Final = ("parameter", "value", "measure", "unit", "cases", "minimum", "mean", "maximum")


def trend_rows(trend: Mapping[str, Any]) -> Iterator[dict[str, Cell]]:
    """Yield a row for each value of the parameter, from a trend of `sweep.json`."""
    own = {name: trend[name] for name in ("parameter", "measure", "unit")}
    lists = (trend[name] for name in ("values", "cases", "minimum", "mean", "maximum"))
    for value, cases, *numbers in zip(*lists, strict=True):
        named = dict(zip(("minimum", "mean", "maximum"), numbers, strict=True))
        yield {**own, "value": value, "cases": cases, **named}
