"""Two recordings drawn over each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from uictest.report.escaping import printable
from uictest.report.page.quantities import Line, Panel
from uictest.report.page.trace import SAMPLES, Trace

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
    """Return the speed and the remarkable channels of both recordings on the times of the first one."""
    channels = [name for name in dict.fromkeys([_SPEED, *remarkable]) if _in_both(name, first, second)]
    time = first["time"][:: -(-len(first) // SAMPLES)]
    series = {}
    panels = []
    for name in channels[:DRAWN]:
        series[f"first {name}"] = np.interp(time, first["time"], first[name])
        series[f"second {name}"] = np.interp(time, second["time"], second[name], right=np.nan)
        lines = (
            Line(f"first {name}", names[0], "train"),
            Line(f"second {name}", names[1], "wheelset-3", dotted=True),
        )
        shown = printable(name)
        panels.append((Panel(shown, shown, printable(first.units[name]), (name,), include=()), lines))
    return Overlay(title, Trace(time, series), panels, max(len(channels) - DRAWN, 0))


def _in_both(name: str, first: Recording, second: Recording) -> bool:
    return first.units.get(name) is not None and first.units.get(name) == second.units.get(name)
