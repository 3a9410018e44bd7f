"""The history of a case as a small drawing: a mark per run, and below it the line of distances."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, Literal

from uictest import report
from uictest.runs.history.case_history import CaseHistory

_NARROWEST, _WIDEST, _WIDTH = 9, 16, 360
"""Of a run, and of all runs as far as they fit, pixels."""
_MARKS: Final = 6.0
_TOP, _BOTTOM = 17.0, 35.0
HEIGHT: Final = 39
_LEAST_RANGE: Final = 0.01
"""Range that fills the height, over the distance, at least: a smaller one would look like a large change."""

Shape = Literal["good", "skipped", "bad", "odd"]
"""A disc, a ring, a cross, a triangle: told apart without colours."""

_SHAPES: Final[dict[Shape, str]] = {
    "good": "m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0",
    "skipped": "m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0",
    "bad": "m-3-3l6 6m0-6l-6 6",
    "odd": "m0-3.6l3.8 6.8h-7.6z",
}


@dataclass(frozen=True, slots=True)
class Strip:
    """What is drawn of a case, in pixels.

    Args:
        marks: path of the marks by their shape.
        line: path through the distances; empty where less than two runs have one.
        changes: path of the ticks where inputs changed.
        newest: place of the newest distance; None without one.

    """

    marks: dict[Shape, str]
    line: str
    changes: str
    newest: tuple[float, float] | None


def strip(history: CaseHistory) -> Strip:
    """Return the drawing of a case."""
    points = _points(history)
    changed = [place for place, names in history.changes().items() if names]
    return Strip(
        _marks(history),
        "".join(f"{'L' if n else 'M'}{x:g} {y:g}" for n, (x, y) in enumerate(points)) if points[1:] else "",
        "".join(f"M{place * slot_width(len(history.runs))} 13V{HEIGHT}" for place in changed),
        points[-1] if points else None,
    )


def width(runs: int) -> int:
    """Return the width of a drawing with so many runs, pixels."""
    return slot_width(runs) * runs


def slot_width(runs: int) -> int:
    """Return the width of one of so many runs, pixels."""
    return min(max(_WIDTH // runs, _NARROWEST), _WIDEST) if runs else _WIDEST


def shape(word: str) -> Shape:
    """Return the shape of a word of `report.CASE_WORDS`."""
    return "skipped" if word == "skipped" else report.tone(word)


def summary(history: CaseHistory) -> str:
    """Return what the drawing shows, in words."""
    words = [history.entry(place).word for place in history.places]
    turns = sum(before != now for before, now in pairwise(words))
    counts = ", ".join(f"{words.count(word)} {word}" for word in report.CASE_WORDS if word in words)
    turned = f"; the verdict turned {report.counted(turns, 'time')}" if turns else ""
    return f"{report.counted(len(words), 'run')}: {counts}{turned}{_range_words(history)}"


def distances(history: CaseHistory) -> list[tuple[int, float]]:
    """Return the place of every run that has a distance, and the distance, m."""
    entries = ((place, history.entry(place).distance) for place in history.places)
    return [(place, distance) for place, distance in entries if distance is not None]


def _middle(history: CaseHistory, place: int) -> float:
    return slot_width(len(history.runs)) * (place + 0.5)


def _range_words(history: CaseHistory) -> str:
    values = [distance for _, distance in distances(history)]
    return f"; distance {min(values):.1f} .. {max(values):.1f} m" if values else ""


def _marks(history: CaseHistory) -> dict[Shape, str]:
    paths: dict[Shape, str] = {}
    for place in history.places:
        kind = shape(history.entry(place).word)
        paths[kind] = f"{paths.get(kind, '')}M{_middle(history, place):g} {_MARKS:g}{_SHAPES[kind]}"
    return paths


def _points(history: CaseHistory) -> list[tuple[float, float]]:
    """Return the distances in pixels: their range fills the height, if it is not too small."""
    found = distances(history)
    values: Sequence[float] = [distance for _, distance in found]
    low, high = (min(values), max(values)) if values else (0.0, 0.0)
    span = max(high - low, _LEAST_RANGE * abs(high)) or 1.0
    lowest = (low + high - span) / 2.0
    shares = [(value - lowest) / span for value in values]
    return [
        (_middle(history, place), round(_BOTTOM - (_BOTTOM - _TOP) * share, 1))
        for (place, _), share in zip(found, shares, strict=True)
    ]
