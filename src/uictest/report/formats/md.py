"""The summary in Markdown, as a job's summary on GitHub shows it."""

from __future__ import annotations

import math
from functools import partial

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS, Column
from uictest.judging import evaluation
from uictest.report import series as series_views
from uictest.report.content import RunContent
from uictest.report.difference import (
    BaselineComparison,
    Difference,
    baseline_summary,
    not_compared_sentences,
    side_text,
    worst_of_wheelsets,
)
from uictest.report.format_registry import ReportFormat
from uictest.report.github import LIMIT, append_to_step_summary
from uictest.report.part_wording import changes_of, domain_notices, slide_speed
from uictest.report.repeat_wording import any_repeated, stops_text
from uictest.report.requirements import VerifiedRequirement, verified_requirements
from uictest.report.text_tables import MarkdownTable, code, number_cell, prose, row
from uictest.report.wording import listed, reading_sentences

_DIFFERENCE_COLUMNS = ("case", "quantity", "baseline", "this run", "deviation", "tolerance", "unit", "remark")
_DIFFERENCES_SHOWN = 100
"""Quantities out of the tolerance of the baseline that a reader is shown here."""
_REQUIREMENT_COLUMNS = ("requirement", "status", "tested in", "not met in")
_REQUIREMENTS_SHOWN = 100
"""Requirements that a reader is shown here, those not met first."""
_READINGS_SHOWN = 100
"""Readings of criteria that a reader is shown here."""
_COLUMNS = (
    *("verdict", "case", "outcome"),
    *("distance, m", "time, s", "mean, m/s²", "initial, g", "slide above {}, %", "sliding, s", "locked, s"),
    *("changed parameters", "why"),
)
_PLACE_OF_STOPS = 3
"""Place of the column that says how many stops of a repeated case came out as expected."""


def markdown_summary(content: RunContent, limit: int = LIMIT) -> str:
    """Return the summary: the tally, then one row per case, those not met first.

    What would go beyond `limit` bytes is left out, and a last line says how many cases that is.
    """
    text = f"## uictest: {content.tally}\n\n"
    text += f"WSP controller: {prose(content.controllers)}.\n\n" if content.controllers else ""
    if not content.complete:
        text += "**Incomplete**: selected cases were not run.\n\n"
    text += "".join(f"{prose(line)}.\n\n" for line in domain_notices(content.all_results))
    text += series_views.series_markdown(content.series, limit // 2) if content.series else ""
    text += _baseline(content.baseline, limit // 2) if content.baseline else ""
    text += _requirements(content, limit // 4)
    repeated = any_repeated(content.results)
    rows = [_row(content, result, repeated=repeated) for result in content.ranked]
    columns = [title.format(slide_speed(content.results)) for title in _COLUMNS]
    alignment = "lllrrrrrrrll"
    if repeated:
        columns.insert(_PLACE_OF_STOPS, "stops")
        alignment = f"l{alignment}"
    table = MarkdownTable(columns, alignment, rows, "more cases are in `summary.csv` and `results.json`.")
    shown = content.results or not content.series
    text += table.within(limit - len(text.encode())) if shown else ""
    return text + _readings(content, limit - len(text.encode()))


def append_step_summary(content: RunContent) -> None:
    """Append the summary to the file that GitHub Actions names, where it does. Raises OSError."""
    append_to_step_summary(partial(markdown_summary, content))


def _requirements(content: RunContent, limit: int) -> str:
    """Return the table of the requirements that cases, series or their criteria name; empty without any."""
    verified = verified_requirements(content.results, content.series)
    requirements = sorted(verified, key=lambda each: each.status == "met")
    rows = [_requirement_row(each) for each in requirements]
    table = MarkdownTable(
        _REQUIREMENT_COLUMNS,
        "llrl",
        rows,
        "more requirements are in `requirements.csv`.",
        _REQUIREMENTS_SHOWN,
    )
    return f"{table.within(limit)}\n" if rows else ""


def _requirement_row(requirement: VerifiedRequirement) -> str:
    status = requirement.status if requirement.status == "met" else f"**{requirement.status}**"
    not_met = listed([f"{each.name} ({each.word})" for each in requirement.not_met])
    return row([code(requirement.id), status, str(len(requirement.tested)), prose(not_met)])


def _readings(content: RunContent, limit: int) -> str:
    """Return the table of criteria with several readings, one row for each."""
    rows = [
        row([code(result.id), code(verdict.id), prose(sentence)])
        for result in content.results
        for verdict in result.criteria
        for sentence in reading_sentences(verdict)
    ]
    rest = "more readings are in `criteria.csv`."
    table = MarkdownTable(("case", "criterion", "reading"), "lll", rows, rest, _READINGS_SHOWN)
    return f"\n{table.within(limit)}" if rows else ""


def _baseline(baseline: BaselineComparison, limit: int) -> str:
    """Return how the run compares with its baseline, with a table of the quantities out of tolerance."""
    text = "".join(
        f"{prose(line)}.\n\n" for line in (baseline_summary(baseline), *not_compared_sentences(baseline))
    )
    rows = [_difference_row(each) for each in worst_of_wheelsets(baseline.all_differences)]
    rest = "more quantities are in `results.json`."
    table = MarkdownTable(_DIFFERENCE_COLUMNS, "llrrrrll", rows, rest, _DIFFERENCES_SHOWN)
    return f"{text}{table.within(limit)}\n" if rows else text


def _difference_row(difference: Difference) -> str:
    sides = (prose(side_text(side)) for side in (difference.first, difference.second))
    sizes = (number_cell(size, ".5g") for size in (difference.deviation, difference.allowed))
    unit, remark = prose(difference.unit), prose(difference.remark)
    return row([code(difference.case), code(difference.quantity), *sides, *sizes, unit, remark])


def _row(content: RunContent, result: evaluation.CaseResult, *, repeated: bool) -> str:
    word, passes = content.word(result), content.passes(result)
    measures = result.measures or {}
    cells = [_cell(column, measures.get(name)) for name, column in STOP_COLUMNS.items() if column.overview]
    for name in ("maximum_slide", "sliding_time_s", "locked_time_s"):
        largest = max((wheelset[name] for wheelset in result.wheelsets), default=None)
        cells.append(_cell(WHEELSET_COLUMNS[name], largest))
    why = "" if passes else prose("; ".join(content.explanation(result)))
    recorded = " (recorded stop)" if content.subject(result.id).recorded else ""
    outcome = f"{result.outcome}{recorded}"
    changed = prose("; ".join(changes_of(result)))
    row_cells = [word if passes else f"**{word}**", code(result.id), outcome, *cells, changed, why]
    if repeated:
        row_cells.insert(_PLACE_OF_STOPS, prose(stops_text(result)))
    return row(row_cells)


def _cell(column: Column, value: float | None) -> str:
    digits = 0 if column.overview is None else column.overview.digits
    return number_cell(None, "") if value is None or math.isnan(value) else column.text(value, digits)


def _files(content: RunContent) -> dict[str, bytes]:
    return {"summary.md": markdown_summary(content).encode()}


FORMAT = ReportFormat(_files)
