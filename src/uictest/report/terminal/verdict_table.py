"""The table of verdicts on a terminal."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Final

from uictest.core.measures import MEASURES, STOP_COLUMNS
from uictest.judging import evaluation
from uictest.report.baseline import difference_sentences
from uictest.report.escaping import printable
from uictest.report.part_wording import slide_speed
from uictest.report.repeat_wording import any_repeated, repeat_sentences, stops_text
from uictest.report.terminal.case_lines import MOST_DIFFERENCES
from uictest.report.terminal.fitted_columns import TableColumn, columns_not_shown, fitted
from uictest.report.wording import Tone, criterion_sentences, real_time_sentences, tone

if TYPE_CHECKING:
    from rich.console import JustifyMethod
    from rich.table import Table
    from rich.text import Text

    from uictest.report.content import RunContent

_STYLES: Final[dict[Tone, str]] = {"good": "green", "bad": "bold red", "odd": "bold magenta"}
_Column = tuple[str, str, str, int, float]
_STOP_MEASURES: Final[tuple[_Column, ...]] = (
    ("distance\nm", "braking_distance_m", ".1f", 3, 1.0),
    ("time\ns", "braking_time_s", ".1f", 6, 1.0),
    ("mean\nm/s2", "mean_deceleration_mps2", ".2f", 5, 1.0),
    ("adhesion\ng", "initial_adhesion_g", ".3f", 7, 1.0),
)
_WHEELSET_MEASURES: Final[tuple[_Column, ...]] = (
    ("max slide %\n> {}", "maximum_slide", ".0f", 4, 100.0),
    ("sliding\nmax s", "sliding_time_s", ".1f", 10, 1.0),
    ("locked\nmax s", "locked_time_s", ".1f", 9, 1.0),
    ("vents\nmax", "valve_actuations", "g", 8, 1.0),
)
"""Heading, measure, its format, the rank in which it is left out on a narrow terminal, and its scale."""

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
    for title, name, form, rank, scale in (*_STOP_MEASURES, *_WHEELSET_MEASURES):
        cells = [_cell(_value(result, name), form, scale) for result in results]
        own_rank = _FAILING if name in missed.values() else rank
        columns.append(TableColumn(title.format(speed), cells, own_rank, right=True))
    shown = {name for _, name, *_ in (*_STOP_MEASURES, *_WHEELSET_MEASURES)}
    others = [criterion for criterion, column in missed.items() if column not in shown]
    columns.extend(_criterion_column(results, criterion) for criterion in others)
    return columns


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
    cells = [_cell(None if verdict is None else verdict.value, ".4g", 1.0) for verdict in verdicts]
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


def _cell(value: float | None, form: str, scale: float) -> str:
    return "-" if value is None or math.isnan(value) else format(scale * value, form)
