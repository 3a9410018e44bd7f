"""The result of a sweep as tables for programs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from uictest.core.document import Cell, Data
from uictest.report.firmness_sentences import firmness_rows
from uictest.report.sweep.result import Frontier, SweepMap, SweepResult, Trend

TREND_COLUMNS: Final = ("parameter", "value", "measure", "unit", "cases", "minimum", "mean", "maximum")
_RATE_COLUMNS: Final = ["parameter", "value", "cases", "met", "share_met"]
_FRONTIER_COLUMNS: Final = ("from", "to", "met_at_from", "flips", "note")
_INDEX_COLUMNS: Final = [f"{order}{end}" for order in ("first", "total") for end in ("", "_low", "_high")]


def sweep_tables(result: SweepResult) -> dict[str, Data]:
    """Return the tables of a sweep besides its summary by the names of their files, without `.csv`."""
    trends = [row for trend in result.trends for row in trend_rows(trend)]
    tables = {
        "rates": Data([*_RATE_COLUMNS, *result.outcomes], list(rate_rows(result))),
        **{f"map-{each.measure}": map_data(each) for each in result.maps},
        "trends": Data(TREND_COLUMNS, trends),
    }
    if result.sensitivities:
        tables["sensitivity"] = sensitivity_data(result)
    if result.frontier is not None:
        tables["frontier"] = frontier_data(result.frontier)
    if rows := list(firmness_of_nominal(result)):
        tables["firmness"] = Data(list(rows[0]), rows)
    return tables


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


def sensitivity_rows(result: SweepResult) -> Iterator[dict[str, Cell]]:
    """Yield a row for each measure and parameter; circumstances are columns."""
    for sensitivity in result.sensitivities:
        at: dict[str, Cell] = {key: value.text for key, value in sensitivity.circumstances.items()}
        own: dict[str, Cell] = {"measure": sensitivity.measure, "parameter": sensitivity.key}
        indices = (sensitivity.first, sensitivity.total)
        numbers = [number for index in indices for number in (index.value, index.low, index.high)]
        yield {**own, **at, **dict(zip(_INDEX_COLUMNS, numbers, strict=True))}


def frontier_rows(frontier: Frontier) -> Iterator[dict[str, Cell]]:
    """Yield a row for each flip, or one with a note where there is none; circumstances as columns."""
    for scan in frontier.scans:
        at: dict[str, Cell] = {key: value.text for key, value in scan.circumstances.items()}
        for flip in scan.flips or (None,):
            cells: dict[str, Cell] = {"from": None, "to": None, "met_at_from": None}
            if flip is not None:
                cells = {"from": flip.low.text, "to": flip.high.text, "met_at_from": flip.met_at_low}
            yield {**at, **cells, "flips": len(scan.flips), "note": scan.note}


def firmness_of_nominal(result: SweepResult) -> Iterator[dict[str, Cell]]:
    """Yield a row for each ranged number and criterion of the nominal cases; nothing where nobody asked."""
    for nominal in result.nominal:
        if nominal.firmness is not None:
            yield from firmness_rows(nominal.id, nominal.firmness)


def map_data(sweep_map: SweepMap) -> Data:
    """Return a map: a row per value of the first parameter, a column per value of the other."""
    corner = f"{sweep_map.rows.parameter} \\ {sweep_map.columns.parameter}"
    columns = [corner, *(value.label for value in sweep_map.columns.values)]
    lines = zip(sweep_map.rows.values, sweep_map.means, strict=True)
    return Data(columns, [dict(zip(columns, [value.label, *means], strict=True)) for value, means in lines])


def frontier_data(frontier: Frontier) -> Data:
    """Return the frontier."""
    return Data([*frontier.scans[0].circumstances, *_FRONTIER_COLUMNS], list(frontier_rows(frontier)))


def sensitivity_data(result: SweepResult) -> Data:
    """Return the Sobol indices."""
    circumstances = list(result.sensitivities[0].circumstances)
    columns = ["measure", *circumstances, "parameter", *_INDEX_COLUMNS]
    return Data(columns, list(sensitivity_rows(result)))
