"""The plots of one stop as plain drawings: what paper, and a browser without JavaScript, show."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from uictest.report.page.axis import Axis, Tick, span
from uictest.report.page.stop.mark import ROW, Labels, Mark, bars_path, labels_of, magnet_bars, mark_bars
from uictest.report.page.stop.polyline import dots, path, path_over_time, pieces
from uictest.report.traces.quantities import (
    LOOPS,
    PANELS,
    WHEELSETS,
    Panel,
    PlotLine,
    PlotLoop,
    Strip,
    in_order,
    loop_lines,
    panel_lines,
)
from uictest.report.traces.trace import Curve, PlotTrace

WIDTH, LEFT, RIGHT = 960, 52, 948
_HEIGHT, _TITLE, _GAP = 96, 22, 6  # of a panel of height 1, of its title, below it
_BELOW = 32  # the panels: tick labels and what they count
_BAND, _LANE = 15, 12  # of a wheelset in a strip, of a lane
_LOOP_WIDTH, _LOOP_HEIGHT = 316, 230
_LOOP_OF = "wheelset-1"
"""The role of the wheelset whose loops are drawn: the leading one; the others are on the page itself."""


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A shaded part of a drawing, pixels."""

    x: float
    y: float
    width: float
    height: float
    kind: str
    status: str


@dataclass(frozen=True, slots=True)
class Level:
    """A level line of a mark, pixels; a point where both ends are the same."""

    x1: float
    x2: float
    y: float
    kind: str
    status: str


@dataclass(frozen=True, slots=True)
class PlotDrawing:
    """One plot ready to be written as SVG: every coordinate in pixels."""

    key: str
    title: str
    left: float
    right: float
    top: float
    bottom: float
    labels: Labels
    x_ticks: Sequence[Tick] = ()
    y_ticks: Sequence[Tick] = ()
    x_title: str = ""
    y_title: str = ""
    paths: Sequence[tuple[PlotLine, str]] = ()
    shaded: Sequence[Rectangle] = ()
    levels: Sequence[Level] = ()
    bars: Sequence[tuple[str, str]] = ()
    """Kind of bars and their path."""
    ruled: bool = True
    """Whether a line goes through each label of the upright axis."""

    def label_y(self, row: int) -> float:
        """Return the base line of a row of labels; row 0 is that of the title."""
        return self.top - 7 - ROW * (self.labels.rows - 1 - row)


@dataclass(frozen=True, slots=True)
class Sketch:
    """All plots of one stop: panels above each other over one time axis, and the loops."""

    height: float
    panels: list[PlotDrawing] = field(default_factory=list)
    loops: list[PlotDrawing] = field(default_factory=list)


def sketch_of(trace: PlotTrace, marks: Sequence[Mark]) -> Sketch:
    """Return the drawings of a stop; quantities that it has no series of are left out."""
    over_time = panels_over_time(trace, [(panel, panel_lines(panel)) for panel in PANELS], marks)
    loops = [_loop(loop, trace, [mark for mark in marks if mark.plot == loop.key]) for loop in LOOPS]
    return Sketch(over_time.height, over_time.panels, [loop for loop in loops if loop.paths])


def panels_over_time(
    trace: PlotTrace, panels: Sequence[tuple[Panel, Sequence[PlotLine]]], marks: Sequence[Mark]
) -> Sketch:
    """Return panels and strips above each other over one time axis; those without content are left out."""
    time = Axis(trace.start, trace.end if trace.end > trace.start else trace.start + 1.0, LEFT, RIGHT)
    drawings: list[PlotDrawing] = []
    top = 0.0
    lines = {panel.key: own for panel, own in panels}
    for each in in_order([panel for panel, _ in panels]):
        own = [mark for mark in marks if mark.plot == each.key]
        if isinstance(each, Strip):
            drawn = _strip(each, trace, time, top, own)
        else:
            drawn = _panel(each, lines[each.key], trace, time, top, own)
        if drawn is not None:
            drawings.append(drawn)
            top = drawn.bottom + _GAP
    return Sketch(top + _BELOW, drawings)


def _panel(
    panel: Panel, lines: Sequence[PlotLine], trace: PlotTrace, time: Axis, top: float, marks: Sequence[Mark]
) -> PlotDrawing | None:
    curves = [(line, trace.curves[line.series]) for line in lines if line.series in trace.curves]
    if not curves:
        return None
    labels = labels_of(f"{panel.title}, {panel.unit}", marks, time)
    upper = top + _TITLE + ROW * (labels.rows - 1)
    lower = upper + panel.height * _HEIGHT
    levels = [mark.y for mark in marks if mark.y is not None]
    y = Axis(*span((curve.y for _, curve in curves), [*panel.include, *levels]), lower, upper)
    return PlotDrawing(
        panel.key,
        panel.title,
        LEFT,
        RIGHT,
        upper,
        lower,
        labels,
        time.tick_marks(10),
        y.tick_marks(4),
        y_title=panel.unit,
        paths=[(line, path_over_time(time.pixels(curve.x), y.pixels(curve.y))) for line, curve in curves],
        shaded=[*_shaded(marks, time, upper, lower), *_tolerances(marks, time, y)],
        levels=list(_levels(marks, time, y)),
    )


def _strip(
    strip: Strip, trace: PlotTrace, time: Axis, top: float, marks: Sequence[Mark]
) -> PlotDrawing | None:
    bars = mark_bars(marks, strip) | magnet_bars(trace, strip.lanes)
    if not bars:
        return None
    labels = labels_of(strip.heading, marks, time)
    upper = top + _TITLE + ROW * (labels.rows - 1)
    bottom = upper + len(WHEELSETS) * max(_BAND, _LANE * len(strip.lanes))
    row = Axis(0.5, len(WHEELSETS) + 0.5, upper, bottom)
    return PlotDrawing(
        strip.key,
        strip.heading,
        LEFT,
        RIGHT,
        upper,
        bottom,
        labels,
        time.tick_marks(10),
        [(row.at(place), label) for place, label in strip.rows],
        bars=[(kind, bars_path(kind, each, time, row)) for kind, each in bars.items()],
        ruled=bool(strip.lanes),
    )


def _loop(loop: PlotLoop, trace: PlotTrace, marks: Sequence[Mark]) -> PlotDrawing:
    """Return the drawing of a loop; of wheelsets it shows one, as four loops hide each other."""
    curves = [
        (line, trace.loops[name])
        for _, line in loop_lines(loop)
        if line.role in ("train", _LOOP_OF) and (name := f"{loop.key} {line.series}") in trace.loops
    ]
    ends = [end for mark in marks for end in (mark.x0, mark.x1) if end is not None]
    x = Axis(*span((curve.x for _, curve in curves), [*loop.include, *ends]), LEFT, _LOOP_WIDTH - 10)
    labels = labels_of(_loop_title(loop, curves), marks, x)
    top = _TITLE + ROW * (labels.rows - 1)
    y = Axis(*span((curve.y for _, curve in curves), [0.0]), _LOOP_HEIGHT - 34, top)
    return PlotDrawing(
        loop.key,
        _loop_title(loop, curves),
        x.start,
        x.end,
        y.end,
        y.start,
        labels,
        x.tick_marks(5),
        y.tick_marks(5),
        loop.across_title,
        loop.up_title,
        [drawn for line, curve in curves for drawn in _loop_paths(loop, line, curve, x, y)],
        list(_shaded(marks, x, y.end, y.start)),
    )


def _loop_title(loop: PlotLoop, curves: Sequence[tuple[PlotLine, Curve]]) -> str:
    of_wheelset = any(line.role == _LOOP_OF for line, _ in curves)
    return f"{loop.title}, {_LOOP_OF.replace('-', ' ')}" if of_wheelset else loop.title


def _loop_paths(
    loop: PlotLoop, line: PlotLine, curve: Curve, x: Axis, y: Axis
) -> Iterator[tuple[PlotLine, str]]:
    """Yield the paths of a loop; a directed one has a second, dotted line where it falls."""
    across, up = x.pixels(curve.x), y.pixels(curve.y)
    if not loop.directed:
        yield line, (dots if loop.dots else path)(across, up)
        return
    for direction in (1, -1):
        own = [(first, last) for first, last, way in pieces(curve.x) if way == direction]
        drawn = "".join(path(across[first : last + 1], up[first : last + 1]) for first, last in own)
        if drawn:
            yield replace(line, dotted=direction < 0, role=line.role if direction > 0 else "falling"), drawn


def _shaded(marks: Sequence[Mark], x: Axis, upper: float, lower: float) -> Iterator[Rectangle]:
    for mark in marks:
        if mark.y is None:
            first, last = _ends(mark, x)
            yield Rectangle(first, upper, last - first, lower - upper, mark.kind, mark.status)


def _tolerances(marks: Sequence[Mark], x: Axis, y: Axis) -> Iterator[Rectangle]:
    for mark in marks:
        if mark.kind == "tolerance" and mark.y is not None:
            upper, lower = y.at(mark.y), y.at(-mark.y)
            yield Rectangle(x.start, upper, x.end - x.start, lower - upper, mark.kind, mark.status)


def _levels(marks: Sequence[Mark], x: Axis, y: Axis) -> Iterator[Level]:
    for mark in marks:
        if mark.y is not None and mark.kind != "tolerance":
            yield Level(*_ends(mark, x), y.at(mark.y), mark.kind, mark.status)


def _ends(mark: Mark, x: Axis) -> tuple[float, float]:
    first = x.start if mark.x0 is None else x.at(mark.x0)
    return first, x.end if mark.x1 is None else x.at(mark.x1)
