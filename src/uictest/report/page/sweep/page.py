"""The page of a sweep, put together."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain

from uictest.report.csv_text import csv_text
from uictest.report.page.case_view import CaseView, case_view, gauge_of, plots_json
from uictest.report.page.parameter_tables import PARAMETER_WORDS, shown_parts
from uictest.report.page.rendering import render
from uictest.report.page.stop.packing import script_json
from uictest.report.page.sweep.frontier_plot import FrontierPlot, frontier_lines, frontier_plot
from uictest.report.page.sweep.histogram import histogram_plot
from uictest.report.page.sweep.scatter_view import ScatterView, scatter_view
from uictest.report.page.sweep.shown_maps import maps_left_out, shown_maps
from uictest.report.page.sweep.sobol_bars import sobol_plots
from uictest.report.page.sweep.trend_plot import TrendPlot, trend_plot
from uictest.report.sweep.content import SweepContent
from uictest.report.sweep.notable import notable_cases
from uictest.report.sweep.result import SweepResult
from uictest.report.sweep.scatter import is_sampled, scatter
from uictest.report.sweep.summary_rows import SummaryRows
from uictest.report.sweep.tables import TREND_COLUMNS, distribution_rows, frontier_csv, trend_rows
from uictest.report.sweep.tail_tables import tables_left_out, tail_tables
from uictest.report.sweep.wording import (
    circumstances_words,
    command_alone,
    measure_words,
    share_words,
    sweep_tally,
    swept_words,
)
from uictest.report.wording import (
    counted,
    failing_first,
    reading_sentences,
    reading_sources,
    tone,
    without_rig_that_holds,
)

_MOST_VALUES = 40
"""Values of a parameter that get a bar each."""


def sweep_page_html(content: SweepContent) -> str:
    """Return the page: one document that loads nothing, and can be read without JavaScript."""
    result, drawn = content.result, _drawn(content)
    keys = {view.result.id: view.fragment for view in drawn}
    return render(
        "sweep.html.j2",
        content=content,
        result=result,
        tally=sweep_tally(result),
        swept={key: swept_words([count.value for count in counts]) for key, counts in result.rates.items()},
        maps=list(shown_maps(content, keys)),
        maps_left_out=maps_left_out(content),
        scatter=_scatter(content, keys),
        rates={key: counts for key, counts in result.rates.items() if len(counts) <= _MOST_VALUES},
        frontier=_frontier(result),
        trends=_trends(result),
        sobol_plots=list(sobol_plots(result.sensitivities)),
        histograms=list(map(histogram_plot, result.distributions)),
        plot_tables=script_json(_plot_tables(result)),
        tails=list(tail_tables(result)),
        tails_left_out=tables_left_out(result),
        notable=notable_cases(result),
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
        circumstances_words=circumstances_words,
        counted=counted,
        failing_first=failing_first,
        reading_sentences=reading_sentences,
        reading_sources=reading_sources,
        without_rig_that_holds=without_rig_that_holds,
        measure_words=measure_words,
        gauge_of=gauge_of,
        share_words=share_words,
        tone=tone,
        **PARAMETER_WORDS,
    )


def _drawn(content: SweepContent) -> list[CaseView]:
    result = content.result
    traced = [case for case in result.worst if case.id in content.traces]
    return [case_view(case, result.subject(case.id), content.traces[case.id]) for case in traced]


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


def _frontier(result: SweepResult) -> tuple[FrontierPlot | None, list[tuple[str, str, str]]] | None:
    frontier = result.frontier
    return (frontier_plot(frontier, result.logarithmic), frontier_lines(frontier)) if frontier else None


def _plot_tables(result: SweepResult) -> dict[str, str]:
    """Return the numbers behind the drawings that have no table of their own, as CSV by file name."""
    tables = {}
    if result.trends:
        tables["trends.csv"] = csv_text(TREND_COLUMNS, chain.from_iterable(map(trend_rows, result.trends)))
    if result.distributions:
        rows = [row for each in result.distributions for row in distribution_rows(each)]
        tables["distributions.csv"] = csv_text(list(dict.fromkeys(chain.from_iterable(rows))), rows)
    if result.frontier is not None:
        tables["frontier.csv"] = frontier_csv(result.frontier)
    return tables
