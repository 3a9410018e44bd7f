"""How a figure is distributed, as bars stacked by outcome."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from uictest.report.page.axis import Axis, Tick

_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 402, 26, 150
_GAP = 1.0
_STACKED = ("pass", "fail", "invalid", "inconclusive", "skipped", "error")
"""Outcomes from the axis upwards."""


@dataclass(frozen=True, slots=True)
class Bar:
    """The cases of one outcome in one bin, in pixels; `label` says what it holds."""

    outcome: str
    x: float
    y: float
    width: float
    height: float
    label: str


@dataclass(frozen=True, slots=True)
class Histogram:
    """A distribution, drawn. `ends` has its smallest value, mean and largest value as text."""

    title: str
    unit: str
    cases: int
    ends: tuple[str, str, str]
    outcomes: Sequence[str]
    bars: Sequence[Bar]
    x_ticks: Sequence[Tick]
    y_ticks: Sequence[Tick]
    left: int = _LEFT
    right: int = _RIGHT
    top: int = _TOP
    bottom: int = _BOTTOM


def histogram(found: Mapping[str, Any]) -> Histogram:
    """Return a distribution of `sweep.json` as bars."""
    edges, counts = found["edges"], found["counts"]
    tallest = max(map(sum, zip(*counts.values(), strict=True)))
    x, y = Axis(edges[0], edges[-1], _LEFT, _RIGHT), Axis(0.0, tallest, _BOTTOM, _TOP)
    smallest, mean, largest = (f"{found[end]:.4g}" for end in ("minimum", "mean", "maximum"))
    return Histogram(
        found["measure"],
        "" if found["unit"] == "1" else found["unit"],
        found["cases"],
        (smallest, mean, largest),
        [outcome for outcome in _STACKED if outcome in counts],
        list(_bars(edges, counts, x, y)),
        x.tick_marks(6),
        [(y.at(value), label) for value, label in y.ticks(4) if value == round(value)],
    )


def _bars(edges: Sequence[float], counts: Mapping[str, Sequence[int]], x: Axis, y: Axis) -> Iterator[Bar]:
    for place, (low, high) in enumerate(pairwise(edges)):
        below = 0
        for outcome in _STACKED:
            count = counts[outcome][place] if outcome in counts else 0
            if count:
                top, bottom = y.at(below + count), y.at(below)
                width = max(x.at(high) - x.at(low) - _GAP, 0.5)
                label = f"{low:.4g} to {high:.4g}: {count} {outcome}"
                yield Bar(outcome, x.at(low) + _GAP / 2, top, width, bottom - top, label)
                below += count
