"""Vent by vent: how deep a wheelset slid, how far its pressure fell, how long it took to recover."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.report.traces.quantities import VENT, WHEELSETS

Series = NDArray[np.float64]


class VentCycle(NamedTuple):
    """One vent of a wheelset. What was not recorded, or did not happen, is NaN.

    Args:
        wheelset: its number.
        start: of the vent, s since the brake command.
        duration: of the vent, s.
        slide: at its start, %.
        drop: of the pressure from the start of the vent to its lowest value before the next one, bar.
        recovery: from the start of the vent until the slide, after its peak, is no larger than then, s; NaN
            where the next vent comes before.

    """

    wheelset: int
    start: float
    duration: float
    slide: float
    drop: float
    recovery: float


def vent_cycles(time: Series, series: Mapping[str, Series]) -> tuple[VentCycle, ...]:
    """Return the vents of all wheelsets in the order of their starts.

    Args:
        time: of the samples, s.
        series: samples by channel: states of valves, slides in %, pressures in bar.

    """
    cycles = (cycle for n in WHEELSETS for cycle in _of_wheelset(time, series, n))
    return tuple(sorted(cycles, key=lambda cycle: cycle.start))


def _of_wheelset(time: Series, series: Mapping[str, Series], n: int) -> Iterator[VentCycle]:
    if (valve := series.get(f"valve_command_{n}")) is None:
        return
    missing = np.full(len(time), math.nan)
    slide, pressure = series.get(f"slide_{n}", missing), series.get(f"tank_pressure_{n}", missing)
    edges = np.flatnonzero(np.diff(np.rint(valve) == VENT, prepend=False, append=False))
    starts, ends = edges[::2], edges[1::2]
    next_starts = np.append(starts, len(time))[1:]
    for start, end, following in zip(starts, ends, next_starts, strict=True):
        yield VentCycle(
            n,
            float(time[start]),
            float(time[min(end, len(time) - 1)] - time[start]),
            float(slide[start]),
            float(pressure[start] - np.min(pressure[start:following])),
            _recovery(time, slide, start, following),
        )


def _recovery(time: Series, slide: Series, start: int, following: int) -> float:
    """Return the time from the start of a vent until the slide is back; NaN where it is not in time."""
    own = slide[start:following]
    if math.isnan(own[0]):
        return math.nan
    peak = int(np.nanargmax(own))
    back = np.flatnonzero(own[peak:] <= own[0])
    return float(time[start + peak + back[0]] - time[start]) if len(back) else math.nan
