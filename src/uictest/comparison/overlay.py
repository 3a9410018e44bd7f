"""Two recordings drawn over each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from uictest.report.escaping import printable
from uictest.report.page.quantities import Line, Panel
from uictest.report.page.trace import Trace, curve_of, interval_of

if TYPE_CHECKING:
    from uictest.recording import Recording

DRAWN = 12
"""Channels drawn at most; the speed and those out of tolerance come first."""

_SPEED = "speed"


@dataclass(frozen=True, slots=True)
class Overlay:
    """Panels with a line for each side. `left_out` counts remarkable channels that are not drawn."""

    title: str
    trace: Trace
    panels: Sequence[tuple[Panel, Sequence[Line]]]
    left_out: int


def overlay_of(
    title: str, first: Recording, second: Recording, names: tuple[str, str], remarkable: Sequence[str]
) -> Overlay:
    """Return the speed and the remarkable channels of both recordings, each to its own end."""
    channels = [name for name in dict.fromkeys([_SPEED, *remarkable]) if _in_both(name, first, second)]
    curves = {}
    panels = []
    for name in channels[:DRAWN]:
        curves[f"first {name}"] = curve_of(first["time"], first[name])
        curves[f"second {name}"] = curve_of(second["time"], second[name])
        lines = (
            Line(f"first {name}", names[0], "train"),
            Line(f"second {name}", names[1], "wheelset-3", dotted=True),
        )
        shown = printable(name)
        panels.append((Panel(shown, shown, printable(first.units[name]), (name,), include=()), lines))
    end = max(float(first["time"][-1]), float(second["time"][-1]))
    trace = Trace(float(first["time"][0]), end, interval_of(first["time"]), curves)
    return Overlay(title, trace, panels, max(len(channels) - DRAWN, 0))


def _in_both(name: str, first: Recording, second: Recording) -> bool:
    return first.units.get(name) is not None and first.units.get(name) == second.units.get(name)
