"""Quantiles and K_dry as rows for CSV files and workbooks."""

from __future__ import annotations

from collections.abc import Iterator

from uictest.report.csv_text import Cell, csv_text
from uictest.report.sweep.result import SweepResult
from uictest.report.sweep.tail_wording import probability_text, refusal_text, share_text, sliding_words
from uictest.report.sweep.tails import DrawCount

Row = dict[str, Cell]


def tail_csv_tables(result: SweepResult) -> dict[str, str]:
    """Return the CSV files of quantiles and of K_dry, by file name; none of what the sweep does not have."""
    tables = {"quantiles.csv": list(quantile_rows(result)), "k_dry.csv": list(k_dry_rows(result))}
    return {name: csv_text(list(rows[0]), rows) for name, rows in tables.items() if rows}


def quantile_rows(result: SweepResult, prefix: str = "") -> Iterator[Row]:
    """Yield a row for each quantile; circumstances are columns with a prefix."""
    for table in result.quantiles:
        head: Row = {"measure": table.measure, "unit": table.unit}
        head |= {f"{prefix}{key}": value.text for key, value in table.circumstances.items()}
        for each in table.quantiles:
            own: Row = {"level": share_text(each.level), "estimate": each.estimate}
            own |= {"lower": each.lower, "upper": each.upper, "confidence": share_text(table.confidence)}
            yield {**head, **own, **_draws(table.sample, each.draws_needed, supported=each.is_supported)}


def k_dry_rows(result: SweepResult, prefix: str = "") -> Iterator[Row]:
    """Yield a row for each emergency brake confidence level; circumstances are columns with a prefix."""
    for table in result.k_dry:
        head: Row = {f"{prefix}{key}": value.text for key, value in table.circumstances.items()}
        for each in table.levels:
            own: Row = {"ebcl": each.ebcl, "probability": probability_text(each), "k_dry": each.k_dry}
            own |= {"deceleration_mps2": each.deceleration, "nominal_mps2": table.nominal}
            own |= {"measure": table.measure, "confidence": share_text(table.confidence)}
            is_supported = each.deceleration is not None
            row: Row = {**head, **own, **_draws(table.sample, each.draws_needed, supported=is_supported)}
            notes = filter(None, (row["note"], sliding_words(table)))
            yield {**row, "sliding": table.sliding, "note": "; ".join(map(str, notes))}


def _draws(sample: DrawCount, needed: int, *, supported: bool) -> Row:
    return {
        "draws": sample.draws,
        "without_value": sample.without_value,
        "draws_needed": needed,
        "note": "" if supported else refusal_text(needed, sample),
    }
