"""The table of verdicts on a terminal."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from uictest.report.baseline import difference_sentences
from uictest.report.escaping import printable
from uictest.report.wording import DIFFERS, criterion_sentences

if TYPE_CHECKING:
    from rich.table import Table
    from rich.text import Text

    from uictest.evaluation import CaseResult
    from uictest.report.content import RunContent

_STYLES = {"met": "green", "MISSED": "bold red", "ERROR": "bold magenta", DIFFERS: "bold red"}
_MEASURES = {
    "distance\nm": ("braking_distance_m", ".1f"),
    "time\ns": ("braking_time_s", ".1f"),
    "mean\nm/s2": ("mean_deceleration_mps2", ".2f"),
    "adhesion\ng": ("initial_adhesion_g", ".3f"),
}


def verdict_table(results: Sequence[CaseResult], word: Callable[[CaseResult], str]) -> Table:
    """Return the table of all cases, one row each, with the word of each.

    User text enters as text, never as markup.
    """
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("case", overflow="fold")
    for heading in ("verdict", "outcome"):
        table.add_column(heading, no_wrap=True)
    for heading in (*_MEASURES, "slide\nmax %", "vents\nmax"):
        table.add_column(heading, justify="right", no_wrap=True)
    for result in results:
        table.add_row(*_row(result, word(result)))
    return table


def explanation_text(content: RunContent, result: CaseResult, *, every_criterion: bool = False) -> Text:
    """Return why a case came out as it did, or what every criterion found, as lines below its id."""
    from rich.text import Text

    word = content.word(result)
    text = Text(f"{word} ", style=_STYLES[word])
    text.append(printable(result.id), style="bold")
    lines = content.explanation(result)
    if every_criterion:
        lines = [*criterion_sentences(result), *difference_sentences(content.differences(result.id))]
    for line in lines:
        text.append(f"\n  {line}", style="not bold default")
    return text


def _row(result: CaseResult, word: str) -> list[Text]:
    from rich.text import Text

    slide = max((wheelset.maximum_slide for wheelset in result.wheelsets), default=None)
    actuations = max((wheelset.valve_actuations for wheelset in result.wheelsets), default=None)
    return [
        Text(printable(result.id)),
        Text(word, style=_STYLES[word]),
        Text(result.outcome),
        *(Text(_figure(getattr(result.measures, name, None), form)) for name, form in _MEASURES.values()),
        Text(_figure(slide and 100.0 * slide, ".0f")),
        Text(_figure(actuations, "d")),
    ]


def _figure(value: float | None, form: str) -> str:
    return "-" if value is None or math.isnan(value) else format(value, form)
