"""How far and how long the wheelsets slide."""

from __future__ import annotations

from typing import Final

from uictest.measures.measure import (
    Measure,
    MeasureValue,
    RecordedData,
    WheelsetColumn,
    Wheelsets,
    is_nan,
    plain,
    unavailable,
    value_per_wheelset,
)
from uictest.measures.records import StopMeasures
from uictest.units import KILOMETRE_PER_HOUR

SLIDE_CLASS: Final = 10.0 * KILOMETRE_PER_HOUR
"""m/s: `maximum_slide_above[k]` counts while the train runs faster than k of these (10 km/h each)."""

_WHEEL_SPEEDS = RecordedData(("speed", "wheel_speed_{n}"))


def maximum_slide_above_cutoff(
    stop: StopMeasures, wheelsets: Wheelsets, low_speed_cutoff: float
) -> MeasureValue:
    """Return the largest slide (share; 1 = locked) of each wheelset above the cut-off.

    Slides count while the train runs faster than `low_speed_cutoff` (m/s), a multiple of 10 km/h, as the
    measures keep one value per such class. There is no value for a train that never ran faster.
    """
    k = round(low_speed_cutoff / SLIDE_CLASS)
    slides = tuple(plain(wheelset.maximum_slide_above[k]) for wheelset in wheelsets)
    if not stop.initial_speed > low_speed_cutoff or all(map(is_nan, slides)):
        return unavailable(f"the train never ran faster than the cut-off of {10 * k} km/h")
    return MeasureValue(slides)


MEASURES = (
    Measure(
        name="maximum_slide_above_cutoff",
        kind="share",
        unit="%",
        course="grows",
        meaning="largest slide (v - r omega)/v while the train runs faster than the low-speed cut-off",
        read=lambda stop, wheelsets, definition: maximum_slide_above_cutoff(
            stop, wheelsets, definition["low_speed_cutoff"]
        ),
        of_wheelsets=True,
        definitions=("low_speed_cutoff",),
        observed_by=("moving_speed",),
        recorded=_WHEEL_SPEEDS,
        column=WheelsetColumn(
            "maximum_slide",
            "1",
            meaning="largest slide (v - r omega)/v as a share, 1 where locked, at all speeds above"
            " `moving_speed`: criteria bound the largest above their own cut-off,"
            " `maximum_slide_above_cutoff`",
            read=lambda wheelset: wheelset.maximum_slide,
        ),
        finite_field="maximum_slide",
    ),
    Measure(
        name="sliding_duration",
        kind="time",
        unit="s",
        course="grows",
        meaning="time the wheelset slides in all",
        read=lambda stop, wheelsets, definition: value_per_wheelset(w.sliding_duration for w in wheelsets),
        of_wheelsets=True,
        observed_by=("sliding_slide", "sliding_slip", "moving_speed"),
        recorded=_WHEEL_SPEEDS,
        column=WheelsetColumn("sliding_time_s", "s", read=lambda wheelset: wheelset.sliding_duration),
        finite_field="sliding_duration",
    ),
)
