"""Quantiles and K_dry as tables in Markdown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from uictest.report.markdown_table import MarkdownTable, number_cell, prose, row
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
from uictest.report.wording import counted

Finding = tuple[str, MarkdownTable]
"""A heading, and a table; Markdown already."""


def quantile_findings(result: SweepResult) -> Iterator[Finding]:
    """Yield the quantiles of each measure at each combination of listed values, the first of them."""
    yield from _first_tables([*map(_quantiles, result.quantiles)], "quantiles.csv")


def k_dry_findings(result: SweepResult) -> Iterator[Finding]:
    """Yield K_dry at each combination of listed values, the first of them."""
    yield from _first_tables([*map(_k_dry, result.k_dry)], "k_dry.csv")


def _quantiles(table: MeasureQuantiles) -> Finding:
    title = quantiles_title(table)
    rows = [_quantile(each, table.sample) for each in table.quantiles]
    heading = f"{title[0].upper()}{title[1:]}"
    return _heading(heading, table.confidence, table.sample), MarkdownTable(
        ("level", "estimate", "bound", "draws needed"), "lrlr", rows, "more levels are in `quantiles.csv`."
    )


def _quantile(each: Quantile, sample: DrawCount) -> str:
    bound = bound_text(each) if each.is_supported else refusal_text(each.draws_needed, sample)
    return row(
        [share_text(each.level), number_cell(each.estimate, ".5g"), prose(bound), str(each.draws_needed)]
    )


def _k_dry(table: KDry) -> Finding:
    columns = ("EBCL", "probability", "K_dry", "deceleration, m/s2", "draws needed")
    rows = [_level(each, table.sample) for each in table.levels]
    heading = f"{_heading(k_dry_title(table), table.confidence, table.sample)}; {prose(nominal_words(table))}"
    return heading, MarkdownTable(columns, "lrrrr", rows, "more levels are in `k_dry.csv`.")


def _level(each: KDryLevel, sample: DrawCount) -> str:
    factor = "–" if each.k_dry is None else k_dry_text(each.k_dry)  # noqa: RUF001 - a dash on paper
    if each.deceleration is None:
        factor = prose(refusal_text(each.draws_needed, sample))
    deceleration = number_cell(each.deceleration, ".5g")
    return row([str(each.ebcl), probability_text(each), factor, deceleration, str(each.draws_needed)])


def _first_tables(findings: Sequence[Finding], file: str) -> Iterator[Finding]:
    """Yield the first findings; their first heading says how many more are in a file."""
    left_out = counted(len(findings) - MOST_TABLES, "more table is", "more tables are")
    for place, (heading, table) in enumerate(findings[:MOST_TABLES]):
        is_cut = place == 0 and len(findings) > MOST_TABLES
        yield (f"{heading}\n\n{left_out} in `{file}`." if is_cut else heading), table


def _heading(title: str, confidence: float, sample: DrawCount) -> str:
    return f"{prose(title)}\n\n{share_text(confidence)} confidence, {prose(sample_words(sample))}"
