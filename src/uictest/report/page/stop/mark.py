"""Marks that a plot shows besides its lines, and where their labels stand."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from uictest.judging import evaluation
from uictest.report.escaping import printable
from uictest.report.page.axis import Axis
from uictest.report.traces.quantities import VENT, WHEELSETS, Lane, Strip
from uictest.report.traces.trace import PlotTrace, States
from uictest.report.verdict_sentences import quantity

Kind = Literal["limit", "mean", "window", "band", "tolerance", "instant", "point", "interval"]


@dataclass(frozen=True, slots=True)
class Mark:
    """A mark in a plot, in the units of the plot.

    limit, mean: a level line at `y` from `x0` to `x1`. window, band: everything between `x0` and `x1`. None
    where it has no end. tolerance: everything from -`y` to `y`. instant: an upright line at `x0`. point: the
    place `x0`, `y`. interval: from `x0` to `x1` in row `y` of a strip. `wheelset` is None for a mark of all
    of them, or of the train.
    """

    plot: str
    kind: Kind
    label: str
    x0: float | None = None
    x1: float | None = None
    y: float | None = None
    wheelset: int | None = None
    criterion: str = ""
    status: evaluation.Status = "pass"


def limit_marks(
    verdict: evaluation.Verdict,
    plot: str,
    *,
    x0: float | None = None,
    x1: float | None = None,
    scale: float = 1.0,
) -> Iterator[Mark]:
    """Yield the bounds of a criterion as level lines; a plot's unit is `scale` of the criterion's."""
    for bound in (verdict.lower, verdict.upper):
        if bound is not None and math.isfinite(bound):
            yield Mark(plot, "limit", f"limit {quantity(bound, verdict.unit)}", x0, x1, bound / scale)


def misses(verdict: evaluation.Verdict, value: float) -> bool:
    """Return whether a value, in the unit of the criterion, misses its bounds.

    A criterion that fails with a margin of 0 is one whose bounds themselves do not pass.
    """
    strict = verdict.status == "fail" and verdict.margin == 0.0
    margins = [
        *([] if verdict.lower is None else [value - verdict.lower]),
        *([] if verdict.upper is None else [verdict.upper - value]),
    ]
    return any(margin < 0.0 or (strict and margin == 0.0) for margin in margins)


def instant(plot: str, time: float, label: str) -> Mark:
    """Return an upright line."""
    return Mark(plot, "instant", printable(label), time, time)


def point(plot: str, x: float, y: float, label: str, wheelset: int | None = None) -> Mark:
    """Return a marked place."""
    return Mark(plot, "point", printable(label), x, x, y, wheelset)


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
        right = left + _width(text)
        row = next(
            (k for k, own in enumerate(rows) if all(right <= a or left >= b for a, b in own)), len(rows)
        )
        if row == len(rows):
            rows.append([])
        rows[row].append((left, right))
        labels.append(Label(text, left, row, mark.status))
    return Labels(labels, len(rows))


def _width(text: str) -> float:
    return _CHARACTER * len(text) + 8.0


Bar = tuple[float, float, float]
"""Beginning and end (s), and row: the number of the wheelset, or that of a lane beside it."""

_HALF_HEIGHTS = {"magnet": 0.17, "interval": 0.46}
"""Of a bar, where a row is 1 high: an interval that is marked shows above and below the magnets in it."""
_LEAST_WIDTH = 1.0
"""Pixels: a state that is drawn is never narrower."""


def magnet_bars(trace: PlotTrace, lanes: Sequence[Lane]) -> dict[str, list[Bar]]:
    """Return the bars of the magnets by kind; no kind has none."""
    bars = {
        f"magnet {lane.label} role-wheelset-{n}": _bars(states, lane.states, n + lane.offset, trace.end)
        for n in WHEELSETS
        if (states := trace.states.get(f"valve_command_{n}")) is not None
        for lane in lanes
    }
    return {kind: own for kind, own in bars.items() if own}


def vents(trace: PlotTrace, n: int) -> list[Bar]:
    """Return the vents of a wheelset; none where its valve was not recorded."""
    states = trace.states.get(f"valve_command_{n}")
    return [] if states is None else _bars(states, (VENT,), n, trace.end)


def mark_bars(marks: Iterable[Mark], strip: Strip) -> dict[str, list[Bar]]:
    """Return the intervals that are marked in a strip, by the kind of their bars; lanes lie above them."""
    kind = "interval behind" if strip.lanes else "interval"
    bars: dict[str, list[Bar]] = {}
    for mark in marks:
        if mark.plot == strip.key and mark.x0 is not None and mark.x1 is not None and mark.y is not None:
            bars.setdefault(f"{kind} mark-{mark.status}", []).append((mark.x0, mark.x1, mark.y))
    return bars


def bars_path(kind: str, bars: Iterable[Bar], x: Axis, y: Axis) -> str:
    """Return SVG path data of bars."""
    half = _HALF_HEIGHTS[kind.partition(" ")[0]]
    return "".join(
        _rectangle(x.at(first), x.at(last), y.at(row - half), y.at(row + half)) for first, last, row in bars
    )


def _bars(states: States, wanted: Sequence[int], row: float, end: float) -> list[Bar]:
    """Return the intervals in which a valve is in one of some states; those that follow at once are one."""
    times = np.append(states.time, end)
    ends = np.flatnonzero(np.diff(np.isin(states.state, wanted), prepend=False, append=False))
    return [(float(times[a]), float(times[b]), row) for a, b in ends.reshape(-1, 2).tolist()]


def _rectangle(first: float, last: float, upper: float, lower: float) -> str:
    width = f"{max(last - first, _LEAST_WIDTH):.4g}"
    return f"M{first:.1f} {upper:.1f}h{width}v{lower - upper:.1f}h-{width}z"
