"""Braking distance and time, mean deceleration, standstill; the build-up of the brake and what follows it."""

from __future__ import annotations

import math
from dataclasses import replace

from uictest.core.measures.measure import (
    DefinitionValues,
    Measure,
    MeasureValue,
    Overview,
    RecordedData,
    ShownWhen,
    StopColumn,
    Wheelsets,
    one_value,
    unavailable,
)
from uictest.core.measures.records import StopMeasures
from uictest.core.units import STANDARD_GRAVITY

_NEVER = (
    "the pressure of the brake line never reached `developed_share` of what is commanded, or says nothing"
    " beside a dynamic brake"
)
_AT_STANDSTILL = ShownWhen(how="end", plot="speed", across="speed", along_distance=True)
_DISTANCE = RecordedData(("speed", "distance"), when="ends")
_OF_BUILD_UP = ("rising_share", "developed_share")
_SINCE_BUILD_UP = ShownWhen(
    how="span",
    plot="speed",
    field="build_up_time",
    span=lambda stop, definition: (stop.build_up_time, stop.end_time),
    span_name="developed brake",
)
_LINE_PRESSURE = RecordedData(("speed", "distance", "brake_line_pressure"), bounded=False)


def braking_distance(stop: StopMeasures) -> MeasureValue:
    """Return the distance (m) from the brake command to standstill or, before standstill, up to now.

    It is the one that was run, not corrected.
    """
    return one_value(stop.braking_distance if stop.stopped else stop.end_distance)


def corrected_distance(distance: float, stop: StopMeasures, conditions: DefinitionValues) -> float:
    """Return a distance s (m) from v as from `nominal_speed` v0 on level track; infinite if it never stops.

    The balance of energy on `gradient` i, positive uphill, at the same mean force of the brake over the
    distance: v0^2 / (2 s0) = v^2 / (2 s) - g i. Left out are rotating masses and that the build-up of the
    brake grows less than with v^2, which moves 472 m by 0.2 % within 3 km/h.
    """
    nominal, gradient = conditions["nominal_speed"], conditions["gradient"]
    of_gradient = 2.0 * STANDARD_GRAVITY * gradient * distance / stop.initial_speed**2
    if of_gradient >= 1.0:
        return math.inf
    # The factor is exactly 1 where nothing is to be corrected.
    return float(distance * ((nominal / stop.initial_speed) ** 2 / (1.0 - of_gradient)))


def _corrected_braking_distance(
    stop: StopMeasures, wheelsets: Wheelsets, conditions: DefinitionValues
) -> MeasureValue:
    (distance,) = braking_distance(stop).values
    return one_value(corrected_distance(distance, stop, conditions))


def braking_time(stop: StopMeasures) -> MeasureValue:
    """Return the time (s) from the brake command to standstill or, before standstill, up to now."""
    return one_value(stop.braking_time if stop.stopped else stop.end_time)


def mean_deceleration(stop: StopMeasures) -> MeasureValue:
    """Return v0^2 / (2 s) in m/s2, s the braking distance (up to now) from the initial speed v0."""
    (distance,) = braking_distance(stop).values
    return one_value(constant_deceleration(stop.initial_speed, distance))


def constant_deceleration(speed: float, distance: float) -> float:
    """Return the deceleration (m/s2) that stops a train from a speed (m/s) within a distance (m)."""
    return speed**2 / (2.0 * distance) if distance else math.inf


def standstill(stop: StopMeasures) -> MeasureValue:
    """Return 1 where the train came to a standstill."""
    return one_value(1.0) if stop.stopped else unavailable("no standstill")


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


_NO_REFERENCE = RecordedData(("friction of the rail",), when="never", computed=True)
NO_REFERENCE = "no reference distance"  # how a reason begins
_WITHOUT_REFERENCE = (
    f"{NO_REFERENCE}: it is that of a simulated car alone, without faults and sand, stopped by the adhesion"
    " of its wheels"
)


def distance_over_reference(stop: StopMeasures) -> MeasureValue:
    """Return the braking distance (up to now) over the reference distance."""
    (distance,) = braking_distance(stop).values
    value = _over_reference(distance, stop)
    return unavailable(_WITHOUT_REFERENCE) if math.isnan(value) else one_value(value)


def _over_reference(distance: float, stop: StopMeasures) -> float:
    return distance / stop.reference_distance if 0.0 < stop.reference_distance < math.inf else math.nan


MEASURES = (
    Measure(
        name="uncorrected_braking_distance",
        kind="length",
        course="grows",
        better="smaller",
        meaning="distance from the brake command to standstill, as it was run",
        of_standstill=True,
        field="braking_distance",
        read=lambda stop, wheelsets, definition: braking_distance(stop),
        decided=_AT_STANDSTILL,
        recorded=_DISTANCE,
        column=StopColumn("braking_distance_m", "m", overview=Overview("distance\nm", digits=1, rank=0)),
    ),
    Measure(
        name="braking_distance",
        kind="length",
        course="grows",
        better="smaller",
        meaning="distance from the brake command to standstill, corrected to nominal speed and level track",
        of_standstill=True,
        corrected=("nominal_speed", "gradient"),
        read=_corrected_braking_distance,
        decided=_AT_STANDSTILL,
        recorded=_DISTANCE,
        column=StopColumn(
            "corrected_distance_m",
            "m",
            overview=Overview("corrected\nm", digits=1, rank=3, unlike="braking_distance_m"),
            read=lambda stop, definition: corrected_distance(stop.braking_distance, stop, definition),
        ),
    ),
    Measure(
        name="braking_time",
        kind="time",
        course="grows",
        better="smaller",
        meaning="time from the brake command to standstill",
        of_standstill=True,
        read=lambda stop, wheelsets, definition: braking_time(stop),
        decided=ShownWhen(how="end", plot="speed", across="speed"),
        recorded=RecordedData(("speed",), when="ends"),
        column=StopColumn("braking_time_s", "s", overview=Overview("time\ns", digits=1, rank=6)),
    ),
    Measure(
        name="mean_deceleration",
        kind="acceleration",
        course="falls",
        better="larger",
        meaning="v0^2 / (2 s), s the uncorrected braking distance from v0",
        of_standstill=True,
        read=lambda stop, wheelsets, definition: mean_deceleration(stop),
        decided=ShownWhen(how="span", plot="deceleration", level=True, word="mean"),
        recorded=RecordedData(("speed", "distance"), when="ends", bounded=False),
        column=StopColumn(
            "mean_deceleration_mps2",
            "m/s2",
            overview=Overview("mean decel.\nm/s²", digits=3, rank=5, short="mean\nm/s2", few_digits=2),
            read=lambda stop, definition: mean_deceleration(stop).values[0] if stop.stopped else math.nan,
        ),
    ),
    Measure(
        name="standstill",
        kind="number",
        course="settles",
        better="larger",
        meaning="1 where the train came to a standstill",
        of_standstill=True,
        read=lambda stop, wheelsets, definition: standstill(stop),
        decided=ShownWhen(how="end", plot="speed", word="the record ends at"),
        recorded=RecordedData(("speed",), when="end", from_command=False),
    ),
    Measure(
        name="build_up_time",
        kind="time",
        course="settles",
        better="smaller",
        meaning="equivalent build-up time T_react + T_increase / 2 of the brake-line pressure, which begins"
        " to rise T_react after the brake command and has built up T_increase later",
        absent=_NEVER,
        decided=ShownWhen(
            how="span",
            plot="pressure",
            field="build_up_time",
            span=lambda stop, definition: (stop.rise_time, 2.0 * stop.build_up_time - stop.rise_time),
            across="pressure",
        ),
        observed_by=_OF_BUILD_UP,
        recorded=RecordedData(("brake_line_pressure",), bounded=False),
        column=StopColumn("build_up_time_s", "s"),
    ),
    Measure(
        name="deceleration_distance",
        kind="length",
        course="grows",
        better="smaller",
        meaning="uncorrected braking distance less the distance run until the equivalent build-up time",
        of_standstill=True,
        read=lambda stop, wheelsets, definition: deceleration_distance(stop),
        decided=_SINCE_BUILD_UP,
        observed_by=_OF_BUILD_UP,
        recorded=_LINE_PRESSURE,
        column=StopColumn(
            "deceleration_distance_m",
            "m",
            read=lambda stop, definition: stop.braking_distance - stop.build_up_distance,
        ),
    ),
    Measure(
        name="developed_deceleration",
        kind="acceleration",
        course="falls",
        better="larger",
        meaning="v0^2 / (2 s), s the deceleration distance",
        of_standstill=True,
        read=lambda stop, wheelsets, definition: developed_deceleration(stop),
        decided=replace(_SINCE_BUILD_UP, plot="deceleration", level=True, word="mean"),
        observed_by=_OF_BUILD_UP,
        recorded=_LINE_PRESSURE,
        column=StopColumn(
            "developed_deceleration_mps2",
            "m/s2",
            read=lambda stop, definition: constant_deceleration(
                stop.initial_speed, stop.braking_distance - stop.build_up_distance
            ),
        ),
    ),
    Measure(
        name="reference_distance",
        kind="length",
        course="settles",
        meaning="shortest distance at any slide up to 40 % that all wheelsets keep on the same rail",
        of_standstill=True,
        absent=_WITHOUT_REFERENCE,
        recorded=_NO_REFERENCE,
        column=StopColumn("reference_distance_m", "m", overview=Overview("reference\nm", digits=1, rank=4)),
    ),
    Measure(
        name="distance_over_reference",
        kind="number",
        course="grows",
        better="smaller",
        meaning="uncorrected braking distance over the reference distance",
        of_standstill=True,
        read=lambda stop, wheelsets, definition: distance_over_reference(stop),
        decided=ShownWhen(how="end", plot="speed"),
        recorded=_NO_REFERENCE,
        column=StopColumn(
            "distance_over_reference",
            "1",
            read=lambda stop, definition: _over_reference(stop.braking_distance, stop),
        ),
    ),
)
