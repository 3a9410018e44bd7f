"""The table of verdicts on a terminal."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

from uictest import evaluation
from uictest.report.baseline import difference_sentences
from uictest.report.escaping import printable
from uictest.report.repeat_wording import any_repeated, repeat_sentences, stops_text
from uictest.report.terminal.fitted_columns import TableColumn, columns_not_shown, fitted
from uictest.report.wording import Tone, criterion_sentences, real_time_sentences, tone

if TYPE_CHECKING:
    from rich.console import JustifyMethod
    from rich.table import Table
    from rich.text import Text

    from uictest.report.content import RunContent

_STYLES: Final[dict[Tone, str]] = {"good": "green", "bad": "bold red", "odd": "bold magenta"}
_MEASURES = {
    "distance\nm": ("braking_distance_m", ".1f", 2),
    "time\ns": ("braking_time_s", ".1f", 5),
    "mean\nm/s2": ("mean_deceleration_mps2", ".2f", 4),
    "adhesion\ng": ("initial_adhesion_g", ".3f", 6),
}
"""Heading -> measure, its format, and the rank in which it is left out on a narrow terminal."""

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
        TableColumn("outcome", [result.outcome for result in results], rank=1),
    ]
    if any_repeated(results):
        columns.insert(2, TableColumn("stops", [stops_text(result) or "-" for result in results]))
    for title, (name, form, rank) in _MEASURES.items():
        cells = [_cell((result.measures or {}).get(name), form) for result in results]
        columns.append(TableColumn(title, cells, rank, right=True))
    slides = [_largest(result, "maximum_slide") for result in results]
    vents = [_largest(result, "valve_actuations") for result in results]
    sliding = [_largest(result, "sliding_time_s") for result in results]
    locked = [_largest(result, "locked_time_s") for result in results]
    columns.append(
        TableColumn("slide\nmax %", [_cell(s and 100.0 * s, ".0f") for s in slides], 3, right=True)
    )
    columns.append(TableColumn("sliding\nmax s", [_cell(each, ".1f") for each in sliding], 9, right=True))
    columns.append(TableColumn("locked\nmax s", [_cell(each, ".1f") for each in locked], 8, right=True))
    columns.append(TableColumn("vents\nmax", [_cell(each, "g") for each in vents], 7, right=True))
    return columns


def _largest(result: evaluation.CaseResult, measure: str) -> float | None:
    return max((wheelset[measure] for wheelset in result.wheelsets), default=None)


def explanation_text(
    content: RunContent, result: evaluation.CaseResult, *, every_criterion: bool = False
) -> Text:
    """Return the reasons for the outcome of a case, or all its verdicts, as lines below its id."""
    from rich.text import Text

    word = content.word(result)
    text = Text(f"{word} ", style=_STYLES[tone(word)])
    text.append(printable(result.id), style="bold")
    lines = content.explanation(result)
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


def _cell(value: float | None, form: str) -> str:
    return "-" if value is None or math.isnan(value) else format(value, form)
