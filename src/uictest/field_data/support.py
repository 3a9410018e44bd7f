"""What a record lacks of each measure, and why."""

from __future__ import annotations

from collections.abc import Iterator
from types import MappingProxyType
from typing import Final

import numpy as np

from uictest.evaluation import Coverage, MissingData
from uictest.field_data.channels import WHEELSETS, of_wheelsets
from uictest.field_data.recorded_stop import RecordedStop
from uictest.field_data.time_axis import is_coarse
from uictest.recording import TIME

Channels = tuple[str, ...]


def _per_wheelset(*names: str) -> tuple[Channels, ...]:
    return tuple(tuple(name.format(n=n) for name in names) for n in WHEELSETS)


_WHEEL: Final = _per_wheelset("speed", "wheel_speed_{n}")

_THROUGHOUT: Final = MappingProxyType(
    {
        "initial_adhesion": (("speed", *of_wheelsets("wheel_speed")),),
        "minimum_deceleration": (("speed",),),
        "maximum_deceleration": (("speed",),),
        "reservoir_minimum_pressure": (("reservoir_pressure",),),
        "maximum_slide_above_cutoff": _WHEEL,
        "locked_time": _WHEEL,
        "longest_lock": _WHEEL,
        "sliding_duration": _WHEEL,
        "valve_actuations": _per_wheelset("valve_command_{n}"),
        "maximum_clamping_force": _per_wheelset("clamping_force_{n}"),
    }
)
"""Measure -> for each of its values the channels that must be known throughout the stop."""

_AT_THE_ENDS: Final = MappingProxyType(
    {
        "braking_distance": (("speed", "distance"),),
        "mean_deceleration": (("speed", "distance"),),
        "braking_time": (("speed",),),
        "standstill": (("speed",),),
    }
)
"""Measure -> for its value the channels that must be known at the brake command and at standstill."""

_NO_FLOW: Final = MissingData("not recorded: flow of air", bounded=False)
_NEVER: Final = MappingProxyType({"air_consumed": (_NO_FLOW,), "air_vented": (_NO_FLOW,) * len(WHEELSETS)})

_ALL_OR_NOTHING: Final = frozenset({"initial_adhesion", "mean_deceleration", "minimum_deceleration"})
"""Measures whose value a part of the samples does not bound.

The first two count from a moment that may not be in the record, and the filter of the third has to settle.
"""
_LATE: Final = "the record begins after the brake command"


def coverage_of(stop: RecordedStop) -> Coverage:
    """Return what a record lacks of each measure between brake command and its end."""
    missing = {
        measure: tuple(_missing(stop, measure, channels) for channels in values)
        for measure, values in (*_THROUGHOUT.items(), *_AT_THE_ENDS.items())
    }
    lacking = {measure: gaps for measure, gaps in missing.items() if any(gaps)}
    return Coverage({**_NEVER, **lacking}, f"{_LATE}: no initial speed" if stop.trigger.late else "")


def _missing(stop: RecordedStop, measure: str, channels: Channels) -> MissingData | None:
    if unusable := list(_unusable(stop, measure, channels)):
        return MissingData("; ".join(unusable), bounded=False)
    if gaps := dict.fromkeys(_gaps(stop, measure, channels)):
        return MissingData("; ".join(gaps), bounded=measure not in _ALL_OR_NOTHING)
    return None


def measures_of(channel: str) -> tuple[str, ...]:
    """Return the measures that need a channel; none need `distance`, which the speed gives, too."""
    if channel == "distance":
        return ()
    needs = {**_THROUGHOUT, **_AT_THE_ENDS}
    return tuple(measure for measure, values in needs.items() if any(channel in value for value in values))


def _unusable(stop: RecordedStop, measure: str, channels: Channels) -> Iterator[str]:
    """Yield why a value cannot even be bounded; all wheelsets that lack a channel are named together."""
    recorded = stop.recording.channels
    if any(name not in recorded for name in channels):
        needed = dict.fromkeys(name for value in _needed(measure) for name in value)
        yield f"not recorded: {', '.join(name for name in needed if name not in recorded)}"
    for defect in stop.defects:
        if defect.spoils and defect.channel in channels:
            yield str(defect)


def _needed(measure: str) -> tuple[Channels, ...]:
    return _THROUGHOUT[measure] if measure in _THROUGHOUT else _AT_THE_ENDS[measure]


def _gaps(stop: RecordedStop, measure: str, channels: Channels) -> Iterator[str]:
    if stop.trigger.late and measure != "standstill":
        yield _LATE
    for name in channels:
        yield from _unknown(stop, name, throughout=measure in _THROUGHOUT)
        interval = stop.intervals.get(name, 0.0)
        if measure in _THROUGHOUT and is_coarse(interval):
            yield f"samples are {interval:.6g} s apart"


def _unknown(stop: RecordedStop, name: str, *, throughout: bool) -> Iterator[str]:
    unknown = ~np.isfinite(stop.recording[name])
    time = stop.recording[TIME]
    if throughout and unknown.any():
        first, last = time[unknown][[0, -1]]
        yield f"{name} is not known from {first:.6g} to {last:.6g} s after the brake command"
    elif name == "distance" and (
        unknown[0] or (stop.standstill is not None and not np.isfinite(stop.standstill[1]))
    ):
        yield (
            "the distance is not known: the speed it is integrated from has a gap"
            if not unknown[0]
            else ("distance is not known at the brake command")
        )
