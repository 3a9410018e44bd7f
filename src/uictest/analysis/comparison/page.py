"""The page of a comparison: differences, panels, and the braking distances of both sides."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

from uictest.analysis.comparison.difference import Comparison, verdict_line
from uictest.analysis.comparison.overlay import (
    BINS,
    ChannelDifference,
    Overlay,
    WorstInstant,
    curve_name,
    holds,
)
from uictest.analysis.comparison.paired_document import effects, group_text, method, paired_table, same_text
from uictest.analysis.comparison.paired_stops import PairedComparison
from uictest.analysis.comparison.parameters import ParameterChange
from uictest.core.document import Column, Table
from uictest.core.measures import without_wheelset
from uictest.core.recording import state_kind
from uictest.core.units import SIZES
from uictest.judging.evaluation import Status
from uictest.report import (
    Difference,
    Panel,
    PlotLine,
    Value,
    channel_title,
    furthest_out,
    listed,
    measure_heading,
    number,
    printable,
    relative_percent,
    relative_text,
    shown_unit,
    side_text,
    turn,
    turn_tone,
)
from uictest.report.page import (
    ROW_PIXELS,
    STEPS,
    Drawing,
    Mark,
    Plot,
    Shape,
    case_anchor,
    dot,
    forest,
    fragment,
    packed,
    panel_form,
    panels_over_time,
    render,
    row_at,
    rows_plot,
    script_json,
    spanned,
)

MEASURE: Final = "braking_distance_m"
MOST: Final = 40
"""Rows that are drawn, those that differ most; the table has the others. Chosen: two screens."""
_LETTERS: Final = 40
"""Characters of the id of a case that have room."""


@dataclass(frozen=True, slots=True)
class Dumbbells:
    """The rows, those that differ most first, and how many cases have none."""

    plot: Plot
    left_out: int


def dumbbells(differences: Iterable[Difference]) -> Dumbbells | None:
    """Return the drawing of the cases whose braking distance differs; None where there is none."""
    distances = [
        (each.case, each.first, each.second)
        for each in differences
        if each.quantity == MEASURE and not isinstance(each.first, str) and not isinstance(each.second, str)
    ]
    distances = [each for each in distances if math.isfinite(each[1] + each[2])]
    if not distances:
        return None
    drawn = sorted(distances, key=lambda each: -abs(each[2] - each[1]))[:MOST]
    axis = spanned([end for each in drawn for end in each[1:]], *ROW_PIXELS)
    shapes = []
    for row, (case, first, second) in enumerate(drawn):
        words = f"{case}: {first:.5g} m, then {second:.5g} m ({second - first:+.4g} m)"
        x, y = (axis.at(first), axis.at(second)), row_at(row)
        shapes += [
            Shape("interval-line", f"M{x[0]:.1f} {y}H{x[1]:.1f}", words),
            Shape("effect", dot(x[0], y, 4.0), words),
            Shape("effect clear", dot(x[1], y, 4.0), words),
        ]
    names = [case if len(case) <= _LETTERS else f"…{case[1 - _LETTERS :]}" for case, _, _ in drawn]
    about = "Braking distance of A and B in each case that differs; the table of differences has the numbers"
    x_title = "braking distance, m; open: A, filled: B"
    return Dumbbells(
        rows_plot(names, shapes, axis.tick_marks(7), about, x_title), len(distances) - len(drawn)
    )


def quantity_title(difference: Difference) -> str:
    """Return the title of a quantity; a name that is neither a measure of a case nor a channel stays."""
    if not difference.case:
        return channel_title(difference.quantity)
    measure, wheelset = without_wheelset(difference.quantity)
    heading = measure_heading(measure).words
    if heading == difference.quantity:
        return heading
    title = heading.capitalize()
    return f"{title} of wheelset {wheelset}" if wheelset else title


def in_page_units(difference: Difference) -> Difference:
    """Return a difference of measures in the units of every page: kN, and shares in %."""
    measure, _ = without_wheelset(difference.quantity)
    measure_unit = measure_heading(measure).unit if difference.case else ""
    unit = shown_unit(measure, measure_unit or difference.unit)
    if unit == difference.unit or not {unit, difference.unit} <= SIZES.keys():
        return difference
    size = SIZES[unit] / SIZES[difference.unit]
    return dataclasses.replace(
        difference,
        unit=unit,
        first=_scaled_value(difference.first, size),
        second=_scaled_value(difference.second, size),
        deviation=None if difference.deviation is None else difference.deviation / size,
        allowed=None if difference.allowed is None else difference.allowed / size,
    )


def _scaled_value(value: Value, size: float) -> Value:
    return value if isinstance(value, str) else value / size


_DIFFERENCE_HEIGHT: Final = 0.75
"""Of a panel of a difference, against one of both sides; chosen."""


def overlay_drawings(overlay: Overlay) -> list[Drawing]:
    """Return a drawing of each channel and its difference: a page of paper holds some, not all."""
    return [panels_over_time(overlay.trace, _channel_panels(channel)) for channel in overlay.channels]


def overlay_json(overlay: Overlay) -> str:
    """Return the data from which the script draws an overlay, over time and over distance."""
    trace = overlay.trace
    marks = [mark for channel in overlay.channels for mark in _channel_marks(channel)]
    return script_json(
        {
            "id": printable(overlay.title),
            "sampling": sampling_text(overlay),
            "start": trace.start,
            "end": trace.end,
            "over_time": packed(trace.curves, trace.interval),
            "over_distance": packed(overlay.over_distance.curves),
            "marks": [mark._asdict() for mark in marks],
            "marks_over_distance": [mark._asdict() for mark in _marks_over_distance(overlay)],
            "panels": [
                panel_form(*panel) for channel in overlay.channels for panel in _channel_panels(channel)
            ],
        }
    )


def sampling_text(overlay: Overlay) -> str:
    """Return the sentence on how the points of the lines were taken from the samples."""
    every = [f"{1e3 * interval:.4g} ms" for interval in overlay.intervals]
    sampled = (
        f"every {every[0]}" if every[0] == every[1] else f"every {every[0]} in A and every {every[1]} in B"
    )
    return (
        f"Sampled {sampled}. A line shows the smallest and the largest sample of each of {BINS} parts,"
        f" rounded to 1/{STEPS} of its range."
    )


def _channel_panels(difference: ChannelDifference) -> list[tuple[Panel, Sequence[PlotLine]]]:
    name, unit = difference.channel, _axis_unit(difference)
    title = printable(channel_title(name))
    sides = (
        PlotLine(curve_name("first", name), "A", "side-a"),
        PlotLine(curve_name("second", name), "B", "side-b"),
    )
    band = [] if difference.allowed is None else [-difference.allowed, difference.allowed]
    return [
        (Panel(printable(f"sides-of-{name}"), title, unit, (name,), include=()), sides),
        (
            Panel(_difference_key(name), f"B - A: {title}", unit, (name,), _DIFFERENCE_HEIGHT, (0.0, *band)),
            [PlotLine(curve_name("difference", name), "B - A", "difference")],
        ),
    ]


def _channel_marks(difference: ChannelDifference) -> Iterator[Mark]:
    """Yield the band of the tolerance and the worst instant."""
    key = _difference_key(difference.channel)
    if difference.allowed is not None:
        yield Mark(
            key,
            "tolerance",
            f"allowed ±{_with_unit(difference, number(difference.allowed))}",
            y=difference.allowed,
        )
    if difference.worst is not None:
        judged: Status = "pass" if difference.within else "fail"
        yield from _worst_mark(
            difference, difference.worst, "s", "not_applicable" if difference.within is None else judged
        )


def _marks_over_distance(overlay: Overlay) -> Iterator[Mark]:
    """Yield the worst places; no tolerance, which is for samples of the same time."""
    for each in overlay.channels:
        if (worst := overlay.over_distance.worst.get(each.channel)) is not None:
            yield from _worst_mark(each, worst, "m", "not_applicable")


def _worst_mark(
    difference: ChannelDifference, worst: WorstInstant, unit: str, status: Status
) -> Iterator[Mark]:
    apart = worst.second - worst.first
    if not apart:
        return
    label = f"largest {_with_unit(difference, f'{apart:+.4g}')} at {number(worst.at)} {unit}"
    if (
        not holds(difference.channel)
        and relative_percent(worst.first, worst.second, difference.unit) is not None
    ):
        label += f", {relative_text(worst.first, worst.second, difference.unit)} % of A"
    yield Mark(_difference_key(difference.channel), "point", label, worst.at, worst.at, apart, status=status)


def _axis_unit(difference: ChannelDifference) -> str:
    if holds(difference.channel):
        return "number of the state"
    return "dimensionless" if difference.unit == "1" else printable(difference.unit)


def _difference_key(channel: str) -> str:
    return printable(f"difference-of-{channel}")


def _with_unit(difference: ChannelDifference, text: str) -> str:
    return text if difference.unit == "1" else printable(f"{text} {difference.unit}")


_PAIRED: Final[dict[str, Any]] = {
    "forest": forest,
    "effects": effects,
    "paired_method": method,
    "paired_table": paired_table,
    "group_text": group_text,
    "same_text": same_text,
}
"""What the tables of paired differences are made with."""


def comparison_html(comparison: Comparison) -> str:
    """Return one page with the differences and both sides drawn over each other; it loads nothing."""
    overlays = comparison.overlays
    stated = {remark for overlay in overlays for remark in overlay.remarks}
    return render(
        "comparison.html.j2",
        comparison=comparison,
        notes=[note for note in comparison.notes if note not in stated],
        overlays=overlays,
        overlay_drawings=overlay_drawings,
        overlay_json=overlay_json,
        case_anchor=case_anchor,
        fragments={overlay.title: fragment(case_anchor(overlay.title)) for overlay in overlays},
        verdict_line=verdict_line(comparison),
        drawn=dumbbells(comparison.differences),
        turned=[each for each in comparison.differences if each.status is not None],
        differences_table=differences_table,
        parameters_table=parameters_table,
        relative_cell=relative_cell,
        sampling_text=sampling_text,
        state_kind=state_kind,
        channel_title=channel_title,
        with_plots=bool(overlays),
        running_head=f"{comparison.first} and {comparison.second}",
        paired=[] if comparison.paired is None else [comparison.paired],
        **_PAIRED,
    )


def signed_deviation(difference: Difference) -> str:
    """Return second - first with its sign; `-` where the sides cannot be subtracted."""
    first, second = difference.first, difference.second
    if isinstance(first, str) or isinstance(second, str) or difference.deviation is None:
        return "-"
    return f"{second - first:+.5g}"


def relative_cell(quantity: str, first: Value, second: Value, unit: str) -> str:
    """Return by how many per cent of A's size B exceeds A, or why it is not said; states have no size."""
    return "-" if state_kind(quantity) else relative_text(first, second, unit)


def _quantity_text(difference: Difference) -> str:
    title = quantity_title(difference)
    return title if title == difference.quantity else f"{title} ({difference.quantity})"


def _of_numbers(text: Callable[[Difference], str]) -> Callable[[Difference], str]:
    """Return the text of a column in which verdicts and other texts have none."""
    return lambda each: "" if isinstance(each.first, str) else text(each)


_DIFFERENCES: Final[tuple[Column[Difference], ...]] = (
    Column(heading="verdict", text=turn, tone=turn_tone),
    Column(heading="case", text=lambda each: each.case, literal=True),
    Column(heading="quantity", text=_quantity_text, literal=True),
    Column(heading="A", text=lambda each: side_text(each.first), right=True),
    Column(heading="B", text=lambda each: side_text(each.second), right=True),
    Column(heading="B - A", text=_of_numbers(signed_deviation), right=True),
    Column(
        heading="% of A",
        text=_of_numbers(lambda each: relative_cell(each.quantity, each.first, each.second, each.unit)),
        right=True,
    ),
    Column(heading="allowed", text=_of_numbers(lambda each: number(each.allowed)), right=True),
    Column(heading="unit", text=lambda each: each.unit),
    Column(heading="remark", text=lambda each: each.remark, wraps=True),
)
_PARAMETERS: Final[tuple[Column[ParameterChange], ...]] = (
    Column(heading="parameter", text=lambda change: change.key, literal=True),
    Column(heading="A", text=lambda change: change.texts[0]),
    Column(heading="B", text=lambda change: change.texts[1]),
    Column(heading="cases", text=lambda change: listed(change.cases)),
)


def differences_table(differences: Sequence[Difference]) -> Table:
    """Return differences in the units of every page, those furthest out of tolerance first."""
    furthest = furthest_out(map(in_page_units, differences))
    return Table(_DIFFERENCES, sorted(furthest, key=lambda each: each.within))


def parameters_table(changes: Sequence[ParameterChange]) -> Table:
    """Return the changes between two runs, each with its cases."""
    return Table(_PARAMETERS, changes)


def variants_html(run: str, compared: Sequence[PairedComparison]) -> str:
    """Return one page with the paired differences of the variants of a run; it loads nothing."""
    return render("variants.html.j2", run=run, paired=compared, with_plots=False, running_head=run, **_PAIRED)
