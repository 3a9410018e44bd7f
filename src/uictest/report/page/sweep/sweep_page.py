"""The page of a sweep as HTML: maps, lines, sensitivities, frontier, and worst stops."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from uictest.report.escaping import printable
from uictest.report.page.case_view import case_view, plots_json
from uictest.report.page.overview import shown_parts
from uictest.report.page.plot import Plot
from uictest.report.page.rendering import load_template, render
from uictest.report.page.sweep.line_plots import cell_lines, frontier_plot, trend_plot
from uictest.report.page.sweep.maps import maps_of_pair
from uictest.report.part_wording import controller_text
from uictest.report.sweep.cases import ReportedColumns, SummaryRows, reported_columns
from uictest.report.sweep.folder import SweepContent
from uictest.report.sweep.map_cells import (
    MOST_PARAMETERS,
    MapCells,
    cells_of_maps,
    map_cells,
    mapped_pairs,
)
from uictest.report.sweep.result import OutcomeCount, SweepResult
from uictest.report.sweep.summary_tables import frontier_table, notable_table, sensitivity_table
from uictest.report.sweep.sweep_sentences import (
    command_alone,
    share_words,
    sweep_tally,
    swept_words,
)
from uictest.report.sweep.values import DrawnInterval

_TEMPLATE: Final = "sweep.html.j2"


def load_sweep_page() -> None:
    """Load what a page takes besides its content."""
    load_template(_TEMPLATE)


def sweep_page_html(content: SweepContent) -> str:
    """Return the page: one document that loads nothing, and can be read without JavaScript.

    Raises:
        OSError: the summary of the sweep cannot be read.
        ValueError: it does not belong to the result.

    """
    result = content.result
    drawn = [
        case_view(case, result.subject(case.id), content.traces[case.id])
        for case in result.worst
        if case.id in content.traces
    ]
    keys = {view.result.id: view.fragment for view in drawn}
    sampled = _is_sampled(result)
    cells = _cells(content)
    units = {measure.name: measure.unit for measure in reported_columns(result)}
    # A cell of a sample has few cases, and values of its own: what a parameter does, its trends show.
    lines = [] if sampled else [cell_lines(each, units, result.logarithmic) for each in cells]
    maps = [
        maps_of_pair(
            each,
            units,
            _stops_in(each, result, keys),
            result.varied,
            with_measures=not sampled and not lines[place],
        )
        for place, each in enumerate(cells)
    ]
    frontier = result.frontier
    return render(
        _TEMPLATE,
        content=content,
        result=result,
        tally=sweep_tally(result),
        controllers=", ".join(
            controller_text(printable(each.name), printable(each.version), built_in=not each.kind)
            for each in result.controllers
        ),
        swept={key: swept_words([count.value for count in counts]) for key, counts in result.rates.items()},
        maps=[each for each in maps if each],
        maps_left_out=maps_left_out(content),
        lines=[each for each in lines if each],
        rates={} if len(result.varied) == 2 and maps and maps[0] else _rates(result),
        frontier=frontier and (frontier_plot(frontier, result.logarithmic), frontier_table(frontier)),
        trends={} if any(lines) else _trends(result),
        notable=notable_table(result),
        sensitivities=sensitivity_table(result),
        drawn=drawn,
        keys=keys,
        opened=next((view.anchor for view in drawn if not view.result.met), ""),
        parts=shown_parts([result.base, *(view.result.parts for view in drawn)]),
        varied=result.varied,
        of_which="the scenario that is varied and the drawn stops",
        all_parts_in="sweep.json",
        plots=plots_json(),
        with_plots=bool(drawn),
        running_head=result.name,
        alone=command_alone(content.manifest),
        share_words=share_words,
    )


_MOST_VALUES: Final = 40
"""Values of a parameter that get a bar each."""


def _rates(result: SweepResult) -> dict[str, Sequence[OutcomeCount]]:
    """Return the cases met by value, of parameters with few values; none where all cases are met."""
    if result.met == result.cases:
        return {}
    return {key: counts for key, counts in result.rates.items() if len(counts) <= _MOST_VALUES}


def _is_sampled(result: SweepResult) -> bool:
    """Return whether any parameter was drawn from a distribution of numbers."""
    values = (count.value for counts in result.rates.values() for count in counts)
    return any(isinstance(value, DrawnInterval) for value in values)


def _trends(result: SweepResult) -> dict[str, list[Plot]]:
    """Return the plots of each parameter that has any."""
    plots: dict[str, list[Plot]] = {}
    for trend in result.trends:
        is_log = trend.parameter in result.logarithmic
        plot = trend_plot(trend, result.rates[trend.parameter], logarithmic=is_log)
        if plot is not None:
            plots.setdefault(trend.parameter, []).append(plot)
    return plots


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
