"""The page of a sweep, put together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from uictest.report.page.case_view import CaseView, case_view, gauge_of, plots_json
from uictest.report.page.parameter_tables import PARAMETER_WORDS, shown_parts
from uictest.report.page.rendering import render
from uictest.report.page.sweep.frontier_plot import FrontierPlot, frontier_lines, frontier_plot
from uictest.report.page.sweep.heat import HeatMap, heat_map
from uictest.report.page.sweep.histogram import histogram_plot
from uictest.report.page.sweep.trend_plot import TrendPlot, trend_plot
from uictest.report.sweep.content import SweepContent
from uictest.report.sweep.notable import notable_cases
from uictest.report.sweep.result import Frontier, SweepResult
from uictest.report.sweep.tail_tables import tables_left_out, tail_tables
from uictest.report.sweep.wording import (
    circumstances_words,
    command_alone,
    measure_words,
    share_words,
    sweep_tally,
    swept_words,
)
from uictest.report.wording import counted, failing_first, tone

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
        maps=list(_maps(result, keys)),
        rates={key: counts for key, counts in result.rates.items() if len(counts) <= _MOST_VALUES},
        frontier=_frontier(result.frontier),
        trends=_trends(result),
        histograms=list(map(histogram_plot, result.distributions)),
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


def _maps(result: SweepResult, keys: Mapping[str, str]) -> Iterator[HeatMap]:
    for sweep_map in result.maps:
        row, column = sweep_map.rows.parameter, sweep_map.columns.parameter
        # The worst come first, and a cell links to the worst of its cases.
        keys_by_values = {
            (case.parameters.get(row, ""), case.parameters.get(column, "")): keys[case.id]
            for case in reversed(result.worst)
            if case.id in keys
        }
        yield heat_map(sweep_map, keys_by_values)


def _trends(result: SweepResult) -> dict[str, list[TrendPlot]]:
    """Return the plots of each parameter that has any."""
    plots: dict[str, list[TrendPlot]] = {}
    for trend in result.trends:
        plot = trend_plot(trend, result.rates[trend.parameter])
        if plot is not None:
            plots.setdefault(trend.parameter, []).append(plot)
    return plots


def _frontier(frontier: Frontier | None) -> tuple[FrontierPlot | None, list[tuple[str, str, str]]] | None:
    return (frontier_plot(frontier), frontier_lines(frontier)) if frontier else None
