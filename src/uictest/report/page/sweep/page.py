"""The page of a sweep, put together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from uictest.report.page.case_view import CaseView, case_view, figures_of, gauge_of, plots_json
from uictest.report.page.parameter_tables import PARAMETER_WORDS, shown_parts
from uictest.report.page.rendering import render
from uictest.report.page.sweep.frontier_plot import FrontierPlot, frontier_plot, frontier_rows
from uictest.report.page.sweep.heat import HeatMap, heat_map
from uictest.report.page.sweep.histogram import histogram
from uictest.report.page.sweep.trend_plot import TrendPlot, trend_plot
from uictest.report.sweep.notable import notable_cases
from uictest.report.sweep.wording import (
    circumstances_words,
    command_alone,
    figure_words,
    share_words,
    sweep_tally,
    swept_words,
)
from uictest.report.wording import counted, failing_first, tone

if TYPE_CHECKING:
    from uictest.report.sweep.content import SweepContent

_MOST_VALUES = 40
"""Values of a parameter that get a bar each."""


def sweep_page_html(content: SweepContent) -> str:
    """Return the page: one document that loads nothing, and can be read without JavaScript."""
    document, drawn = content.document, _drawn(content)
    keys = {view.result.id: view.key for view in drawn}
    return render(
        "sweep.html.j2",
        content=content,
        document=document,
        tally=sweep_tally(document),
        swept={key: swept_words(_values(counts)) for key, counts in document["rates"].items()},
        maps=list(_maps(content, keys)),
        rates={key: counts for key, counts in document["rates"].items() if len(counts) <= _MOST_VALUES},
        frontier=_frontier(document),
        trends=_trends(document),
        histograms=[histogram(found) for found in document["distributions"]],
        notable=notable_cases(content),
        drawn=drawn,
        keys=keys,
        opened=next((view.key for view in drawn if not view.result.met), ""),
        parts=shown_parts([content.base, *(view.result.parts for view in drawn)]),
        varied=document.get("varied", ()),
        of_which="the scenario that is varied and the drawn stops",
        all_parts_in="sweep.json",
        plots=plots_json(),
        with_plots=bool(drawn),
        alone=command_alone(content.manifest),
        circumstances_words=circumstances_words,
        counted=counted,
        failing_first=failing_first,
        figure_words=figure_words,
        figures_of=figures_of,
        gauge_of=gauge_of,
        share_words=share_words,
        tone=tone,
        **PARAMETER_WORDS,
    )


def _values(counts: Sequence[Mapping[str, Any]]) -> list[str]:
    return [each["value"] for each in counts]


def _drawn(content: SweepContent) -> list[CaseView]:
    traced = [result for result in content.worst if result.id in content.traces]
    return [
        case_view(f"case-{place}", result, content.subject(result.id), content.traces[result.id])
        for place, result in enumerate(traced, start=1)
    ]


def _maps(content: SweepContent, keys: Mapping[str, str]) -> Iterator[HeatMap]:
    for found in content.document["maps"]:
        pair = (found["rows"]["parameter"], found["columns"]["parameter"])
        # The worst come first, and a cell leads to the worst of its cases.
        places = {
            tuple(result.parameters.get(key, "") for key in pair): keys[result.id]
            for result in reversed(content.worst)
            if result.id in keys
        }
        yield heat_map(found, places)  # type: ignore[arg-type]  # pairs have two members


def _trends(document: Mapping[str, Any]) -> dict[str, list[TrendPlot]]:
    """Return the plots of each parameter that has any."""
    drawn: dict[str, list[TrendPlot]] = {}
    for found in document["trends"]:
        key = found["parameter"]
        plot = trend_plot(found, document["rates"][key])
        if plot is not None:
            drawn.setdefault(key, []).append(plot)
    return drawn


def _frontier(document: Mapping[str, Any]) -> tuple[FrontierPlot | None, list[tuple[str, str, str]]] | None:
    found = document["frontier"]
    return (frontier_plot(found), frontier_rows(found)) if found else None
