"""The table of verdicts on a terminal, and one line per case elsewhere."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

from uictest.core.measures import MEASURES, STOP_COLUMNS, WHEELSET_COLUMNS, Column, Overview
from uictest.judging import evaluation
from uictest.report.difference import (
    BaselineComparison,
    Difference,
    case_explanation,
    case_word,
    difference_sentences,
)
from uictest.report.escaping import printable
from uictest.report.part_wording import part_sentences, slide_speed
from uictest.report.repeat_wording import any_repeated, range_cells, repeat_sentences, share_cells, stops_text
from uictest.report.terminal.fitted_columns import TableColumn, columns_not_shown, fitted
from uictest.report.wording import (
    DIFFERS,
    Tone,
    criterion_sentences,
    definition_sentence,
    line_word,
    listed,
    number,
    reading_sources,
    real_time_sentences,
    tone,
    without_rig_that_holds,
)

if TYPE_CHECKING:
    from rich.console import JustifyMethod
    from rich.table import Table
    from rich.text import Text

    from uictest.report.content import RunContent


SHOWN_MEASURES = tuple(name for name, column in STOP_COLUMNS.items() if column.overview)

MOST_DIFFERENCES: Final = 3
"""Quantities out of the tolerance of a baseline that a case shows on a terminal; results.json has all."""


def case_line(result: evaluation.CaseResult, differences: Sequence[Difference] = ()) -> str:
    """Return the line of one case, ending with the reason if it is not met or differs from the baseline."""
    words = [line_word(case_word(result, differences)), printable(result.id)]
    words += [f"outcome={result.outcome}", f"expect={result.expect}", *_stops(result), *_measures(result)]
    if differences or not result.met:
        outcomes, *reasons = case_explanation(result, differences, MOST_DIFFERENCES)
        words.append(f"reason={'; '.join(reasons or [outcomes])}")
    return " ".join(words)


def missing_lines(baseline: BaselineComparison) -> Iterator[str]:
    """Yield one line per case of the baseline that is missing, and per series that differs from it."""
    for own_id in baseline.beside_cases:
        reason = "; ".join(difference_sentences(baseline.differences[own_id], MOST_DIFFERENCES))
        yield f"{DIFFERS} {printable(own_id)} reason={reason}"


def criterion_lines(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield one line per criterion of a case, each beginning with the case id."""
    for sentence in criterion_sentences(result):
        yield f"criterion {printable(result.id)} {sentence}"


def definition_lines(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the definitions of each criterion, once for all cases in which they are the same."""
    cases: dict[tuple[str, str], list[str]] = {}
    for result in results:
        for verdict in without_rig_that_holds(result.criteria):
            cases.setdefault((verdict.id, definition_sentence(verdict)), []).append(result.id)
            for reading, sentence in reading_sources(verdict).items():
                cases.setdefault((f"{verdict.id} read as {reading}", sentence), []).append(result.id)
    meanings = [criterion for criterion, _ in cases]
    for (criterion, sentence), names in cases.items():
        where = f" (in {listed(names)})" if meanings.count(criterion) > 1 else ""
        if sentence:
            yield f"definition {printable(criterion)}{where}: {sentence}"


def part_lines(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the parts that cases were run with and their changes, once for all cases with the same part."""
    cases: dict[tuple[str, str], list[str]] = {}
    for result in results:
        for role, sentence in part_sentences(result.parts, result.controller_version).items():
            cases.setdefault((role, sentence), []).append(result.id)
    for (role, sentence), names in cases.items():
        where = "" if len(names) == len(results) else f" (in {listed(names)})"
        yield f"part {role}{where}: {sentence}"


def _stops(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield how many stops of a repeated case passed, and the range of what `_measures` gives medians of."""
    for name, value in share_cells(result).items():
        yield f"{name}={value:.4g}"
    for name, value in range_cells(result, SHOWN_MEASURES[:1]).items():
        yield f"{name}={value:.5g}"


def _measures(result: evaluation.CaseResult) -> Iterator[str]:
    for name in SHOWN_MEASURES:
        if result.measures is not None:
            yield f"{name}={number(result.measures[name])}"
    if result.wheelsets:
        yield f"slide_above={slide_speed([result]).replace(' ', '')}"
        yield "maximum_slide=" + "/".join(number(wheelset["maximum_slide"]) for wheelset in result.wheelsets)
        vents = (number(wheelset["valve_actuations"]) for wheelset in result.wheelsets)
        yield "valve_actuations=" + "/".join(vents)
    if (times := result.response_times) is not None:
        yield f"missed_deadlines={times.missed_deadlines}"
        yield f"longest_answer_s={number(times.longest_answer_s)}"
        yield f"start_jitter_s={number(times.start_jitter_s)}"


_STYLES: Final[dict[Tone, str]] = {"good": "green", "bad": "bold red", "odd": "bold magenta"}
_FAILING: Final = 1
"""Rank of a column that a missed criterion rests on: it is left out last."""

ALL_COLUMNS = "summary.csv and wheelsets.csv have all measures"


def verdict_table(
    results: Sequence[evaluation.CaseResult], word: Callable[[evaluation.CaseResult], str], width: int
) -> tuple[Table, str]:
    """Return the table of all cases in so many characters, and a line that names the columns left out.

    `word` gives the word of each case. User text enters as text, never as markup.
    """
    from rich.table import Table
    from rich.text import Text

    columns, hidden = fitted(_columns(results, word), width)
    table = Table(box=None, pad_edge=False, header_style="bold")
    for column in columns:
        justify: JustifyMethod = "right" if column.right else "left"
        table.add_column(column.title, justify=justify, no_wrap=not column.wraps, overflow="fold")
    styles = [_STYLES[tone(word(result))] for result in results]
    for style, row in zip(styles, zip(*(column.cells for column in columns), strict=True), strict=True):
        texts = zip(columns, row, strict=True)
        table.add_row(
            *(Text(cell, style=style if column.title == "verdict" else "") for column, cell in texts)
        )
    return table, columns_not_shown(hidden, ALL_COLUMNS)


def _columns(
    results: Sequence[evaluation.CaseResult], word: Callable[[evaluation.CaseResult], str]
) -> list[TableColumn]:
    columns = [
        TableColumn("case", [printable(result.id) for result in results], wraps=True),
        TableColumn("verdict", list(map(word, results))),
        TableColumn("outcome", [result.outcome for result in results], rank=2),
    ]
    if any_repeated(results):
        columns.insert(2, TableColumn("stops", [stops_text(result) or "-" for result in results]))
    missed, speed = _missed_criteria(results), slide_speed(results)
    for column in (*STOP_COLUMNS.values(), *WHEELSET_COLUMNS.values()):
        if column.overview is not None:
            rank = _FAILING if column.name in missed.values() else column.overview.rank
            columns.append(_measure_column(results, column, column.overview, speed, rank))
    names = {name for name, column in (STOP_COLUMNS | WHEELSET_COLUMNS).items() if column.overview}
    others = [criterion for criterion, column in missed.items() if column not in names]
    columns.extend(_criterion_column(results, criterion) for criterion in others)
    return columns


def _measure_column(
    results: Iterable[evaluation.CaseResult], column: Column, overview: Overview, speed: str, rank: int
) -> TableColumn:
    values = [_value(result, column.name) for result in results]
    cells = [
        "-" if value is None or math.isnan(value) else column.text(value, overview.few_digits)
        for value in values
    ]
    return TableColumn(overview.heading.format(speed), cells, rank, right=True)


def _missed_criteria(results: Iterable[evaluation.CaseResult]) -> dict[str, str]:
    """Return the criteria by which cases are not as expected, and the column that each rests on, or ""."""
    verdicts = (
        verdict
        for result in results
        if not result.met
        for verdict in result.criteria
        if verdict.status in ("fail", "inconclusive")
    )
    measures = {verdict.id: MEASURES.get(verdict.measure) for verdict in verdicts}
    return {
        criterion: measure.column.name if measure is not None and measure.column is not None else ""
        for criterion, measure in measures.items()
    }


def _criterion_column(results: Iterable[evaluation.CaseResult], criterion: str) -> TableColumn:
    """Return the values of a criterion whose measure the table does not have."""
    verdicts = [next((v for v in result.criteria if v.id == criterion), None) for result in results]
    unit = next((verdict.unit for verdict in verdicts if verdict is not None), "").removeprefix("1")
    values = [None if verdict is None else verdict.value for verdict in verdicts]
    cells = ["-" if value is None or math.isnan(value) else f"{value:.4g}" for value in values]
    return TableColumn(f"{printable(criterion)}\n{unit}", cells, _FAILING, right=True)


def _value(result: evaluation.CaseResult, measure: str) -> float | None:
    """Return a measure of a stop, or the largest of its wheelsets; None where there is none."""
    if measure in STOP_COLUMNS:
        return (result.measures or {}).get(measure)
    return max((wheelset[measure] for wheelset in result.wheelsets), default=None)


def explanation_text(
    content: RunContent, result: evaluation.CaseResult, *, every_criterion: bool = False
) -> Text:
    """Return the reasons for the outcome of a case, or all its verdicts, as lines below its id."""
    from rich.text import Text

    word = content.word(result)
    text = Text(f"{word} ", style=_STYLES[tone(word)])
    text.append(printable(result.id), style="bold")
    lines = content.explanation(result, MOST_DIFFERENCES)
    if every_criterion:
        differences = difference_sentences(content.differences(result.id))
        lines = [
            *repeat_sentences(result),
            *criterion_sentences(result),
            *real_time_sentences(result),
            *differences,
        ]
    for line in lines:
        text.append(f"\n  {line}", style="not bold default")
    return text
