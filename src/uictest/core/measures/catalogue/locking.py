"""How long the wheelsets are locked."""

from __future__ import annotations

from uictest.core.measures.measure import (
    Decided,
    Measure,
    Overview,
    RecordedData,
    WheelsetColumn,
    value_per_wheelset,
)

_OBSERVED_BY = ("locked_speed", "moving_speed")
_WHEEL_SPEEDS = RecordedData(("speed", "wheel_speed_{n}"))

MEASURES = (
    Measure(
        name="locked_time",
        kind="time",
        unit="s",
        course="grows",
        meaning="time the wheelset is locked in all",
        read=lambda stop, wheelsets, definition: value_per_wheelset(w.locked_time for w in wheelsets),
        decided=Decided(how="intervals", plot="locked", field="locked_time"),
        of_wheelsets=True,
        observed_by=_OBSERVED_BY,
        recorded=_WHEEL_SPEEDS,
        column=WheelsetColumn(
            "locked_time_s",
            "s",
            overview=Overview("locked\nmax s", digits=1, rank=9),
            read=lambda wheelset: wheelset.locked_time,
        ),
        finite_field="locked_time",
    ),
    Measure(
        name="longest_lock",
        kind="time",
        unit="s",
        course="grows",
        meaning="longest time the wheelset is locked at a stretch",
        read=lambda stop, wheelsets, definition: value_per_wheelset(w.longest_lock for w in wheelsets),
        decided=Decided(how="longest", plot="locked", field="lock"),
        of_wheelsets=True,
        observed_by=_OBSERVED_BY,
        recorded=_WHEEL_SPEEDS,
        finite_field="longest_lock",
    ),
)
