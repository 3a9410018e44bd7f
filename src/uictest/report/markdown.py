"""The summary in Markdown, as a job's summary on GitHub shows it."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from uictest.report.escaping import printable
from uictest.report.wording import explanation, tally, verdict_word

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult
    from uictest.report.content import RunContent

LIMIT = 1_000_000
"""Bytes of a summary at most: GitHub refuses a step's summary above 1 MiB."""

_LONGEST = 300  # characters of one text in a cell
_BACKTICKS = re.compile("`+")
_ACTIVE = re.compile(r"[\\`*_{}\[\]<>#|~&@!:$^]")
_RESERVE = 300  # bytes kept for the line that says what was left out

_FIGURES = {
    "braking_distance_m": ".1f",
    "braking_time_s": ".1f",
    "mean_deceleration_mps2": ".3f",
    "initial_adhesion_g": ".4f",
}
_HEADER = (
    "| verdict | case | outcome | distance, m | time, s | mean, m/s² | initial, g | slide, % | why |\n"
    "|---|---|---|--:|--:|--:|--:|--:|---|\n"
)


def markdown_summary(content: RunContent, limit: int = LIMIT) -> str:
    """Return the summary: the tally, then one row per case, those not met first.

    What would go beyond `limit` bytes is left out, and a last line says how many cases that is.
    """
    text = f"## uictest: {tally(content.results)}\n\n"
    if not content.complete:
        text += "**Incomplete**: selected cases were not run.\n\n"
    ordered = sorted(content.results, key=lambda result: result.met)
    rows = list(_fitting(map(_row, ordered), limit - len(text.encode()) - len(_HEADER.encode()) - _RESERVE))
    text += _HEADER + "".join(rows)
    left_out = len(ordered) - len(rows)
    return text + (f"\n{left_out} more cases are in `summary.csv` and `results.json`.\n" if left_out else "")


def append_step_summary(content: RunContent) -> None:
    """Append the summary to the file that GitHub Actions names, where it does. Raises OSError."""
    place = os.environ.get("GITHUB_STEP_SUMMARY")
    if not place:
        return
    path = Path(place)
    written = path.stat().st_size if path.exists() else 0
    with path.open("a", encoding="utf-8") as file:
        file.write(markdown_summary(content, limit=max(LIMIT - written, 2_000)))


def code(text: str) -> str:
    """Return a text as a code span that shows it letter by letter, also inside a table."""
    # In a code span nothing can be escaped, but a bar ends a cell: it is spelled out like what is invisible.
    shown = _cut(printable(text)).replace("|", "\\x7c")
    longest = max(map(len, _BACKTICKS.findall(shown)), default=0)
    fence = "`" * (longest + 1)
    padding = " " if shown.startswith("`") or shown.endswith("`") else ""
    return f"{fence}{padding}{shown}{padding}{fence}" if shown else ""


def prose(text: str) -> str:
    """Return a text with every character that Markdown or HTML could act upon as an entity."""
    return _ACTIVE.sub(lambda found: f"&#{ord(found.group())};", _cut(printable(text)))


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def _row(result: CaseResult) -> str:
    word = verdict_word(result)
    slide = max((wheelset.maximum_slide for wheelset in result.wheelsets), default=None)
    figures = [_figure(getattr(result.measures, name, None), form) for name, form in _FIGURES.items()]
    figures.append(_figure(None if slide is None else 100 * slide, ".1f"))
    why = "" if result.met else prose("; ".join(explanation(result)))
    cells = (word if result.met else f"**{word}**", code(result.id), result.outcome, *figures, why)
    return f"| {' | '.join(cells)} |\n"


def _figure(value: float | None, form: str) -> str:
    return "–" if value is None or math.isnan(value) else format(value, form)  # noqa: RUF001 - a dash on paper


def _fitting(rows: Iterable[str], room: int) -> Iterator[str]:
    for row in rows:
        room -= len(row.encode())
        if room < 0:
            return
        yield row
