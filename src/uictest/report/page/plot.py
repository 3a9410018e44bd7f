"""Drawings as SVG: a frame with ticks, and in it shapes, each of them one path."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from uictest.report.page.axis import Tick

X_PIXELS: Final = (52.0, 402.0)
"""Ends of the axis across of a plot."""
Y_PIXELS: Final = (166.0, 26.0)
"""Ends of its axis up."""
Key = Sequence[tuple[str, str]]
"""Classes of shapes and what they stand for."""
ROW_PIXELS: Final = (260.0, 880.0)
"""Ends of the axis across of a plot of rows, beside their names."""
_ROW: Final = 20.0
"""Height of a row, px; chosen."""


@dataclass(frozen=True, slots=True)
class Shape:
    """A path: its class in the style sheet, and what it says at the pointer."""

    kind: str
    path: str
    words: str = ""


@dataclass(frozen=True, slots=True)
class Label:
    """A text in a drawing."""

    x: float
    y: float
    text: str
    kind: str = "tick middle"


@dataclass(frozen=True, slots=True)
class Plot:
    """A drawing in pixels.

    Args:
        title: above the frame.
        words: what it shows, for those who do not see it.
        x_title: below the frame.
        x_ticks: upright lines with their labels.
        y_ticks: level lines with their labels, or names of rows.
        shapes: in the frame, in the order in which they are painted.
        labels: in or beside the frame.
        across: ends of the frame in pixels.
        up: its lower and its upper end.

    """

    title: str
    words: str
    x_title: str
    x_ticks: Sequence[Tick]
    y_ticks: Sequence[Tick]
    shapes: Sequence[Shape]
    labels: Sequence[Label] = ()
    across: tuple[float, float] = X_PIXELS
    up: tuple[float, float] = Y_PIXELS


def line(points: Iterable[tuple[float, float]]) -> str:
    """Return the path through points in pixels, with a gap where one is NaN."""
    path, drawing = "", False
    for x, y in points:
        known = x == x and y == y
        if known:
            path += f"{'L' if drawing else 'M'}{x:.1f} {y:.1f}"
        drawing = known
    return path


def dot(x: float, y: float, radius: float = 3.0) -> str:
    """Return the path of a circle around a point."""
    half = f"a{radius:g} {radius:g} 0 1 0"
    return f"M{x - radius:.1f} {y:.1f}{half} {2 * radius:g} 0{half} {-2 * radius:g} 0z"


def row_at(place: int) -> float:
    """Return the height of a row of a plot of rows, pixels."""
    return Y_PIXELS[1] + _ROW * (place + 0.5)


def rows_plot(
    names: Sequence[str],
    shapes: Iterable[Shape],
    ticks: Sequence[Tick],
    words: str,
    x_title: str,
    labels: Sequence[Label] = (),
) -> Plot:
    """Return a plot of named rows below each other, on one axis across; see :func:`row_at`."""
    y_ticks = [(row_at(place), name) for place, name in enumerate(names)]
    up = (Y_PIXELS[1] + _ROW * len(names), Y_PIXELS[1])
    return Plot("", words, x_title, ticks, y_ticks, list(shapes), labels, across=ROW_PIXELS, up=up)
