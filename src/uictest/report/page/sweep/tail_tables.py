"""Tables of quantiles and of K_dry on the page of a sweep."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from uictest.report.sweep.result import SweepResult
from uictest.report.sweep.tail_wording import (
    MOST_TABLES,
    bound_text,
    k_dry_text,
    k_dry_title,
    nominal_words,
    probability_text,
    quantiles_title,
    refusal_text,
    sample_words,
    share_text,
)
from uictest.report.sweep.tails import DrawCount, KDry, KDryLevel, MeasureQuantiles, Quantile
from uictest.report.wording import number


@dataclass(frozen=True, slots=True)
class TailTable:
    """A table of texts: title, what it is based on, headings, and rows whose first text names the level."""

    title: str
    note: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]


def tail_tables(result: SweepResult) -> Iterator[TailTable]:
    """Yield the first tables of quantiles and of K_dry."""
    yield from map(_quantiles, result.quantiles[:MOST_TABLES])
    yield from map(_k_dry, result.k_dry[:MOST_TABLES])


def tables_left_out(result: SweepResult) -> int:
    """Return the number of tables that only the CSV files have."""
    return sum(max(len(tables) - MOST_TABLES, 0) for tables in (result.quantiles, result.k_dry))


def _quantiles(table: MeasureQuantiles) -> TailTable:
    rows = [_quantile(each, table.sample) for each in table.quantiles]
    title = quantiles_title(table)
    note = _basis(table.confidence, table.sample)
    columns = ("Level", "Estimate", "Bound", "Draws needed")
    return TailTable(f"{title[0].upper()}{title[1:]}", note, columns, rows)


def _quantile(each: Quantile, sample: DrawCount) -> Sequence[str]:
    bound = bound_text(each) if each.is_supported else refusal_text(each.draws_needed, sample)
    return share_text(each.level), number(each.estimate), bound, str(each.draws_needed)


def _k_dry(table: KDry) -> TailTable:
    rows = [_level(each, table.sample) for each in table.levels]
    note = f"{_basis(table.confidence, table.sample)}; {nominal_words(table)}"
    columns = ("EBCL", "Probability", "Deceleration, m/s2", "K_dry, rounded down", "Draws needed")
    return TailTable(k_dry_title(table), note, columns, rows)


def _level(each: KDryLevel, sample: DrawCount) -> Sequence[str]:
    factor = "-" if each.k_dry is None else k_dry_text(each.k_dry)
    if each.deceleration is None:
        factor = refusal_text(each.draws_needed, sample)
    return str(each.ebcl), probability_text(each), number(each.deceleration), factor, str(each.draws_needed)


def _basis(confidence: float, sample: DrawCount) -> str:
    return f"{share_text(confidence)} confidence, {sample_words(sample)}"
