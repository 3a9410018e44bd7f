"""The panels of an overlay: each channel of both sides, its difference beneath, and what is marked there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Final

from uictest.analysis.comparison.channel_difference import ChannelDifference, WorstInstant, holds
from uictest.analysis.comparison.overlay import Overlay
from uictest.analysis.comparison.overlay_curves import BINS, curve_name
from uictest.judging.evaluation import Status
from uictest.report import Panel, PlotLine, channel_title, number, printable, relative_percent, relative_text
from uictest.report.page import STEPS, Mark, OverlayView, overlay_view

_DIFFERENCE_HEIGHT: Final = 0.75
"""Of a panel of a difference, against one of both sides; chosen."""

_STATUSES: Final[Mapping[bool | None, Status]] = MappingProxyType(
    {None: "not_applicable", True: "pass", False: "fail"}
)
"""Within tolerance or not, None without one -> status of the mark of the worst instant."""

DrawnPanel = tuple[Panel, Sequence[PlotLine]]


def view_of(overlay: Overlay) -> OverlayView:
    """Return the overlay as a page draws it."""
    return overlay_view(
        overlay.title,
        sampling_text(overlay),
        overlay.trace,
        [_panels(each) for each in overlay.channels],
        [mark for each in overlay.channels for mark in _marks(each)],
        over_distance=overlay.over_distance.curves,
        marks_over_distance=list(_marks_over_distance(overlay)),
    )


def sampling_text(overlay: Overlay) -> str:
    """Return how the points of the lines were taken from the samples."""
    every = [f"{1e3 * interval:.4g} ms" for interval in overlay.intervals]
    sampled = (
        f"every {every[0]}" if every[0] == every[1] else f"every {every[0]} in A and every {every[1]} in B"
    )
    return (
        f"Sampled {sampled}. A line shows the smallest and the largest sample of each of {BINS} parts,"
        f" rounded to 1/{STEPS} of its range."
    )


def _panels(each: ChannelDifference) -> list[DrawnPanel]:
    """Return the panel of both sides and that of their difference."""
    name, unit = each.channel, _axis_unit(each)
    title = printable(channel_title(name))
    sides = (
        PlotLine(curve_name("first", name), "A", "side-a"),
        PlotLine(curve_name("second", name), "B", "side-b"),
    )
    band = [] if each.allowed is None else [-each.allowed, each.allowed]
    return [
        (Panel(printable(f"sides-of-{name}"), title, unit, (name,), include=()), sides),
        (
            Panel(_key(name), f"B - A: {title}", unit, (name,), _DIFFERENCE_HEIGHT, (0.0, *band)),
            [PlotLine(curve_name("difference", name), "B - A", "difference")],
        ),
    ]


def _marks(each: ChannelDifference) -> Iterator[Mark]:
    """Yield the band of the tolerance and the worst instant."""
    key = _key(each.channel)
    if each.allowed is not None:
        yield Mark(key, "tolerance", f"allowed ±{_with_unit(each, number(each.allowed))}", y=each.allowed)
    if each.worst is not None:
        yield from _worst(each, each.worst, "s", _STATUSES[each.within])


def _marks_over_distance(overlay: Overlay) -> Iterator[Mark]:
    """Yield the worst places; no tolerance, which is for samples of the same time."""
    for each in overlay.channels:
        if (worst := overlay.over_distance.worst.get(each.channel)) is not None:
            yield from _worst(each, worst, "m", "not_applicable")


def _worst(each: ChannelDifference, worst: WorstInstant, unit: str, status: Status) -> Iterator[Mark]:
    apart = worst.second - worst.first
    if not apart:
        return
    label = f"largest {_with_unit(each, f'{apart:+.4g}')} at {number(worst.at)} {unit}"
    if not holds(each.channel) and relative_percent(worst.first, worst.second, each.unit) is not None:
        label += f", {relative_text(worst.first, worst.second, each.unit)} % of A"
    yield Mark(_key(each.channel), "point", label, worst.at, worst.at, apart, status=status)


def _axis_unit(each: ChannelDifference) -> str:
    if holds(each.channel):
        return "number of the state"
    return "dimensionless" if each.unit == "1" else printable(each.unit)


def _key(channel: str) -> str:
    """Return the key of the panel of a difference."""
    return printable(f"difference-of-{channel}")


def _with_unit(each: ChannelDifference, text: str) -> str:
    return text if each.unit == "1" else printable(f"{text} {each.unit}")
