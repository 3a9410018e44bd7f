"""The page of a run, put together."""

from __future__ import annotations

import math
import re
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from uictest.judging import evaluation
from uictest.report.case_lines import MOST_CLOSE, NARROW
from uictest.report.content import DRAWN, MOST_DRAWN, STOPS, RunContent, drawn_cases, worst_first
from uictest.report.difference import baseline_summary, differences_table, not_compared_sentences
from uictest.report.measure_columns import measure_columns
from uictest.report.page.case_view import STOP_WORDS, CaseView, case_view, shown_parts
from uictest.report.page.margins import margins_of, matrix_of
from uictest.report.page.rendering import case_anchor, case_fragment, render, series_fragment
from uictest.report.page.stop_plots import plots_json
from uictest.report.requirements import REQUIREMENT_TONES, verified_requirements
from uictest.report.rerun import rerun_commands
from uictest.report.summary import MOST_GROUPS, RunSummary, run_summary
from uictest.report.words import CASE_WORDS, counted


def page_html(content: RunContent) -> str:
    """Return the page: one document that loads nothing, and can be read without JavaScript."""
    results, baseline = content.results, content.baseline
    commands = rerun_commands(content)
    drawn = _views_of_drawn_cases(content, commands)
    drawn_ids = {view.result.id for view in drawn}
    # Those of drawn cases have the instants of their values.
    of_drawn = {view.result.id: view.margins for view in drawn}
    margins = {result.id: of_drawn.get(result.id) or margins_of(result.criteria) for result in results}
    words = [content.word(result) for result in results]
    summary, started = run_summary(content), _started(content.name)
    maps = list(maps_of(results))
    beside = _maps_beside(summary, maps, content)
    missed = next((view for view in drawn if not content.passes(view.result)), None)
    opened = drawn[0] if len(drawn) == 1 else missed
    repeated = [case for case in worst_first(results) if case.repeats and case.id not in drawn_ids]
    return render(
        "run.html.j2",
        content=content,
        command=shlex.join(content.manifest.command),
        drawn=drawn,
        keys={case_id: case_fragment(case_id) for case_id in drawn_ids},
        summary=summary,
        groups=list(zip(summary.groups[:MOST_GROUPS], beside, strict=False)),
        most_close=MOST_CLOSE,
        fragments={result.id: case_fragment(result.id) for result in results}
        | {series.id: series_fragment(series.id) for series in content.series},
        started=started,
        matrix=matrix_of(margins),
        narrow=NARROW,
        **_of_series(content),
        **STOP_WORDS,
        stops_key=STOPS,
        maps=[each for each in maps if each not in beside],
        requirements=verified_requirements(results, content.series),
        requirement_tones=REQUIREMENT_TONES,
        opened=case_anchor(opened.result.id) if opened else "",
        not_drawn=_not_drawn(content, drawn_ids),
        **shown_parts([view.result.parts for view in drawn] or [case.parts for case in content.all_results]),
        varied=(),
        of_which="the drawn stops" if drawn else "the cases",
        all_parts_in="results.json",
        words={word: words.count(word) for word in CASE_WORDS if word in words},
        measure_columns=[column for column in measure_columns(results) if column.heading],
        differences_table=differences_table,
        plots=plots_json(),
        with_plots=bool(drawn),
        running_head=" · ".join(filter(None, (content.uictest_version, content.name, started))),
        baseline_lines=[baseline_summary(baseline), *not_compared_sentences(baseline)] if baseline else [],
        repeats_not_drawn=repeated[:DRAWN],
    )


def _maps_beside(summary: RunSummary, maps: Iterable[CaseMap], content: RunContent) -> list[CaseMap | None]:
    """Return the map that stands beside each group: that of its worst case's scenario, once."""
    scenarios = {result.id: result.scenario for result in content.results}
    by_scenario = {each.scenario: each for each in maps}
    return [by_scenario.pop(scenarios.get(group.worst, ""), None) for group in summary.groups[:MOST_GROUPS]]


def _started(name: str) -> str:
    """Return when a run began, from its name: `2026-11-28 11:49 UTC`; empty for another name."""
    found = re.match(r"(\d{4})(\d\d)(\d\d)T(\d\d)(\d\d)\d\dZ-", name)
    return "{}-{}-{} {}:{} UTC".format(*found.groups()) if found else ""


def _of_series(content: RunContent) -> dict[str, Any]:
    """Return the data of the series for the page, those not as expected first."""
    if not content.series:
        return {"series": [], "series_first": False, "series_keys": {}}
    from uictest.report.page.series_view import SERIES_WORDS

    series = sorted(content.series, key=lambda result: result.met)
    fine = all(map(content.passes, content.results))
    return {
        "series": series,
        "series_first": fine and not all(result.met for result in series),
        "series_keys": {result.id: series_fragment(result.id) for result in series},
        **SERIES_WORDS,
    }


def _views_of_drawn_cases(content: RunContent, commands: Mapping[str, str]) -> list[CaseView]:
    """Return the cases that are drawn, those not as expected first."""
    ranked = sorted(worst_first(content.all_results), key=content.passes)
    traced = [result for result in ranked if result.id in content.traces]
    drawn_ids = {result.id for result in drawn_cases(traced, content.drawn_first)}
    accepted = content.baseline.values if content.baseline else {}
    return [
        case_view(
            result,
            content.subject(result.id),
            content.traces[result.id],
            content.differences(result.id),
            commands[result.id],
            accepted.get(result.id, {}),
        )
        for result in traced
        if result.id in drawn_ids
    ]


def _not_drawn(content: RunContent, drawn_ids: set[str]) -> str:
    """Return the note on which cases have plots and how others get some; empty where all have."""
    cases, drawn = len(content.all_results), len(drawn_ids)
    if cases == drawn:
        return ""
    if drawn < DRAWN:
        missing = counted(cases - drawn, "case")
        return f"No plots for {missing}: not recorded here, or the stop failed."
    lost = len(set(content.drawn_first) - drawn_ids)
    without = f" {lost} of those chosen with --draw are not among them." if lost else ""
    return f"Plots for {drawn} of {cases} cases.{without} More: --draw EXPR (at most {MOST_DRAWN})."


class CaseMap(NamedTuple):
    """Cases of a scenario by two keys; `cells[row][column]` is None where there is no such case."""

    scenario: str
    row_key: str
    column_key: str
    rows: Sequence[str]
    columns: Sequence[str]
    cells: Sequence[Sequence[evaluation.CaseResult | None]]


def maps_of(results: Iterable[evaluation.CaseResult]) -> Iterator[CaseMap]:
    """Yield a map for every scenario whose cases vary in exactly two keys, two values of each or more."""
    by_sweep: dict[tuple[str, ...], list[evaluation.CaseResult]] = {}
    for result in results:
        by_sweep.setdefault((result.scenario, *result.parameters), []).append(result)
    for (scenario, *keys), cases in by_sweep.items():
        varied = [key for key in keys if len({case.parameters[key] for case in cases}) > 1]
        if len(varied) != 2:
            continue
        row_key, column_key = varied
        by_values = {(case.parameters[row_key], case.parameters[column_key]): case for case in cases}
        if len(by_values) == len(cases):
            rows, columns = (_texts_by_number(key, cases) for key in varied)
            cells = [[by_values.get((row, column)) for column in columns] for row in rows]
            yield CaseMap(scenario, row_key, column_key, rows, columns, cells)


def _texts_by_number(key: str, cases: Iterable[evaluation.CaseResult]) -> list[str]:
    """Return the texts of a swept key by their numbers, where all of them are; else as they came."""
    numbers: dict[str, float] = {}
    for case in cases:
        of_parts = (parameter for part in case.parts.values() for parameter in part.parameters)
        value = next((parameter.value for parameter in of_parts if parameter.key == key), None)
        numbers[case.parameters[key]] = value if isinstance(value, int | float) else math.nan
    if any(map(math.isnan, numbers.values())):
        return list(numbers)
    return sorted(numbers, key=numbers.__getitem__)
