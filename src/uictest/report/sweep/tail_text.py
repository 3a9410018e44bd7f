"""Quantiles and K_dry as lines of text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

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
from uictest.report.terminal.fitted_columns import aligned_rows
from uictest.report.wording import number


def tail_lines(result: SweepResult) -> Iterator[str]:
    """Yield the quantiles and K_dry of a sweep, a blank line behind each table."""
    for table in result.quantiles[:MOST_TABLES]:
        yield from _quantiles(table)
    yield from _more(result.quantiles, "quantiles.csv")
    for each in result.k_dry[:MOST_TABLES]:
        yield from _k_dry(each)
    yield from _more(result.k_dry, "k_dry.csv")


def _quantiles(table: MeasureQuantiles) -> Iterator[str]:
    yield f"{quantiles_title(table)}: {_basis(table.confidence, table.sample)}"
    rows = [("level", "estimate", "bound"), *(_quantile(each, table.sample) for each in table.quantiles)]
    yield from _indented(rows)


def _quantile(each: Quantile, sample: DrawCount) -> Sequence[str]:
    bound = bound_text(each) if each.is_supported else refusal_text(each.draws_needed, sample)
    return share_text(each.level), number(each.estimate), bound


def _k_dry(table: KDry) -> Iterator[str]:
    yield f"{k_dry_title(table)}: {_basis(table.confidence, table.sample)}; {nominal_words(table)}"
    heading = ("EBCL", "probability", "draws needed", "m/s2", "K_dry")
    yield from _indented([heading, *(_level(each, table.sample) for each in table.levels)])


def _level(each: KDryLevel, sample: DrawCount) -> Sequence[str]:
    head = (str(each.ebcl), probability_text(each), str(each.draws_needed), number(each.deceleration))
    if each.deceleration is None:
        return (*head, refusal_text(each.draws_needed, sample))
    return (*head, "-" if each.k_dry is None else k_dry_text(each.k_dry))


def _basis(confidence: float, sample: DrawCount) -> str:
    return f"{share_text(confidence)} confidence, {sample_words(sample)}"


def _indented(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    yield from (f"  {line}" for line in aligned_rows(rows))
    yield ""


def _more(tables: Sequence[object], file: str) -> Iterator[str]:
    if len(tables) > MOST_TABLES:
        yield f"{len(tables) - MOST_TABLES} more tables in {file}"
        yield ""
