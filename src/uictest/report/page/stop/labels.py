"""Labels of marks in rows above a plot, next to its title: where no data lie, and none over another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from uictest.report.page.axis import Axis
from uictest.report.page.stop.mark import Mark

ROW = 13.0
"""Pixels: the height of a row of labels."""

_CHARACTER = 6.2
"""Pixels of a letter, about: labels keep apart even in a wide font."""
_SAMPLES = {"limit": "┄ ", "mean": "━ ", "tolerance": "▬ "}
"""What a level line or a band looks like."""


@dataclass(frozen=True, slots=True)
class Label:
    """A text that begins at `x` pixels in a row; row 0 is that of the title, row 1 lies below it."""

    text: str
    x: float
    row: int
    status: str


@dataclass(frozen=True, slots=True)
class Labels:
    """The labels of a plot, and how many rows they and the title fill."""

    labels: Sequence[Label]
    rows: int


def labels_of(title: str, marks: Sequence[Mark], x: Axis) -> Labels:
    """Return the labels of marks, each as near to its mark as the others leave room.

    Args:
        title: what stands at the beginning of the first row.
        marks: of the plot, in the order of their importance.
        x: the axis across.

    """
    rows = [[(x.start, x.start + _width(title) * 1.1)]]
    labels = []
    for mark in marks:
        if not mark.label:
            continue
        text = f"{_SAMPLES.get(mark.kind, '')}{mark.label}"
        place = next((end for end in (mark.x0, mark.x1) if end is not None), None)
        left = max(x.start, min(x.end if place is None else x.at(place), x.end - _width(text)))
        taken = (left, left + _width(text))
        row = next((k for k, own in enumerate(rows) if _free(own, taken)), len(rows))
        if row == len(rows):
            rows.append([])
        rows[row].append(taken)
        labels.append(Label(text, left, row, mark.status))
    return Labels(labels, len(rows))


def _width(text: str) -> float:
    return _CHARACTER * len(text) + 8.0


def _free(row: Sequence[tuple[float, float]], wanted: tuple[float, float]) -> bool:
    return all(wanted[1] <= left or wanted[0] >= right for left, right in row)
