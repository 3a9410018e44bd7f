"""Equivalent build-up time of the brake; the distance from then on, and the deceleration it stands for."""

from __future__ import annotations

import math
from dataclasses import replace

from uictest.core.measures.catalogue.stopping import braking_distance, constant_deceleration
from uictest.core.measures.measure import (
    Decided,
    Measure,
    MeasureValue,
    RecordedData,
    StopColumn,
    one_value,
    unavailable,
)
from uictest.core.measures.records import StopMeasures

_NEVER = "the pressure of the brake line never reached `developed_share` of what is commanded"
_OBSERVED_BY = ("rising_share", "developed_share")
_SINCE_BUILD_UP = Decided(
    how="span",
    plot="speed",
    field="build_up_time",
    span=lambda stop, definition: (stop.build_up_time, stop.end_time),
    span_name="developed brake",
)
_RECORDED = RecordedData(("speed", "distance", "brake_line_pressure"), bounded=False)


def build_up_time(stop: StopMeasures) -> MeasureValue:
    """Return the equivalent build-up time in s, from the brake command."""
    return unavailable(_NEVER) if math.isnan(stop.build_up_time) else one_value(stop.build_up_time)


def deceleration_distance(stop: StopMeasures) -> MeasureValue:
    """Return the distance (m) from the equivalent build-up time to standstill or, before it, up to now."""
    if math.isnan(stop.build_up_time):
        return unavailable(_NEVER)
    (distance,) = braking_distance(stop).values
    return one_value(distance - stop.build_up_distance)


def developed_deceleration(stop: StopMeasures) -> MeasureValue:
    """Return v0^2 / (2 s) in m/s2, s the deceleration distance (up to now), v0 the initial speed."""
    if math.isnan(stop.build_up_time):
        return unavailable(_NEVER)
    (distance,) = deceleration_distance(stop).values
    return one_value(constant_deceleration(stop.initial_speed, distance))


def _final_deceleration_distance(stop: StopMeasures) -> float:
    return stop.braking_distance - stop.build_up_distance


MEASURES = (
    Measure(
        name="build_up_time",
        kind="time",
        unit="s",
        course="settles",
        meaning="equivalent build-up time T_react + T_increase / 2 of the brake-line pressure, which begins"
        " to rise T_react after the brake command and has built up T_increase later",
        read=lambda stop, wheelsets, definition: build_up_time(stop),
        decided=Decided(
            how="span",
            plot="pressure",
            field="build_up_time",
            span=lambda stop, definition: (stop.rise_time, 2.0 * stop.build_up_time - stop.rise_time),
            across="pressure",
        ),
        observed_by=_OBSERVED_BY,
        recorded=RecordedData(("brake_line_pressure",), bounded=False),
        column=StopColumn("build_up_time_s", "s", read=lambda stop, definition: stop.build_up_time),
    ),
    Measure(
        name="deceleration_distance",
        kind="length",
        unit="m",
        course="grows",
        meaning="braking distance less the distance run until the equivalent build-up time",
        read=lambda stop, wheelsets, definition: deceleration_distance(stop),
        decided=_SINCE_BUILD_UP,
        observed_by=_OBSERVED_BY,
        recorded=_RECORDED,
        column=StopColumn(
            "deceleration_distance_m",
            "m",
            read=lambda stop, definition: _final_deceleration_distance(stop),
        ),
    ),
    Measure(
        name="developed_deceleration",
        kind="acceleration",
        unit="m/s2",
        course="falls",
        meaning="v0^2 / (2 s), s the deceleration distance",
        read=lambda stop, wheelsets, definition: developed_deceleration(stop),
        decided=replace(_SINCE_BUILD_UP, plot="deceleration", level=True, word="mean"),
        observed_by=_OBSERVED_BY,
        recorded=_RECORDED,
        column=StopColumn(
            "developed_deceleration_mps2",
            "m/s2",
            read=lambda stop, definition: constant_deceleration(
                stop.initial_speed, _final_deceleration_distance(stop)
            ),
        ),
    ),
)
