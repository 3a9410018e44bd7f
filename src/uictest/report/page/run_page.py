"""The page of a run, put together."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from itertools import islice
from typing import Any

from uictest.judging import evaluation
from uictest.report.campaign import STOPS
from uictest.report.case_table import measure_columns
from uictest.report.case_words import CASE_WORDS
from uictest.report.close_calls import MOST_CLOSE, NARROW
from uictest.report.content import DRAWN, MOST_DRAWN, RunContent, drawn_cases, worst_first
from uictest.report.counts import counted
from uictest.report.difference import (
    baseline_summary,
    differences_table,
    not_compared_sentences,
)
from uictest.report.page.case_view import CaseView, case_view, plots_json
from uictest.report.page.findings import (
    MOST_FINDINGS,
    close_of,
    closest_of,
    findings_of,
    margins_of_all,
    matrix_of,
)
from uictest.report.page.links import case_anchor, rerun_commands
from uictest.report.page.overview import maps_of, shown_parts
from uictest.report.page.rendering import render
from uictest.report.page.repeats_view import RepeatsView, repeats_view
from uictest.report.part_wording import vehicles_text
from uictest.report.requirements import REQUIREMENT_TONES, verified_requirements


def page_html(content: RunContent) -> str:
    """Return the page: one document that loads nothing, and can be read without JavaScript."""
    commands = rerun_commands(content)
    drawn = _drawn(content, commands)
    margins = margins_of_all(content, drawn)
    words = [content.word(result) for result in content.results]
    baseline = content.baseline
    keys = {view.result.id: view.fragment for view in drawn}
    return render(
        "run.html.j2",
        content=content,
        command=shlex.join(content.manifest.command),
        drawn=drawn,
        keys=keys,
        case_anchor=case_anchor,
        findings=findings_of(content, margins, commands),
        most_findings=MOST_FINDINGS,
        close=close_of(content, margins),
        most_close=MOST_CLOSE,
        closest=closest_of(content, margins),
        matrix=matrix_of(margins),
        narrow=NARROW,
        **_of_series(content),
        stops_key=STOPS,
        maps=maps_of(content.results),
        requirements=verified_requirements(content.results, content.series),
        requirement_tones=REQUIREMENT_TONES,
        opened=_opened(content, drawn),
        not_drawn=_not_drawn(content, drawn),
        parts=shown_parts(
            [view.result.parts for view in drawn] or [each.parts for each in content.all_results]
        ),
        varied=(),
        of_which="the drawn stops" if drawn else "the cases",
        all_parts_in="results.json",
        words={word: words.count(word) for word in CASE_WORDS if word in words},
        measure_columns=measure_columns(content.results),
        vehicles=vehicles_text(content.all_results),
        differences_table=differences_table,
        plots=plots_json(),
        with_plots=bool(drawn),
        running_head=content.name,
        baseline_lines=[baseline_summary(baseline), *not_compared_sentences(baseline)] if baseline else [],
        repeats_not_drawn=_repeats_not_drawn(content, drawn),
    )


def _of_series(content: RunContent) -> dict[str, Any]:
    """Return what the page shows of series; what is not as expected stands first."""
    if not content.series:
        return {"series": [], "series_first": False, "series_keys": {}}
    from uictest.report.page.series_view import SERIES_WORDS, series_view

    series = [series_view(each) for each in sorted(content.series, key=lambda each: each.met)]
    fine = all(map(content.passes, content.results))
    return {
        "series": series,
        "series_first": fine and not all(each.met for each in content.series),
        "series_keys": {view.result.id: view.fragment for view in series},
        **SERIES_WORDS,
    }


def _drawn(content: RunContent, commands: Mapping[str, str]) -> list[CaseView]:
    traced = [
        result
        for result in sorted(worst_first(content.all_results), key=content.passes)
        if result.id in content.traces
    ]
    shown = {result.id for result in drawn_cases(traced, content.drawn_first)}
    return [
        case_view(
            result,
            content.subject(result.id),
            content.traces[result.id],
            content.differences(result.id),
            commands[result.id],
            content.baseline.values.get(result.id, {}) if content.baseline else {},
        )
        for result in traced
        if result.id in shown
    ]


def _repeats_not_drawn(
    content: RunContent, drawn: Sequence[CaseView]
) -> list[tuple[evaluation.CaseResult, RepeatsView]]:
    """Return the repeated cases that are not drawn, with their stops; of many the worst."""
    shown = {view.result.id for view in drawn}
    views = (
        (result, view)
        for result in worst_first(content.results)
        if result.id not in shown and (view := repeats_view(result)) is not None
    )
    return list(islice(views, DRAWN))


def _opened(content: RunContent, drawn: Sequence[CaseView]) -> str:
    """Return the anchor of the case that is open at first: the first that does not pass, or the only one."""
    if len(drawn) == 1:
        return drawn[0].anchor
    return next((view.anchor for view in drawn if not content.passes(view.result)), "")


def _not_drawn(content: RunContent, drawn: Sequence[CaseView]) -> str:
    """Return how many cases have plots, which, and how others get some; empty where all have."""
    of, missing = len(content.all_results), len(content.all_results) - len(drawn)
    if not missing:
        return ""
    shown = {view.result.id for view in drawn}
    lost = sum(case_id not in shown for case_id in content.drawn_first)
    if len(drawn) < DRAWN:
        return f"{counted(missing, 'case')} not drawn: there is no recording of it here, or the stop failed."
    without = f" (not {lost} of them)" if lost else ""
    chosen = f"those chosen with --draw{without}, then " if content.drawn_first else ""
    return (
        f"{len(drawn)} of {of} cases are drawn: {chosen}those not as expected, then those with the narrowest "
        "margins, from every scenario in turn. To have others drawn, and compared, give uictest run the "
        f"option --draw EXPR with an expression as for -k (at most {MOST_DRAWN} cases); uictest report takes "
        "it, too, for cases with a recording. Every criterion of every case is in criteria.csv."
    )
