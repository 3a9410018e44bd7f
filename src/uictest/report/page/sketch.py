"""The plots of one stop as plain drawings: what paper, and a browser without JavaScript, show."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from uictest.report.page.axis import Axis, Tick, span
from uictest.report.page.marks import Mark
from uictest.report.page.polyline import dots, path, path_over_time
from uictest.report.page.quantities import (
    LOOPS,
    PANELS,
    QUANTITIES,
    WHEELSETS,
    Line,
    Loop,
    Panel,
    lines_of,
    panel_lines,
)
from uictest.report.page.trace import Trace

WIDTH, LEFT, RIGHT = 960, 52, 948
_HEIGHT, _TITLE, _GAP = 96, 22, 6  # of a panel of height 1, of its title, below it
_BELOW = 32  # the panels: tick labels and what they count
_BAND = 15
_LOOP_WIDTH, _LOOP_HEIGHT = 316, 230
_STATES = {1: "hold", 2: "vent"}  # fill, the state of every valve without WSP action, is left blank


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A shaded part of a drawing, pixels."""

    x: float
    y: float
    width: float
    height: float
    kind: str
    label: str = ""


@dataclass(frozen=True, slots=True)
class Level:
    """A level line of a mark, pixels."""

    x1: float
    x2: float
    y: float
    kind: str
    label: str


@dataclass(frozen=True, slots=True)
class Drawing:
    """One plot ready to be written as SVG: every coordinate in pixels."""

    key: str
    title: str
    left: float
    right: float
    top: float
    bottom: float
    x_ticks: Sequence[Tick] = ()
    y_ticks: Sequence[Tick] = ()
    x_title: str = ""
    y_title: str = ""
    paths: Sequence[tuple[Line, str]] = ()
    shaded: Sequence[Rectangle] = ()
    levels: Sequence[Level] = ()


@dataclass(frozen=True, slots=True)
class Sketch:
    """All plots of one stop: panels above each other over one time axis, and the loops."""

    height: float
    panels: list[Drawing] = field(default_factory=list)
    loops: list[Drawing] = field(default_factory=list)


def sketch_of(trace: Trace, marks: Sequence[Mark]) -> Sketch:
    """Return the drawings of a stop; quantities that it has no series of are left out."""
    over_time = panels_over_time(trace, [(panel, panel_lines(panel)) for panel in PANELS], marks)
    loops = [_loop(loop, trace, [mark for mark in marks if mark.plot == loop.key]) for loop in LOOPS]
    return Sketch(over_time.height, over_time.panels, [loop for loop in loops if loop.paths])


def panels_over_time(
    trace: Trace, panels: Sequence[tuple[Panel, Sequence[Line]]], marks: Sequence[Mark]
) -> Sketch:
    """Return panels above each other over one time axis, below them the valve states if there are any."""
    last = float(trace.time[-1])
    time = Axis(float(trace.time[0]), last if last > trace.time[0] else last + 1.0, LEFT, RIGHT)
    drawings: list[Drawing] = []
    top = 0.0
    for panel, lines in panels:
        known = [line for line in lines if line.series in trace.series]
        if known:
            own = [mark for mark in marks if mark.plot == panel.key]
            drawings.append(_panel(panel, known, trace, time, top, own))
            top = drawings[-1].bottom + _GAP
    if "valve_command_1" in trace.series:
        drawings.append(_valves(trace, time, top))
        top = drawings[-1].bottom + _GAP
    return Sketch(top + _BELOW, drawings)


def _panel(
    panel: Panel, lines: Sequence[Line], trace: Trace, time: Axis, top: float, marks: Sequence[Mark]
) -> Drawing:
    upper, lower = top + _TITLE, top + _TITLE + panel.height * _HEIGHT
    levels = [mark.y for mark in marks if mark.y is not None]
    y = Axis(*span((trace.series[line.series] for line in lines), [*panel.include, *levels]), lower, upper)
    across = time.pixels(trace.time)
    return Drawing(
        panel.key,
        panel.title,
        LEFT,
        RIGHT,
        upper,
        lower,
        time.tick_marks(10),
        y.tick_marks(4),
        y_title=panel.unit,
        paths=[(line, path_over_time(across, y.pixels(trace.series[line.series]))) for line in lines],
        shaded=list(_shaded(marks, time, upper, lower)),
        levels=list(_levels(marks, time, y)),
    )


def _valves(trace: Trace, time: Axis, top: float) -> Drawing:
    upper = top + _TITLE
    ends = np.append(time.pixels(trace.time), time.end)
    shaded = [
        Rectangle(ends[first], upper + row * _BAND + 2, ends[last] - ends[first], _BAND - 4, state)
        for row, n in enumerate(WHEELSETS)
        if f"valve_command_{n}" in trace.series
        for first, last, state in _stretches(trace.series[f"valve_command_{n}"])
    ]
    bottom = upper + len(WHEELSETS) * _BAND
    y_ticks = [(upper + (row + 0.5) * _BAND, str(n)) for row, n in enumerate(WHEELSETS)]
    x_ticks = time.tick_marks(10)
    title = "WSP valves: hold (faint), vent (strong)"
    return Drawing("valves", title, LEFT, RIGHT, upper, bottom, x_ticks, y_ticks, shaded=shaded)


def _stretches(commands: NDArray[np.float64]) -> Iterator[tuple[int, int, str]]:
    """Yield first row, row after the last, and state of each stretch that is not fill."""
    row = 0
    for command, run in groupby(np.rint(commands).tolist()):
        after = row + sum(1 for _ in run)
        if command in _STATES:
            yield row, after, _STATES[int(command)]
        row = after


def _loop(loop: Loop, trace: Trace, marks: Sequence[Mark]) -> Drawing:
    pairs = [
        (up, trace.series[across], trace.series[up.series])
        for across, up in _pairs(loop)
        if across in trace.series and up.series in trace.series
    ]
    draw = dots if loop.dots else path
    ends = [end for mark in marks for end in (mark.x0, mark.x1) if end is not None]
    x = Axis(*span((across for _, across, _ in pairs), [*loop.include, *ends]), LEFT, _LOOP_WIDTH - 10)
    y = Axis(*span((values for _, _, values in pairs), [0.0]), _LOOP_HEIGHT - 34, _TITLE)
    return Drawing(
        loop.key,
        loop.title,
        x.start,
        x.end,
        y.end,
        y.start,
        x.tick_marks(5),
        y.tick_marks(5),
        loop.across_title,
        loop.up_title,
        [(line, draw(x.pixels(across), y.pixels(values))) for line, across, values in pairs],
        list(_shaded(marks, x, y.end, y.start)),
    )


def _pairs(loop: Loop) -> Iterable[tuple[str, Line]]:
    across, up = QUANTITIES[loop.across], lines_of(loop.up)
    return [
        (f"{loop.across}_{n}" if across.of_wheelsets else loop.across, line) for n, line in enumerate(up, 1)
    ]


def _shaded(marks: Sequence[Mark], x: Axis, upper: float, lower: float) -> Iterator[Rectangle]:
    for mark in marks:
        if mark.kind in ("window", "band"):
            first, last = _ends(mark, x)
            yield Rectangle(first, upper, last - first, lower - upper, mark.kind, mark.label)


def _levels(marks: Sequence[Mark], x: Axis, y: Axis) -> Iterator[Level]:
    for mark in marks:
        if mark.y is not None:
            yield Level(*_ends(mark, x), y.at(mark.y), mark.kind, mark.label)


def _ends(mark: Mark, x: Axis) -> tuple[float, float]:
    first = x.start if mark.x0 is None else x.at(mark.x0)
    return first, x.end if mark.x1 is None else x.at(mark.x1)
