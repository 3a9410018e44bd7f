"""Two recordings drawn over each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from uictest import recording
from uictest.comparison.channels import common_channels, only_in
from uictest.report import Curve, Panel, PlotLine, PlotTrace, curve_of, interval_of, printable

DRAWN = 12
"""Largest number of channels drawn where none are chosen."""

FIRST_DRAWN = ("speed", *(f"slide_{n}" for n in (1, 2, 3, 4)), "tank_pressure_1", "clamping_force_1")
"""The most informative channels of a stop: they come first where none are chosen."""


@dataclass(frozen=True, slots=True)
class Overlay:
    """Panels with a line for each side.

    `not_drawn` are channels of both sides without a panel; `only_first` and `only_second` those of one side.
    """

    title: str
    trace: PlotTrace
    panels: Sequence[tuple[Panel, Sequence[PlotLine]]]
    not_drawn: Sequence[str] = ()
    only_first: Sequence[str] = ()
    only_second: Sequence[str] = ()


def default_channels(remarkable: Sequence[str], common: Sequence[str]) -> list[str]:
    """Return what is drawn where no channels are chosen: the speed and the remarkable channels."""
    first = [name for name in FIRST_DRAWN if name == "speed" or name in remarkable]
    return [name for name in dict.fromkeys([*first, *remarkable]) if name in common][:DRAWN]


def overlay_of(
    title: str,
    first: recording.Recording,
    second: recording.Recording,
    names: tuple[str, str],
    channels: Sequence[str],
) -> Overlay:
    """Return channels that both recordings have, drawn over each other, each to its own end."""
    curves = {}
    panels = []
    for name in channels:
        curves[f"first {name}"] = curve_of(first["time"], first[name])
        curves[f"second {name}"] = curve_of(second["time"], second[name])
        lines = (
            PlotLine(f"first {name}", names[0], "train"),
            PlotLine(f"second {name}", names[1], "wheelset-3", dotted=True),
        )
        shown = printable(name)
        panels.append((Panel(shown, shown, printable(first.units[name]), (name,), include=()), lines))
    common = common_channels(first.units, second.units)
    return Overlay(
        title,
        _trace(first, second, curves),
        panels,
        [name for name in common if name not in channels],
        only_in(first.units, second.units),
        only_in(second.units, first.units),
    )


def _trace(first: recording.Recording, second: recording.Recording, curves: Mapping[str, Curve]) -> PlotTrace:
    times = first["time"], second["time"]
    intervals = {interval_of(time) for time in times}
    start, end = (float(pick(time[place] for time in times)) for pick, place in ((min, 0), (max, -1)))
    # Times of another interval than the other side's would be rounded to it.
    return PlotTrace(start, end, intervals.pop() if len(intervals) == 1 else 0.0, curves)
