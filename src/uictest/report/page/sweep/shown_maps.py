"""Which heat maps the page of a sweep has: every pair of its parameters, from the rows of its summary."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from uictest.report.page.sweep.heat import HeatMaps, heat_maps
from uictest.report.sweep.content import SweepContent
from uictest.report.sweep.map_cells import (
    MOST_PARAMETERS,
    MapCells,
    cells_of_maps,
    map_cells,
    mapped_pairs,
)
from uictest.report.sweep.result import SweepResult
from uictest.report.sweep.summary_rows import ReportedColumns, SummaryRows, reported_columns


def shown_maps(content: SweepContent, fragments: Mapping[str, str]) -> Iterator[HeatMaps]:
    """Yield the maps of each pair of parameters, the pair of the result first.

    Args:
        content: the sweep.
        fragments: what links to each drawn stop, by id.

    Raises:
        OSError: the summary of the sweep cannot be read.
        ValueError: it does not belong to the result.

    """
    result = content.result
    units = {measure.name: measure.unit for measure in reported_columns(result)}
    for cells in _cells(content):
        yield heat_maps(cells, units, _stops_in(cells, result, fragments), result.logarithmic, result.varied)


def _cells(content: SweepContent) -> list[MapCells]:
    result, rows = content.result, SummaryRows(content.folder)
    measures = reported_columns(result)
    if rows.exists and (pairs := mapped_pairs(result)):
        return map_cells(result, rows, pairs, _requested_first(result, measures))
    return [cells_of_maps(result.maps, measures)] if result.maps else []


def _stops_in(
    cells: MapCells, result: SweepResult, fragments: Mapping[str, str]
) -> dict[tuple[int, int], str]:
    """Return the fragment of the drawn stop of each cell that has one."""
    stops = {}
    # The worst come first, and a cell links to the worst of its cases.
    for case in reversed(result.worst):
        row, column = (
            axis.place_of(case.parameters.get(axis.parameter, "")) for axis in (cells.rows, cells.columns)
        )
        if case.id in fragments and row is not None and column is not None:
            stops[row, column] = fragments[case.id]
    return stops


def _requested_first(result: SweepResult, measures: Sequence[ReportedColumns]) -> list[ReportedColumns]:
    """Return the measures, those first that were requested for the maps of the result."""
    requested = {each.measure for each in result.maps}
    return sorted(measures, key=lambda measure: not requested.intersection(measure.columns))


def maps_left_out(content: SweepContent) -> str:
    """Return why there are no maps of some parameters; empty where nothing is left out."""
    keys = [key for key in content.result.varied if len(content.result.rates.get(key, ())) > 1]
    if not SummaryRows(content.folder).exists:
        return "Without summary.parquet beside sweep.json there are no maps of other parameters and measures"
    left_out = ", ".join(keys[MOST_PARAMETERS:])
    return f"Not in every pair: {left_out}; --map chooses another first pair" if left_out else ""
