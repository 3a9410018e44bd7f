"""Quantiles and K_dry in words, as tables of texts and as rows."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from operator import itemgetter
from typing import Any, Final

from uictest.core import envelope
from uictest.core.document import Cell, Column, Table
from uictest.report.counts import counted
from uictest.report.sweep.result import SweepResult
from uictest.report.sweep.sweep_sentences import circumstances_words
from uictest.report.sweep.tails import DrawCount, KDry, KDryLevel, MeasureQuantiles, Quantile
from uictest.report.text_tables import csv_text
from uictest.report.verdict_sentences import number, quantity

_K_DRY_DECIMALS = 3


def share_text(share: float) -> str:
    """Return a share in per cent, e.g. `0.1 %` or `99.9999999 %`."""
    return f"{100.0 * share:.10g} %"


def probability_text(level: KDryLevel) -> str:
    """Return the confidence level of an EBCL: the share of stops that decelerate at least as much."""
    return share_text(1.0 - level.shortfall)


def k_dry_text(k_dry: float) -> str:
    """Return K_dry with three decimals, rounded down: rounded up it would promise too much."""
    scale = 10**_K_DRY_DECIMALS
    # A product such as 1000 x 0.957 lies below the whole number that it is.
    return f"{math.floor(k_dry * scale + 1e-9) / scale:.{_K_DRY_DECIMALS}f}"


def bound_text(quantile: Quantile) -> str:
    """Return the bounds of a supported quantile, e.g. `at least 1.0732` or `1.1012 .. 1.1019`."""
    if quantile.side == "both":
        return f"{number(quantile.lower)} .. {number(quantile.upper)}"
    return (
        f"at least {number(quantile.lower)}"
        if quantile.side == "lower"
        else f"at most {number(quantile.upper)}"
    )


def refusal_text(draws_needed: int, sample: DrawCount) -> str:
    """Return why a sample supports no bound, e.g. `needs 299572 draws, has 20000`."""
    if sample.draws < draws_needed:
        return f"needs {draws_needed} draws, has {sample.draws}"
    return f"may lie among the {counted(sample.without_value, 'draw')} without a value"


def sample_words(sample: DrawCount) -> str:
    """Return the number of draws, and how many of them count as the worst."""
    if not sample.without_value:
        return counted(sample.draws, "draw")
    verb = "count" if sample.without_value > 1 else "counts"
    return f"{counted(sample.draws, 'draw')}; {sample.without_value} without a value {verb} as the worst"


def quantiles_title(table: MeasureQuantiles) -> str:
    """Return what a table of quantiles shows."""
    unit = "" if table.unit == "1" else f", {table.unit}"
    at = f" at {circumstances_words(table.circumstances)}" if table.circumstances else ""
    return f"quantiles of {table.measure}{unit}{at}"


def k_dry_title(table: KDry) -> str:
    """Return what a table of K_dry shows."""
    at = f" at {circumstances_words(table.circumstances)}" if table.circumstances else ""
    return f"K_dry of {table.measure}{at}"


def nominal_words(table: KDry) -> str:
    """Return the nominal deceleration and where it comes from."""
    if table.nominal is None:
        return "the nominal case has no deceleration"
    origin = "stated in the sweep file" if table.nominal_is_stated else "of the scenario with its own values"
    return f"nominal {quantity(table.nominal, 'm/s2')}, {origin}"


def sliding_words(table: KDry) -> str:
    """Return in how many draws a wheelset slides, for which K_dry is not defined; empty without any."""
    if not table.sliding:
        return ""
    draws = f"a wheelset slides in {table.sliding} of {counted(table.sample.draws, 'draw')}"
    return f"{draws}, so that this is no K_dry: on dry rail none slides"


MOST_TABLES: Final = 10
"""Combinations of listed values that a reader is shown; the CSV files have each."""

_QUANTILES: Final = ("level", "draws needed", "estimate", "bound")
_K_DRY: Final = ("EBCL", "probability", "draws needed", "m/s2", "K_dry")
_Texts = Sequence[str]


def tail_tables(result: SweepResult) -> Iterator[Table]:
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


def _table(headings: Sequence[str], rows: Sequence[_Texts], title: str, basis: str, file: str) -> Table:
    columns = [
        Column(heading=heading, text=itemgetter(place), right=place > 0)
        for place, heading in enumerate(headings)
    ]
    return Table(columns, rows, title, basis, f"more levels are in `{file}`.")


def _quantiles(table: MeasureQuantiles) -> Table:
    rows = []
    for each in table.quantiles:
        bound = bound_text(each) if each.is_supported else refusal_text(each.draws_needed, table.sample)
        rows.append((share_text(each.level), str(each.draws_needed), number(each.estimate), bound))
    basis = _basis(table.confidence, table.sample)
    return _table(_QUANTILES, rows, quantiles_title(table), basis, "quantiles.csv")


def _k_dry(table: KDry) -> Table:
    rows = [_level(each, table.sample) for each in table.levels]
    words = _basis(table.confidence, table.sample), nominal_words(table), sliding_words(table)
    return _table(_K_DRY, rows, k_dry_title(table), "; ".join(filter(None, words)), "k_dry.csv")


def _level(each: KDryLevel, sample: DrawCount) -> _Texts:
    factor = "-" if each.k_dry is None else k_dry_text(each.k_dry)
    if each.deceleration is None:
        factor = refusal_text(each.draws_needed, sample)
    return str(each.ebcl), probability_text(each), str(each.draws_needed), number(each.deceleration), factor


def _basis(confidence: float, sample: DrawCount) -> str:
    return f"{share_text(confidence)} confidence, {sample_words(sample)}"


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


K_DRY_FILE: Final = "k_dry.yaml"


def k_dry_yaml(result: SweepResult) -> str:
    """Return K_dry of a sweep as YAML, all digits kept; levels that the sample does not support are null."""
    import yaml  # heavier than all that other sweeps write

    content = {
        **envelope.head(envelope.RESULT, "k-dry"),
        "sweep": result.name,
        "tables": list(map(_k_dry_entry, result.k_dry)),
    }
    text: str = yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=110)
    return text


def _k_dry_entry(table: KDry) -> dict[str, Any]:
    return {
        "at": {key: value.text for key, value in table.circumstances.items()},
        "measure": table.measure,
        "nominal_mps2": table.nominal,
        "nominal_from": "sweep file" if table.nominal_is_stated else "nominal case",
        "confidence": share_text(table.confidence),
        "draws": table.sample.draws,
        "draws_without_value": table.sample.without_value,
        "draws_sliding": table.sliding,
        **({"note": sliding_words(table)} if table.sliding else {}),
        "levels": [_level_entry(table, each) for each in table.levels],
    }


def _level_entry(table: KDry, level: KDryLevel) -> dict[str, Any]:
    form = {
        "ebcl": level.ebcl,
        "probability": probability_text(level),
        "draws_needed": level.draws_needed,
        "deceleration_mps2": level.deceleration,
        "k_dry": level.k_dry,
    }
    if level.deceleration is None:
        form["note"] = refusal_text(level.draws_needed, table.sample)
    return form
