"""Where the verdict flips, drawn over the first of the other parameters."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uictest.report.page.axis import Axis, Tick, span
from uictest.report.page.sweep.labels import number_in, unit_in, with_unit
from uictest.report.sweep.wording import circumstances_words, flip_words

_LEFT, _RIGHT, _TOP, _BOTTOM = 62, 600, 24, 252
_SIDES = ((_LEFT, _RIGHT), (_BOTTOM, _TOP))
_MOST_SERIES = 6
Point = tuple[float, float, str]
"""Where a flip is drawn, and what it says."""


@dataclass(frozen=True, slots=True)
class Series:
    """Flips at one combination of the parameters that are not on the axes.

    `path` has lines through flips of the same direction, with gaps where a value has none, as SVG writes it.
    """

    name: str
    points: Sequence[Point]
    path: str


@dataclass(frozen=True, slots=True)
class _Flip:
    """A flip on both axes, the series that it belongs to, its direction, and what it says."""

    at: float
    middle: float
    series: str
    met_at_low: bool
    words: str


@dataclass(frozen=True, slots=True)
class FrontierPlot:
    """The frontier in pixels; `left_out` counts the series that there was no room for."""

    x_title: str
    y_title: str
    series: Sequence[Series]
    x_ticks: Sequence[Tick]
    y_ticks: Sequence[Tick]
    left_out: int
    left: int = _LEFT
    right: int = _RIGHT
    top: int = _TOP
    bottom: int = _BOTTOM


def frontier_rows(found: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Return the lines of a table: at which values, where the verdict flips, and what to note."""
    return [
        (circumstances_words(each["circumstances"]), "; ".join(map(flip_words, each["flips"])), each["note"])
        for each in found["stretches"]
    ]


def frontier_plot(found: Mapping[str, Any]) -> FrontierPlot | None:
    """Return the frontier drawn, or None where it depends on no other number."""
    key = _numeric_key(found["stretches"])
    if key is None:
        return None
    flips = list(_flips(found["stretches"], key))
    if not flips:
        return None
    scanned = sorted({_place(each, key) for each in found["stretches"]})
    x = Axis(*span([np.array(scanned)], ()), *_SIDES[0])
    y = Axis(*span([np.array([flip.middle for flip in flips])], ()), *_SIDES[1])
    names = list(dict.fromkeys(flip.series for flip in flips))
    series = [
        _series(name, [flip for flip in flips if flip.series == name], scanned, x, y)
        for name in names[:_MOST_SERIES]
    ]
    return FrontierPlot(
        _title(key, (each["circumstances"][key] for each in found["stretches"])),
        _title(found["parameter"], (flip["low"] for each in found["stretches"] for flip in each["flips"])),
        series,
        x.tick_marks(8),
        y.tick_marks(6),
        len(names) - len(series),
    )


def _flips(stretches: Sequence[Mapping[str, Any]], key: str) -> Iterator[_Flip]:
    for each in stretches:
        others = _others(each["circumstances"], key)
        for flip in each["flips"]:
            middle = _middle(flip)
            if middle is not None:
                yield _Flip(_place(each, key), middle, others, flip["met_at_low"], flip_words(flip))


def _place(stretch: Mapping[str, Any], key: str) -> float:
    place = number_in(stretch["circumstances"][key])
    assert place is not None  # a numeric key has numbers only
    return place


def _series(name: str, flips: Sequence[_Flip], scanned: Sequence[float], x: Axis, y: Axis) -> Series:
    points = sorted((x.at(flip.at), y.at(flip.middle), f"{flip.at:g}: {flip.words}") for flip in flips)
    strokes = [
        stroke
        for direction in (False, True)
        for stroke in _strokes([flip for flip in flips if flip.met_at_low == direction], scanned)
    ]
    lines = ("L".join(f"{x.at(flip.at):.1f} {y.at(flip.middle):.1f}" for flip in each) for each in strokes)
    return Series(name, points, "".join(f"M{line}" for line in lines))


def _strokes(flips: Sequence[_Flip], scanned: Sequence[float]) -> Iterator[list[_Flip]]:
    """Yield flips at neighbouring scanned values together."""
    stroke: list[_Flip] = []
    for at in scanned:
        here = [flip for flip in flips if flip.at == at]
        if stroke and not here:
            yield stroke
            stroke = []
        stroke.extend(here)
    if stroke:
        yield stroke


def _title(key: str, texts: Iterable[str]) -> str:
    return with_unit(key, next(map(unit_in, texts), ""))


def _numeric_key(stretches: Sequence[Mapping[str, Any]]) -> str | None:
    keys = stretches[0]["circumstances"] if stretches else {}
    for key in keys:
        numbers = {number_in(each["circumstances"][key]) for each in stretches}
        if None not in numbers and len(numbers) > 1:
            return str(key)
    return None


def _others(circumstances: Mapping[str, str], key: str) -> str:
    rest = {name: text for name, text in circumstances.items() if name != key}
    return circumstances_words(rest) if rest else "the verdict flips here"


def _middle(flip: Mapping[str, str]) -> float | None:
    low, high = number_in(flip["low"]), number_in(flip["high"])
    return None if low is None or high is None else 0.5 * (low + high)
