"""Drawings as SVG: an axis with its ticks, a frame, and in it shapes, each of them one path."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording import TIME, Recording
from uictest.core.units import KILOMETRE_PER_HOUR

Tick = tuple[float, str]
"""Where a round value lies, in pixels, and its label."""
Key = Sequence[tuple[str, str]]
"""Classes of shapes and what they stand for."""

X_PIXELS: Final = (52.0, 402.0)
"""Ends of the axis across of a plot."""
Y_PIXELS: Final = (166.0, 26.0)
"""Ends of its axis up."""
ROW_PIXELS: Final = (260.0, 880.0)
"""Ends of the axis across of a plot of rows, to the right of their names."""
_ROW: Final = 20.0
"""Height of a row, px; chosen."""
_AIR: Final = 0.04
"""Of what an axis spans: what is left free at its ends; chosen."""
_MOST_DECIMALS: Final = 6
"""Decimals of a label; a smaller number is written with an exponent. Chosen."""


class Axis(NamedTuple):
    """Values from `low` to `high` on pixels from `start` to `end` (upwards where `end` is smaller).

    On a `logarithmic` axis, of numbers above zero, equal ratios are equally long.
    """

    low: float
    high: float
    start: float
    end: float
    logarithmic: bool = False

    def at(self, value: float) -> float:
        """Return the pixel of a value, at most at the ends of the axis."""
        return float(self.pixels(np.float64(value)))

    def pixels(self, values: NDArray[np.float64] | np.float64) -> NDArray[np.float64]:
        """Return the pixels of values, at most at the ends of the axis."""
        inside = np.clip(values, self.low, self.high)
        if self.logarithmic:
            length, from_low = math.log(self.high / self.low), np.log(inside / self.low)
        else:
            length, from_low = self.high - self.low, inside - self.low
        return np.asarray(self.start + from_low * ((self.end - self.start) / length))

    def ticks(self, most: int) -> list[tuple[float, str]]:
        """Return at most about `most` round values with their labels."""
        values = list(self._round_values_of_decades(most)) if self.logarithmic else []
        if len(values) >= 3:
            return [(value, f"{value:.12g}") for value in values]
        # Within less than a decade there are too few round values of a logarithmic axis.
        step = round_step((self.high - self.low) / most)
        decimals = max(0, -math.floor(math.log10(step) + 1e-9))
        form = f".{decimals}f" if decimals <= _MOST_DECIMALS else ".12g"
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        return [(k * step, format(k * step, form)) for k in range(first, last + 1)]

    def tick_marks(self, most: int) -> list[Tick]:
        """Return these ticks in pixels."""
        return [(self.at(value), label) for value, label in self.ticks(most)]

    def _round_values_of_decades(self, most: int) -> Iterator[float]:
        first, last = math.floor(math.log10(self.low)), math.floor(math.log10(self.high))
        decades = last - first + 1
        choices = ((1, 2, 5), (1, 3))
        factors = next((factors for factors in choices if len(factors) * decades <= most + 1), (1,))
        for power in range(first, last + 1, max(1, -(-decades // most))):
            for factor in factors:
                value = float(f"{factor}e{power}")
                if self.low * (1 - 1e-9) <= value <= self.high * (1 + 1e-9):
                    yield value


def round_step(step: float) -> float:
    """Return the smallest of 1, 2, 5 times a power of ten that is not below `step` (> 0)."""
    power = 10.0 ** math.floor(math.log10(step))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= step * (1 - 1e-9))


def span(groups: Iterable[NDArray[np.float64]], include: Iterable[float]) -> tuple[float, float]:
    """Return the ends of an axis: around all finite values, and those to include, with a little air."""
    values = [np.asarray(list(include), dtype=np.float64), *groups]
    finite = np.concatenate([group[np.isfinite(group)] for group in values])
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    if high <= low:
        return low, low + 1.0
    air = _AIR * (high - low)
    return (low if low == 0.0 else low - air), high + air


def spanned(values: Sequence[float], start: float, end: float, *, logarithmic: bool = False) -> Axis:
    """Return an axis that spans values with a little air; it is linear where one is not above zero."""
    finite = [value for value in values if math.isfinite(value)]
    if not logarithmic or not finite or min(finite) <= 0.0:
        return Axis(*span([np.array(values)], ()), start, end)
    air = _AIR * math.log(max(finite) / min(finite)) or math.log(2.0)
    return Axis(min(finite) * math.exp(-air), max(finite) * math.exp(air), start, end, True)


def axis_title(name: str, unit: str = "", *, logarithmic: bool = False) -> str:
    """Return the title of an axis: name, unit where there is one, and whether it is logarithmic."""
    return ", ".join(filter(None, (name, unit if unit != "1" else "", "logarithmic" if logarithmic else "")))


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
        labels: labels in the frame or next to it.
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


def polyline_path(points: Iterable[tuple[float, float]]) -> str:
    """Return the path through points in pixels, with a gap where one is not finite."""
    path, drawing = "", False
    for x, y in points:
        is_finite = math.isfinite(x) and math.isfinite(y)
        if is_finite:
            path += f"{'L' if drawing else 'M'}{x:.1f} {y:.1f}"
        drawing = is_finite
    return path


def dot(x: float, y: float, radius: float = 3.0) -> str:
    """Return the path of a circle around a point."""
    half = f"a{radius:g} {radius:g} 0 1 0"
    return f"M{x - radius:.1f} {y:.1f}{half} {2 * radius:g} 0{half} {-2 * radius:g} 0z"


def row_at(index: int) -> float:
    """Return the height of a row of a plot of rows, pixels."""
    return Y_PIXELS[1] + _ROW * (index + 0.5)


def rows_plot(
    names: Sequence[str],
    shapes: Iterable[Shape],
    ticks: Sequence[Tick],
    words: str,
    x_title: str,
    labels: Sequence[Label] = (),
) -> Plot:
    """Return a plot of named rows below each other, on one axis across; see :func:`row_at`."""
    y_ticks = [(row_at(index), name) for index, name in enumerate(names)]
    up = (Y_PIXELS[1] + _ROW * len(names), Y_PIXELS[1])
    return Plot("", words, x_title, ticks, y_ticks, list(shapes), labels, across=ROW_PIXELS, up=up)


@dataclass(frozen=True, slots=True)
class Effect:
    """A mean in per cent with its interval; `outer` are wider limits around it, where there are any.

    `kind` is the class of its dot; empty: filled where the interval leaves out 0.
    """

    name: str
    mean: float
    low: float
    high: float
    outer: tuple[float, float] | None = None
    kind: str = ""


_WIDEST_FOREST: Final = 200.0
"""Per cent at which the axis of a forest ends, chosen: a mean beyond it is written out."""


def forest(effects: Iterable[Effect], words: str, x_title: str) -> Plot | None:
    """Return means with their intervals on one axis, the largest first; None where there is none.

    The mean is filled where its interval leaves out 0, and is written after the name where the axis does not
    reach it. Wider limits are a band in the background.
    """
    largest_first = sorted(effects, key=lambda effect: -abs(effect.mean))
    if not largest_first:
        return None
    ends = [end for e in largest_first for end in (e.mean, e.low, e.high, *(e.outer or ()))]
    reach = min(max(map(abs, ends)) or 1.0, _WIDEST_FOREST) * 1.05
    axis = Axis(-reach, reach, *ROW_PIXELS)

    def level(first: float, last: float, y: float) -> str:
        return f"M{axis.at(first):.1f} {y}H{axis.at(last):.1f}"

    names = []
    shapes = [Shape("zero", f"M{axis.at(0.0):.1f} {row_at(0) - 10}V{row_at(len(largest_first)) - 10}")]
    for index, effect in enumerate(largest_first):
        y, mean = row_at(index), f"{effect.mean:+.3g} %"
        names.append(f"{effect.name}, {mean}" if abs(effect.mean) > reach else effect.name)
        if effect.outer is not None:
            shapes.append(Shape("outer-limits", level(*effect.outer, y)))
        shapes.append(Shape("interval-line", level(effect.low, effect.high, y)))
        leaves_out_zero = effect.low > 0.0 or effect.high < 0.0
        kind = effect.kind or ("effect clear" if leaves_out_zero else "effect")
        effect_words = f"{effect.name}: {mean} ({effect.low:+.3g} .. {effect.high:+.3g})"
        shapes.append(Shape(kind, dot(axis.at(effect.mean), y, 4.0), effect_words))
    return rows_plot(names, shapes, axis.tick_marks(7), words, x_title)


_OVERLAY_WIDTH, _OVERLAY_PANEL, _OVERLAY_MARGIN = 900, 130, 45
_OVERLAY_POINTS: Final = 1500
"""Points of a line of an overlay at most; chosen."""
_OVERLAY_COLOURS: Final = {"recorded": "#888888", "simulated": "#0060a8"}


def overlay_svg(both: Recording) -> str:
    """Return a file of a recorded stop and its simulation: speeds in km/h over time in s, a panel each."""
    names = [name.removesuffix("_recorded") for name in both.channels if name.endswith("_recorded")]
    panels = "".join(_overlay_panel(both, name, k) for k, name in enumerate(names))
    height = len(names) * (_OVERLAY_PANEL + _OVERLAY_MARGIN) + _OVERLAY_MARGIN
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_OVERLAY_WIDTH} {height}"'
        ' font-family="sans-serif" font-size="12"><title>Recorded and simulated speeds</title>'
        f'<rect width="{_OVERLAY_WIDTH}" height="{height}" fill="white"/>{panels}</svg>\n'
    )


def _overlay_panel(both: Recording, name: str, number: int) -> str:
    left, right = _OVERLAY_MARGIN, _OVERLAY_WIDTH - _OVERLAY_MARGIN
    top = _OVERLAY_MARGIN + number * (_OVERLAY_PANEL + _OVERLAY_MARGIN)
    time = both[TIME]
    highest = max(float(np.nanmax(both[f"{name}_{side}"])) for side in _OVERLAY_COLOURS) / KILOMETRE_PER_HOUR
    stride = max(len(both) // _OVERLAY_POINTS, 1)
    lines = ""
    for side, colour in _OVERLAY_COLOURS.items():
        x = left + (right - left) * time[::stride] / time[-1]
        speed = both[f"{name}_{side}"][::stride] / KILOMETRE_PER_HOUR
        y = top + _OVERLAY_PANEL * (1.0 - speed / max(highest, 1e-9))
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True) if np.isfinite(b))
        lines += f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.2"/>'
    return (
        f'<rect x="{left}" y="{top}" width="{right - left}" height="{_OVERLAY_PANEL}" fill="none"'
        f' stroke="#cccccc"/>{lines}'
        f'<text x="{left}" y="{top - 6}">{name.replace("_", " ")}, 0 to {highest:.0f} km/h</text>'
        f'<text x="{right}" y="{top + _OVERLAY_PANEL + 14}" text-anchor="end">{time[-1]:.1f} s</text>'
    )
