"""Tables of quantiles and of K_dry as texts, the same on the terminal, in Markdown and on the page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from uictest.report.sweep.result import SweepResult
from uictest.report.sweep.tail_wording import (
    bound_text,
    k_dry_text,
    k_dry_title,
    nominal_words,
    probability_text,
    quantiles_title,
    refusal_text,
    sample_words,
    share_text,
    sliding_words,
)
from uictest.report.sweep.tails import DrawCount, KDry, KDryLevel, MeasureQuantiles, Quantile
from uictest.report.wording import counted, number

MOST_TABLES: Final = 10
"""Combinations of listed values that a reader is shown; the CSV files have each."""

_QUANTILES: Final = ("level", "draws needed", "estimate", "bound")
_K_DRY: Final = ("EBCL", "probability", "draws needed", "m/s2", "K_dry")


@dataclass(frozen=True, slots=True)
class TailTable:
    """A table of texts: title, what it is based on, headings, and rows whose first text names the level.

    `file` is the CSV file that holds all tables of its kind.
    """

    title: str
    basis: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    file: str


def tail_tables(result: SweepResult) -> Iterator[TailTable]:
    """Yield the first tables of quantiles, then those of K_dry."""
    yield from map(_quantiles, result.quantiles[:MOST_TABLES])
    yield from map(_k_dry, result.k_dry[:MOST_TABLES])


def tables_left_out(result: SweepResult) -> list[str]:
    """Return how many tables only the CSV files have, e.g. `2 more tables are in k_dry.csv`."""
    files = {"quantiles.csv": len(result.quantiles), "k_dry.csv": len(result.k_dry)}
    return [
        f"{counted(tables - MOST_TABLES, 'more table is', 'more tables are')} in {file}"
        for file, tables in files.items()
        if tables > MOST_TABLES
    ]


def _quantiles(table: MeasureQuantiles) -> TailTable:
    rows = [_quantile(each, table.sample) for each in table.quantiles]
    basis = _basis(table.confidence, table.sample)
    return TailTable(quantiles_title(table), basis, _QUANTILES, rows, "quantiles.csv")


def _quantile(each: Quantile, sample: DrawCount) -> Sequence[str]:
    bound = bound_text(each) if each.is_supported else refusal_text(each.draws_needed, sample)
    return share_text(each.level), str(each.draws_needed), number(each.estimate), bound


def _k_dry(table: KDry) -> TailTable:
    rows = [_level(each, table.sample) for each in table.levels]
    words = _basis(table.confidence, table.sample), nominal_words(table), sliding_words(table)
    return TailTable(k_dry_title(table), "; ".join(filter(None, words)), _K_DRY, rows, "k_dry.csv")


def _level(each: KDryLevel, sample: DrawCount) -> Sequence[str]:
    factor = "-" if each.k_dry is None else k_dry_text(each.k_dry)
    if each.deceleration is None:
        factor = refusal_text(each.draws_needed, sample)
    return str(each.ebcl), probability_text(each), str(each.draws_needed), number(each.deceleration), factor


def _basis(confidence: float, sample: DrawCount) -> str:
    return f"{share_text(confidence)} confidence, {sample_words(sample)}"
