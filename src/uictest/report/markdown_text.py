"""Texts and figures as a cell of a Markdown table can hold them."""

from __future__ import annotations

import math
import re

from uictest.report.escaping import printable

_LONGEST = 300  # characters of one text in a cell
_BACKTICKS = re.compile("`+")
_ACTIVE = re.compile(r"[\\`*_{}\[\]<>#|~&@!:$^]")


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


def figure(value: float | None, form: str) -> str:
    """Return a figure in a format, a dash where there is none."""
    return "–" if value is None or math.isnan(value) else format(value, form)  # noqa: RUF001 - a dash on paper


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
