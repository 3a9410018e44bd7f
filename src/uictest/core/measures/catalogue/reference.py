"""The braking distance beside what the rail would have allowed: the reference distance."""

from __future__ import annotations

import math

from uictest.core.measures.catalogue.stopping import braking_distance
from uictest.core.measures.measure import (
    Measure,
    MeasureValue,
    Overview,
    RecordedData,
    ShownWhen,
    StopColumn,
    one_value,
    unavailable,
)
from uictest.core.measures.records import StopMeasures

_NO_REFERENCE = RecordedData(("friction of the rail",), when="never", computed=True)
NO_REFERENCE = "no reference distance"  # how a reason begins
_WITHOUT_REFERENCE = (
    f"{NO_REFERENCE}: it is that of a simulated car alone, without faults and sand, stopped by the adhesion"
    " of its wheels"
)


def distance_over_reference(stop: StopMeasures) -> MeasureValue:
    """Return the braking distance (up to now) over the reference distance."""
    (distance,) = braking_distance(stop).values
    return _of_reference(_over_reference(distance, stop))


def _over_reference(distance: float, stop: StopMeasures) -> float:
    return distance / stop.reference_distance if 0.0 < stop.reference_distance < math.inf else math.nan


def _of_reference(value: float) -> MeasureValue:
    return unavailable(_WITHOUT_REFERENCE) if math.isnan(value) else one_value(value)


MEASURES = (
    Measure(
        name="reference_distance",
        kind="length",
        unit="m",
        course="settles",
        meaning="shortest distance at any slide up to 40 % that all wheelsets keep on the same rail",
        of_standstill=True,
        read=lambda stop, wheelsets, definition: _of_reference(stop.reference_distance),
        recorded=_NO_REFERENCE,
        column=StopColumn(
            "reference_distance_m",
            "m",
            overview=Overview("reference\nm", digits=1, rank=4),
            read=lambda stop, definition: stop.reference_distance,
        ),
    ),
    Measure(
        name="distance_over_reference",
        kind="number",
        unit="1",
        course="grows",
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
