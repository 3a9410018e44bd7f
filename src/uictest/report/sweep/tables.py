"""The result of a sweep as tables: rows for workbooks, and CSV files."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Final

from uictest.report.csv_text import Cell, csv_text
from uictest.report.sweep.result import (
    Flip,
    Frontier,
    MeasureHistogram,
    SobolSensitivity,
    SweepMap,
    SweepResult,
    Trend,
)
from uictest.report.sweep.tail_rows import tail_csv_tables

TREND_COLUMNS: Final = ("parameter", "value", "measure", "unit", "cases", "minimum", "mean", "maximum")
_FRONTIER_COLUMNS: Final = ("from", "to", "met_at_from", "flips", "note")
_INDEX_COLUMNS: Final = [f"{order}{end}" for order in ("first", "total") for end in ("", "_low", "_high")]


def csv_tables(result: SweepResult) -> dict[str, str]:
    """Return the CSV files of a sweep besides its summary, by file name."""
    tables = {
        "rates.csv": _rates_csv(result),
        **{f"map-{each.measure}.csv": map_csv(each) for each in result.maps},
        "trends.csv": csv_text(TREND_COLUMNS, (row for trend in result.trends for row in trend_rows(trend))),
    }
    if result.sensitivities:
        tables["sensitivity.csv"] = _sensitivity_csv(result)
    if result.frontier is not None:
        tables["frontier.csv"] = frontier_csv(result.frontier)
    return tables | tail_csv_tables(result)


def rate_rows(result: SweepResult) -> Iterator[dict[str, Cell]]:
    """Yield a row of counts for each value of each parameter."""
    for parameter, counts in result.rates.items():
        for count in counts:
            own: dict[str, Cell] = {"cases": count.cases, "met": count.met, "share_met": count.share_met}
            yield {"parameter": parameter, "value": count.value.label, **own, **count.outcomes}


def trend_rows(trend: Trend) -> Iterator[dict[str, Cell]]:
    """Yield a row for each value of the parameter."""
    own: dict[str, Cell] = {"parameter": trend.parameter, "measure": trend.measure, "unit": trend.unit}
    columns = (trend.values, trend.cases, trend.minimum, trend.mean, trend.maximum)
    for value, cases, minimum, mean, maximum in zip(*columns, strict=True):
        numbers: dict[str, Cell] = {"cases": cases, "minimum": minimum, "mean": mean, "maximum": maximum}
        yield {**own, "value": value.label, **numbers}


def distribution_rows(histogram: MeasureHistogram) -> Iterator[dict[str, Cell]]:
    """Yield a row for each bin: its ends, and its cases by outcome."""
    own: dict[str, Cell] = {"measure": histogram.measure, "unit": histogram.unit}
    for place, (low, high) in enumerate(itertools.pairwise(histogram.edges)):
        counts: dict[str, Cell] = {outcome: counts[place] for outcome, counts in histogram.counts.items()}
        yield {**own, "from": low, "to": high, **counts}


def sensitivity_rows(result: SweepResult, prefix: str = "") -> Iterator[dict[str, Cell]]:
    """Yield a row for each measure and parameter; circumstances are columns with a prefix."""
    for sensitivity in result.sensitivities:
        at: dict[str, Cell] = {
            f"{prefix}{key}": value.text for key, value in sensitivity.circumstances.items()
        }
        own: dict[str, Cell] = {"measure": sensitivity.measure, "parameter": sensitivity.key}
        yield {**own, **at, **_indices(sensitivity)}


def frontier_rows(frontier: Frontier, prefix: str = "") -> Iterator[dict[str, Cell]]:
    """Yield a row for each flip, or one with a note where there is none; circumstances as columns."""
    for scan in frontier.scans:
        at: dict[str, Cell] = {f"{prefix}{key}": value.text for key, value in scan.circumstances.items()}
        for flip in scan.flips or (None,):
            yield {**at, **_flip_cells(flip), "flips": len(scan.flips), "note": scan.note}


def map_csv(sweep_map: SweepMap) -> str:
    """Return a map as CSV: a line per value of the first parameter, a column per value of the other."""
    corner = f"{sweep_map.rows.parameter} \\ {sweep_map.columns.parameter}"
    columns = [corner, *(value.label for value in sweep_map.columns.values)]
    lines = zip(sweep_map.rows.values, sweep_map.means, strict=True)
    return csv_text(
        columns, (dict(zip(columns, [value.label, *means], strict=True)) for value, means in lines)
    )


def frontier_csv(frontier: Frontier) -> str:
    """Return the frontier as CSV."""
    return csv_text([*frontier.scans[0].circumstances, *_FRONTIER_COLUMNS], frontier_rows(frontier))


def _rates_csv(result: SweepResult) -> str:
    return csv_text(["parameter", "value", "cases", "met", "share_met", *result.outcomes], rate_rows(result))


def _sensitivity_csv(result: SweepResult) -> str:
    circumstances = list(result.sensitivities[0].circumstances)
    return csv_text(["measure", *circumstances, "parameter", *_INDEX_COLUMNS], sensitivity_rows(result))


def _indices(sensitivity: SobolSensitivity) -> Mapping[str, Cell]:
    indices = (sensitivity.first, sensitivity.total)
    numbers = [number for index in indices for number in (index.value, index.low, index.high)]
    return dict(zip(_INDEX_COLUMNS, numbers, strict=True))


def _flip_cells(flip: Flip | None) -> dict[str, Cell]:
    if flip is None:
        return {"from": None, "to": None, "met_at_from": None}
    return {"from": flip.low.text, "to": flip.high.text, "met_at_from": flip.met_at_low}
