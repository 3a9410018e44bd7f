"""The smallest and the largest deceleration of the train, after a low-pass."""

from __future__ import annotations

import math

from uictest.core.measures.measure import (
    Decided,
    Measure,
    MeasureValue,
    RecordedData,
    StopColumn,
    one_value,
    unavailable,
)

_FILTERING = ("deceleration_filter", "moving_speed")


def _deceleration(extreme: float) -> MeasureValue:
    if math.isnan(extreme):
        return unavailable("the brake was never fully developed while the train ran")
    return one_value(extreme)


MEASURES = (
    Measure(
        name="minimum_deceleration",
        kind="acceleration",
        unit="m/s2",
        course="falls",
        meaning="smallest filtered deceleration under developed braking",
        read=lambda stop, wheelsets, definition: _deceleration(stop.minimum_deceleration),
        decided=Decided(how="extreme", plot="deceleration", field="minimum_deceleration", level=True),
        observed_by=(*_FILTERING, "developed_time"),
        recorded=RecordedData(("speed",), bounded=False),  # the filter has to settle first
        column=StopColumn(
            "minimum_deceleration_mps2", "m/s2", read=lambda stop, definition: stop.minimum_deceleration
        ),
    ),
    Measure(
        name="maximum_deceleration",
        kind="acceleration",
        unit="m/s2",
        course="grows",
        meaning="largest filtered deceleration while the train runs",
        read=lambda stop, wheelsets, definition: _deceleration(stop.maximum_deceleration),
        decided=Decided(how="extreme", plot="deceleration", field="maximum_deceleration", level=True),
        observed_by=_FILTERING,
        recorded=RecordedData(("speed",)),
        column=StopColumn(
            "maximum_deceleration_mps2", "m/s2", read=lambda stop, definition: stop.maximum_deceleration
        ),
    ),
)
