"""Where the verdict flips, drawn over the first of the other parameters."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass

from uictest.report.page.axis import Tick, axis_title
from uictest.report.page.sweep.cell_axis import NumberAxis, spanned
from uictest.report.sweep.result import Frontier, FrontierScan
from uictest.report.sweep.sweep_sentences import circumstances_words, flip_words
from uictest.report.sweep.values import WrittenValue

_LEFT, _RIGHT, _TOP, _BOTTOM = 62, 600, 24, 252
_SIDES = ((_LEFT, _RIGHT), (_BOTTOM, _TOP))
_MOST_SERIES = 6
Point = tuple[float, float, str]
"""Position of a flip, and its tooltip."""


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
    """A flip on both axes, the series that it belongs to, its direction, and its tooltip."""

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


def frontier_plot(frontier: Frontier, logarithmic: Collection[str] = ()) -> FrontierPlot | None:
    """Return the frontier drawn, or None where it depends on no other number.

    `logarithmic` are the keys of the parameters whose axes are.
    """
    key = _numeric_key(frontier.scans)
    flips = [] if key is None else list(_flips(frontier.scans, key))
    if key is None or not flips:
        return None
    scanned = sorted({_number_at(scan, key) for scan in frontier.scans})
    middles = [flip.middle for flip in flips]
    x = spanned(scanned, *_SIDES[0], logarithmic=key in logarithmic)
    y = spanned(middles, *_SIDES[1], logarithmic=frontier.parameter in logarithmic)
    names = list(dict.fromkeys(flip.series for flip in flips))
    series = [
        _series(name, [flip for flip in flips if flip.series == name], scanned, x, y)
        for name in names[:_MOST_SERIES]
    ]
    return FrontierPlot(
        _title(key, (scan.circumstances[key] for scan in frontier.scans), x),
        _title(frontier.parameter, (flip.low for scan in frontier.scans for flip in scan.flips), y),
        series,
        x.tick_marks(8),
        y.tick_marks(6),
        len(names) - len(series),
    )


def _flips(scans: Sequence[FrontierScan], key: str) -> Iterator[_Flip]:
    for scan in scans:
        fixed = {name: value for name, value in scan.circumstances.items() if name != key}
        others = circumstances_words(fixed) if fixed else "the verdict flips here"
        for flip in scan.flips:
            low, high = flip.low.number, flip.high.number
            if low is not None and high is not None:
                yield _Flip(
                    _number_at(scan, key), 0.5 * (low + high), others, flip.met_at_low, flip_words(flip)
                )


def _number_at(scan: FrontierScan, key: str) -> float:
    number = scan.circumstances[key].number
    assert number is not None  # a numeric key has numbers only
    return number


def _series(
    name: str, flips: Sequence[_Flip], scanned: Sequence[float], x: NumberAxis, y: NumberAxis
) -> Series:
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


def _title(key: str, values: Iterable[WrittenValue], axis: NumberAxis) -> str:
    title = axis_title(key, next((value.unit for value in values), ""))
    return f"{title}, logarithmic" if axis.logarithmic else title


def _numeric_key(scans: Sequence[FrontierScan]) -> str | None:
    """Return the first parameter whose values are different numbers."""
    for key in scans[0].circumstances if scans else ():
        numbers = {scan.circumstances[key].number for scan in scans}
        if None not in numbers and len(numbers) > 1:
            return key
    return None
