"""Adhesion utilisation: the work of the rail over what it could have done while it limited the brake."""

from __future__ import annotations

import math

from uictest.core.measures.measure import (
    Decided,
    Measure,
    MeasureValue,
    RecordedData,
    StopColumn,
    WheelsetColumn,
    Wheelsets,
    one_value,
    unavailable,
    value_per_wheelset,
)
from uictest.core.measures.records import StopMeasures

_OBSERVED_BY = ("sliding_slide", "sliding_slip", "moving_speed", "reduced_share")
_LIMITED_BY_RAIL = Decided(how="intervals", plot="sliding", field="exploited_work")
_CONTACTS = RecordedData(
    (
        *("speed", "wheel_speed_{n}", "adhesion_{n}", "friction_{n}", "wheel_load_{n}"),
        *("tank_pressure_{n}", "brake_line_pressure"),
    ),
    bounded=False,
)


def of_train(stop: StopMeasures) -> MeasureValue:
    """Return the share of a stop that ended at standstill."""
    return _why_none(stop) or one_value(stop.adhesion_utilisation)


def of_each_wheelset(stop: StopMeasures, wheelsets: Wheelsets) -> MeasureValue:
    """Return the share of each wheelset; what never slid left nothing unused and has 1."""
    shares = (wheelset.adhesion_utilisation for wheelset in wheelsets)
    return _why_none(stop) or value_per_wheelset(1.0 if math.isnan(share) else share for share in shares)


def _why_none(stop: StopMeasures) -> MeasureValue | None:
    if not stop.stopped:
        return unavailable("no standstill")
    if math.isnan(stop.adhesion_utilisation):
        return unavailable("no wheelset slid, so that the rail never limited the brake")
    return None


MEASURES = (
    Measure(
        name="adhesion_utilisation",
        kind="share",
        unit="%",
        course="settles",
        meaning="work of the rail on the wheelsets over that at the maximum of their creep curves, of each"
        " while it slides or, once it has slid, its WSP holds its pressure down",
        read=lambda stop, wheelsets, definition: of_train(stop),
        decided=_LIMITED_BY_RAIL,
        observed_by=_OBSERVED_BY,
        recorded=_CONTACTS,
        column=StopColumn(
            "adhesion_utilisation",
            "1",
            meaning="adhesion utilisation of the train as a share",
            read=lambda stop, definition: stop.adhesion_utilisation if stop.stopped else math.nan,
        ),
    ),
    Measure(
        name="wheelset_adhesion_utilisation",
        kind="share",
        unit="%",
        course="settles",
        meaning="adhesion utilisation of the wheelset; 100 % if it never slid where another one did",
        read=lambda stop, wheelsets, definition: of_each_wheelset(stop, wheelsets),
        decided=_LIMITED_BY_RAIL,
        of_wheelsets=True,
        observed_by=_OBSERVED_BY,
        recorded=_CONTACTS,
        column=WheelsetColumn(
            "adhesion_utilisation",
            "1",
            meaning="adhesion utilisation of the wheelset as a share, none if it never slid",
            read=lambda wheelset: wheelset.adhesion_utilisation,
        ),
    ),
)
