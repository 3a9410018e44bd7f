"""The lowest and the highest of the stops of a repeated case at each moment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from uictest.core.recording import TIME, Recording
from uictest.report.traces.quantities import channel_names
from uictest.report.traces.trace import Curve, PlotTrace, Series, series_in_units

BAND_STOPS: Final = 20
"""Stops of a repeated case that its band holds, the first ones: those of a large run are simulated again."""
BAND_QUANTITIES: Final = ("speed", "wheel_speed", "slide", "cylinder_pressure")
_PART: Final = 0.05
"""s: of every part of a stop the extremes are kept, so that a band takes a fifth of the samples; chosen."""
_ROUNDING: Final = 1e-6
"""Of a part: times that lie no further apart are one."""


class StopExtremes(NamedTuple):
    """The lowest and the highest value of every part of a stop.

    Args:
        start: first time of the record, s since the brake command.
        part: how long each part is, s.
        lowest, highest: channel -> values in the unit of `quantities.PLOT_QUANTITIES`; NaN where there is
            none.

    """

    start: float
    part: float
    lowest: Mapping[str, Series]
    highest: Mapping[str, Series]


def stop_extremes(record: Recording) -> StopExtremes:
    """Return the extremes of what a band shows of a stop."""
    time, series = record[TIME], series_in_units(record)
    interval = float(np.median(np.diff(time))) if len(time) > 1 else _PART
    part = interval * max(round(_PART / interval), 1)
    # A sample at the border of two parts belongs to the later one, however times are rounded.
    places = np.floor((time - time[0]) / part + _ROUNDING).astype(np.intp)
    starts = np.flatnonzero(np.diff(places, prepend=-1))

    def of_parts(extreme: np.ufunc) -> dict[str, Series]:
        values = {}
        for name in (name for key in BAND_QUANTITIES for name in channel_names(key) if name in series):
            values[name] = np.full(places[-1] + 1, np.nan)
            values[name][places[starts]] = extreme.reduceat(series[name], starts)
        return values

    return StopExtremes(float(time[0]), part, of_parts(np.fmin), of_parts(np.fmax))


def with_band(trace: PlotTrace, stops: Sequence[StopExtremes]) -> PlotTrace:
    """Return a trace with the band of the stops of its case, in whatever order; none of fewer than two.

    Beyond the end of a shorter stop the band is that of the stops that still run, up to the end of the trace.
    """
    if len(stops) < 2:
        return trace
    first = stops[0]
    parts = max(len(values) for stop in stops for values in stop.lowest.values())
    # The last border is the first one at or behind the end of the trace.
    drawn = min(int(np.ceil((trace.end - first.start) / first.part - _ROUNDING)), parts) + 1
    x = np.minimum(first.start + first.part * np.arange(drawn), trace.end)

    def edge(values: Sequence[Series], extreme: np.ufunc) -> Curve:
        of_parts = np.full((len(stops), parts + 2), np.nan)
        for row, own in zip(of_parts, values, strict=True):
            row[1 : len(own) + 1] = own
        of_all = extreme.reduce(of_parts)
        # At a border the extreme of both parts: no sample lies beyond the line from one border to the next.
        return Curve(x, extreme(of_all[:-1], of_all[1:])[:drawn])

    return replace(
        trace,
        band_stops=len(stops),
        band={
            name: (
                edge([stop.lowest[name] for stop in stops], np.fmin),
                edge([stop.highest[name] for stop in stops], np.fmax),
            )
            for name in first.lowest
        },
    )
