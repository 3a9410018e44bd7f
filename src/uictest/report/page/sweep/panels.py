"""Cases of a sampled sweep as panels of points: every measure over every parameter, on one cursor."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from uictest.report.counts import counted
from uictest.report.escaping import printable
from uictest.report.page.axis import Axis, Tick, axis_title, spanned
from uictest.report.page.plot import Plot, Shape, dot
from uictest.report.page.stop.overlay_view import script_json
from uictest.report.page.sweep.scatter import PointNumbers, Scatter
from uictest.report.sweep import every_case
from uictest.report.verdict_sentences import tone

_SIDES: Final = ((50.0, 292.0), (172.0, 24.0))
"""Ends of the frame of a panel, across and up."""
_LONGEST_TITLE: Final = 40
_SHAPES: Final = {
    "good": ("h0", "m-2-2h4v4h-4z"),
    "bad": ("m-3-3l6 6m0-6l-6 6", "m-3.5 0h7m-3.5-3.5v7", "m0-3.5l3.5 6h-7z"),
    "odd": ("m0-3.5l3.5 3.5l-3.5 3.5l-3.5-3.5z", "m-3 3h6l-3-6z"),
}
"""Points of each tone, as paths from the place of the point: words of the same tone differ in shape."""


@dataclass(frozen=True, slots=True)
class Panel:
    """One measure over one parameter; `data` says which of them, counted from 0."""

    plot: Plot
    data: Mapping[str, int]


@dataclass(frozen=True, slots=True)
class PanelsOfPoints:
    """A row of panels, one for each parameter, for every measure.

    Args:
        measures: name and panels of each that has more than one value.
        key: shapes of points with the word that they stand for, and how many there are.
        sentences: what is shown of what there is.
        data: the JSON that the cursor reads.

    """

    measures: Sequence[tuple[str, Sequence[Panel]]]
    key: Sequence[tuple[str, str, str]]
    sentences: Sequence[str]
    data: str


def panels_of_points(scatter: Scatter, fragments: Mapping[str, str]) -> PanelsOfPoints:
    """Return the points of a sampled sweep; `fragments` has what links to each drawn stop, by id."""
    shapes = _shapes(scatter)
    across, up = (
        [_axis(each, *ends) for each in columns]
        for columns, ends in zip((scatter.parameters, scatter.measures), _SIDES, strict=True)
    )
    return PanelsOfPoints(
        [
            (
                measure.name,
                [
                    Panel(_panel(scatter, (x, y), (j, k), shapes, fragments), {"across": j, "up": k})
                    for j, x in enumerate(across)
                ],
            )
            for k, (measure, y) in enumerate(zip(scatter.measures, up, strict=True))
            if len(np.unique(measure.numbers[np.isfinite(measure.numbers)])) > 1
        ],
        [(*shapes[word], _count(scatter, word)) for word in shapes],
        list(_sentences(scatter)),
        script_json(_form(scatter, (across, up), fragments)),
    )


def _shapes(scatter: Scatter) -> dict[str, tuple[str, str]]:
    """Return class and path of the points of each word; the most frequent one is painted first."""
    used: Counter[str] = Counter()
    shapes = {}
    for word in sorted(scatter.all_words, key=lambda word: -scatter.all_words[word]):
        own = _SHAPES[tone(word)]
        shapes[word] = f"points tone-{tone(word)}", own[min(used[tone(word)], len(own) - 1)]
        used[tone(word)] += 1
    return shapes


def _axis(column: PointNumbers, start: float, end: float) -> Axis:
    return spanned(column.numbers.tolist(), start, end, logarithmic=column.logarithmic)


def _panel(
    scatter: Scatter,
    axes: tuple[Axis, Axis],
    places: tuple[int, int],
    shapes: Mapping[str, tuple[str, str]],
    fragments: Mapping[str, str],
) -> Plot:
    (x, y), (parameter, measure) = axes, (scatter.parameters[places[0]], scatter.measures[places[1]])
    pixels = list(zip(x.pixels(parameter.numbers), y.pixels(measure.numbers), strict=True))
    known = [k for k, (px, py) in enumerate(pixels) if px == px and py == py]
    painted = []
    for word, (kind, shape) in shapes.items():
        own = [k for k in known if scatter.words[k] == word]
        if path := "".join(f"M{pixels[k][0]:.1f} {pixels[k][1]:.1f}{shape}" for k in own):
            painted.append(Shape(f"{kind} faint" if len(own) > 300 else kind, path))
    painted += [
        Shape("of-stop", dot(*pixels[k], 6.0), scatter.ids[k], fragments[scatter.ids[k]])
        for k in known
        if scatter.ids[k] in fragments
    ]
    return Plot(
        _fitted_title(measure),
        f"{_title(measure)} over {_title(parameter)}",
        _fitted_title(parameter),
        list(_apart(x.tick_marks(5))),
        y.tick_marks(5),
        painted,
        across=_SIDES[0],
        up=_SIDES[1],
    )


def _title(column: PointNumbers) -> str:
    return axis_title(column.name, column.unit, logarithmic=column.logarithmic)


def _fitted_title(column: PointNumbers) -> str:
    """Return a title as short as its panel: the last parts of a dotted key say most."""
    parts = column.name.split(".")
    title = _title(column)
    while len(title) > _LONGEST_TITLE and len(parts) > 1:
        parts.pop(0)
        title = axis_title(f"…{'.'.join(parts)}", column.unit, logarithmic=column.logarithmic)
    return title


def _apart(ticks: Sequence[Tick]) -> Iterator[Tick]:
    """Yield the ticks without those whose labels would touch the one before."""
    end = -math.inf
    for at, label in ticks:
        half = 3.2 * len(label)
        if at - half > end + 4:
            yield at, label
            end = at + half


def _count(scatter: Scatter, word: str) -> str:
    shown, cases = scatter.words.count(word), scatter.all_words[word]
    return f"{word}: {cases}" if shown == cases else f"{word}: {shown} of {cases} shown"


def _sentences(scatter: Scatter) -> Iterator[str]:
    shown = len(scatter.ids)
    if shown < scatter.cases:
        by_chance = f"{_grouped(shown - scatter.added)} of {_grouped(scatter.cases)} cases"
        own = f", and {counted(scatter.added, 'drawn stop')} besides" if scatter.added else ""
        yield f"Shown: {by_chance}, chosen at random{own}."
        yield f"Rare cases may be missing here; {every_case(scatter.cases)} has every case."
    else:
        yield f"Shown: all {counted(shown, 'case')}."
    if scatter.left_out:
        yield f"Not numbers of one unit, and not here: {', '.join(scatter.left_out)}."
    for measure in scatter.measures:
        if missing := int(np.count_nonzero(np.isnan(measure.numbers))):
            yield f"{counted(missing, 'point')} without {measure.name}."


def _form(scatter: Scatter, axes: Sequence[Sequence[Axis]], fragments: Mapping[str, str]) -> dict[str, Any]:
    return {
        "parameters": list(map(_numbers, scatter.parameters, axes[0])),
        "measures": list(map(_numbers, scatter.measures, axes[1])),
        "ids": list(map(printable, scatter.ids)),
        "words": scatter.words,
        "stops": {place: fragments[name] for place, name in enumerate(scatter.ids) if name in fragments},
    }


def _numbers(column: PointNumbers, axis: Axis) -> dict[str, Any]:
    return {
        "name": printable(column.name),
        "unit": printable(column.unit),
        "values": [_rounded(value) if value == value else None for value in column.numbers.tolist()],
        "axis": axis._asdict(),
    }


def _rounded(value: float) -> float:
    """Return a number with seven digits, and a whole one, as a seed is, with all."""
    return value if value.is_integer() else float(f"{value:.7g}")


def _grouped(count: int) -> str:
    return f"{count:,}".replace(",", " ")
