"""The page of a sweep, put together, and which heat maps it has."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain

from uictest.report.page.case_view import case_view, plots_json
from uictest.report.page.overview import shown_parts
from uictest.report.page.rendering import render
from uictest.report.page.stop.overlay_view import script_json
from uictest.report.page.sweep.frontier_plot import frontier_plot
from uictest.report.page.sweep.heat import HeatMaps, heat_maps
from uictest.report.page.sweep.histogram import histogram_plot
from uictest.report.page.sweep.scatter import ScatterView, is_sampled, scatter, scatter_view
from uictest.report.page.sweep.sobol_bars import sobol_plots
from uictest.report.page.sweep.trend_plot import TrendPlot, trend_plot
from uictest.report.sweep.folder import SweepContent
from uictest.report.sweep.map_cells import (
    MOST_PARAMETERS,
    MapCells,
    cells_of_maps,
    map_cells,
    mapped_pairs,
)
from uictest.report.sweep.result import OutcomeCount, SweepResult
from uictest.report.sweep.summary_rows import ReportedColumns, SummaryRows, reported_columns
from uictest.report.sweep.summary_tables import frontier_table, notable_table, sensitivity_table
from uictest.report.sweep.sweep_sentences import (
    command_alone,
    share_words,
    sweep_tally,
    swept_words,
)
from uictest.report.sweep.tables import (
    TREND_COLUMNS,
    distribution_rows,
    frontier_csv,
    sensitivity_csv,
    trend_rows,
)
from uictest.report.sweep.tail_tables import tables_left_out, tail_tables
from uictest.report.text_tables import csv_text


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


_MOST_VALUES = 40
"""Values of a parameter that get a bar each."""


def sweep_page_html(content: SweepContent) -> str:
    """Return the page: one document that loads nothing, and can be read without JavaScript."""
    result = content.result
    frontier = result.frontier
    drawn = [
        case_view(case, result.subject(case.id), content.traces[case.id])
        for case in result.worst
        if case.id in content.traces
    ]
    keys = {view.result.id: view.fragment for view in drawn}
    points = _scatter(content, keys)
    maps = list(shown_maps(content, keys))
    # With two parameters the lines of the cells say all; a mean over the other one would mix them.
    in_lines = len(maps) == 1 and len(result.varied) == 2 and maps[0].lines
    trends = {} if points or in_lines else _trends(result)
    return render(
        "sweep.html.j2",
        content=content,
        result=result,
        tally=sweep_tally(result),
        swept={key: swept_words([count.value for count in counts]) for key, counts in result.rates.items()},
        maps=maps,
        maps_left_out=maps_left_out(content),
        scatter=points,
        rates=_rates(result),
        frontier=frontier and (frontier_plot(frontier, result.logarithmic), frontier_table(frontier)),
        trends=trends,
        sobol_plots=list(sobol_plots(result.sensitivities)),
        histograms=list(map(histogram_plot, result.distributions)),
        plot_tables=script_json(_plot_tables(result, with_trends=bool(trends))),
        tails=list(tail_tables(result)),
        tails_left_out=tables_left_out(result),
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


def _rates(result: SweepResult) -> dict[str, Sequence[OutcomeCount]]:
    """Return the cases met by value, of parameters with few values; none where all cases are met."""
    if result.met == result.cases:
        return {}
    return {key: counts for key, counts in result.rates.items() if len(counts) <= _MOST_VALUES}


def _scatter(content: SweepContent, fragments: Mapping[str, str]) -> ScatterView | None:
    rows = SummaryRows(content.folder)
    if not rows.exists or not is_sampled(content.result):
        return None
    return scatter_view(scatter(content.result, rows, fragments), fragments)


def _trends(result: SweepResult) -> dict[str, list[TrendPlot]]:
    """Return the plots of each parameter that has any."""
    plots: dict[str, list[TrendPlot]] = {}
    for trend in result.trends:
        is_log = trend.parameter in result.logarithmic
        plot = trend_plot(trend, result.rates[trend.parameter], logarithmic=is_log)
        if plot is not None:
            plots.setdefault(trend.parameter, []).append(plot)
    return plots


def _plot_tables(result: SweepResult, *, with_trends: bool) -> dict[str, str]:
    """Return the numbers behind the drawings that have no table of their own, as CSV by file name."""
    tables = {}
    if with_trends:
        tables["trends.csv"] = csv_text(TREND_COLUMNS, chain.from_iterable(map(trend_rows, result.trends)))
    if result.distributions:
        rows = [row for each in result.distributions for row in distribution_rows(each)]
        tables["distributions.csv"] = csv_text(list(dict.fromkeys(chain.from_iterable(rows))), rows)
    if result.frontier is not None:
        tables["frontier.csv"] = frontier_csv(result.frontier)
    if result.sensitivities:
        tables["sensitivity.csv"] = sensitivity_csv(result)
    return tables
