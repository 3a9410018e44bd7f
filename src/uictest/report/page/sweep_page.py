"""The page of a sweep as HTML: maps, lines, sensitivities, frontier, and worst stops."""

from __future__ import annotations

from collections.abc import Mapping

from uictest.report.case_conditions import controller_text
from uictest.report.page.case_view import STOP_WORDS, case_view, shown_parts
from uictest.report.page.plot import Plot
from uictest.report.page.rendering import case_anchor, case_fragment, render
from uictest.report.page.stop_plots import plots_json
from uictest.report.page.sweep_lines import cell_lines, frontier_plot, trend_plot
from uictest.report.page.sweep_maps import maps_of_pair
from uictest.report.sweep.cases import SummaryRows, reported_columns
from uictest.report.sweep.result import SweepContent, SweepResult
from uictest.report.sweep.sweep_maps import MOST_PARAMETERS, MapCells, cells_of_maps, map_cells, mapped_pairs
from uictest.report.sweep.sweep_sentences import (
    command_alone,
    missed_blocks,
    sweep_tally,
    swept_words,
    where_met,
)
from uictest.report.sweep.sweep_tables import frontier_table, sensitivity_table, short_rates
from uictest.report.sweep.values import DrawnInterval
from uictest.report.words import printable


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
    keys = {view.result.id: case_fragment(view.result.id) for view in drawn}
    missed = next((view.result for view in drawn if not view.result.met), None)
    counted_values = (count.value for counts in result.rates.values() for count in counts)
    sampled = any(isinstance(value, DrawnInterval) for value in counted_values)
    cells = _mapped_cells(content)
    units = {measure.name: measure.unit for measure in reported_columns(result)}
    # A cell of a sample has few cases, and values of its own: what a parameter does, its trends show.
    lines = [None if sampled else cell_lines(pair, units, result.logarithmic) for pair in cells]
    maps = [
        maps_of_pair(
            pair,
            units,
            _stops_in(pair, result, keys),
            result.varied,
            with_measures=not sampled and not lines_of_pair,
        )
        for pair, lines_of_pair in zip(cells, lines, strict=True)
    ]
    of_two = len(result.varied) == 2 and maps and maps[0]  # then the map says it
    frontier = result.frontier
    return render(
        "sweep.html.j2",
        content=content,
        result=result,
        tally=sweep_tally(result),
        controllers=", ".join(
            controller_text(printable(tested.name), printable(tested.version), built_in=not tested.kind)
            for tested in result.controllers
        ),
        swept={key: swept_words([count.value for count in counts]) for key, counts in result.rates.items()},
        maps=[pair for pair in maps if pair],
        maps_left_out=maps_left_out(content),
        lines=[pair for pair in lines if pair],
        rates=[] if result.met == result.cases or of_two else list(short_rates(result)),
        frontier=frontier and (frontier_plot(frontier, result.logarithmic), frontier_table(frontier)),
        trends={} if any(lines) else _trend_plots(result),
        sensitivities=sensitivity_table(result),
        drawn=drawn,
        keys=keys,
        opened=case_anchor(missed.id) if missed else "",
        **shown_parts([result.base, *(view.result.parts for view in drawn)]),
        **STOP_WORDS,
        varied=result.varied,
        of_which="the scenario that is varied and the drawn stops",
        all_parts_in="results.json",
        plots=plots_json(),
        with_plots=bool(drawn),
        running_head=result.name,
        alone=command_alone(content.manifest),
        where_met=where_met(result),
        missed=missed_blocks(result, content.manifest),
    )


def _mapped_cells(content: SweepContent) -> list[MapCells]:
    """Return the cells of every pair of parameters that is mapped."""
    result, rows = content.result, SummaryRows(content.folder)
    measures = reported_columns(result)
    if rows.exists and (pairs := mapped_pairs(result)):
        # First those that were requested for the maps of the result.
        requested = {requested_map.measure for requested_map in result.maps}
        measures.sort(key=lambda measure: not requested.intersection(measure.columns))
        return map_cells(result, rows, pairs, measures)
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


def _trend_plots(result: SweepResult) -> dict[str, list[Plot]]:
    """Return the plots of each parameter that has any."""
    plots: dict[str, list[Plot]] = {}
    for trend in result.trends:
        is_log = trend.parameter in result.logarithmic
        plot = trend_plot(trend, result.rates[trend.parameter], logarithmic=is_log)
        if plot is not None:
            plots.setdefault(trend.parameter, []).append(plot)
    return plots


def maps_left_out(content: SweepContent) -> str:
    """Return the note on parameters without maps; empty where nothing is left out."""
    keys = [key for key in content.result.varied if len(content.result.rates.get(key, ())) > 1]
    if not SummaryRows(content.folder).exists:
        return "Without summary.parquet there are no maps of other parameters and measures"
    left_out = ", ".join(keys[MOST_PARAMETERS:])
    return f"Not in every pair: {left_out}; --map chooses another first pair" if left_out else ""
