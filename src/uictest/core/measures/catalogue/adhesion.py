"""Initial adhesion: the mean deceleration of the train in the first phase of sliding."""

from __future__ import annotations

import math
from typing import Final

from uictest.core.measures.measure import (
    Decided,
    Measure,
    MeasureValue,
    Overview,
    RecordedData,
    StopColumn,
    one_value,
    unavailable,
)
from uictest.core.measures.records import StopMeasures

_DEFAULT_FIRST_PHASE: Final = 3.0
"""s; chosen. Used for the column of a case none of whose criteria defines its own first phase."""


def initial_adhesion(stop: StopMeasures, first_phase_duration: float) -> MeasureValue:
    """Return (v(0) - v(T)) / T in m/s2, T = `first_phase_duration` (s) counted from the first sliding.

    v is known at whole seconds after the first sliding and taken as linear between them. There is no value
    where no wheelset slid, or where the train stood or the record ended before the phase was over: the phase
    would then not be one of sliding at all.
    """
    if not math.isfinite(stop.sliding_time):
        return unavailable("no wheelset slid, so the first phase has no beginning")
    at_start = float(stop.speed_after_sliding[0])
    at_end = _speed_after(stop, first_phase_duration)
    if not (at_start > 0.0 and at_end > 0.0):
        return unavailable(
            f"the stop or its record ended within {first_phase_duration:.4g} s of the first sliding"
        )
    return one_value((at_start - at_end) / first_phase_duration)


def _speed_after(stop: StopMeasures, seconds: float) -> float:
    """Return the train speed (m/s) `seconds` after the first sliding; NaN where it may not be running."""
    whole, known = math.floor(seconds), len(stop.speed_after_sliding)
    if not 0 <= whole < known:
        return math.nan
    before = float(stop.speed_after_sliding[whole])
    if seconds == whole:
        return before
    after = float(stop.speed_after_sliding[whole + 1]) if whole + 1 < known else math.nan
    return before + (seconds - whole) * (after - before) if after > 0.0 else math.nan


def _or_nan(adhesion: MeasureValue) -> float:
    return adhesion.values[0] if adhesion.values else math.nan


MEASURES = (
    Measure(
        name="initial_adhesion",
        kind="acceleration",
        unit="g",
        course="settles",
        meaning="mean deceleration of the train over the first phase, counted from the first sliding of any"
        " wheelset",
        read=lambda stop, wheelsets, definition: initial_adhesion(stop, definition["first_phase_duration"]),
        decided=Decided(
            how="span",
            plot="deceleration",
            span=lambda stop, definition: (
                stop.sliding_time,
                stop.sliding_time + definition["first_phase_duration"],
            ),
            level=True,
            word="mean",
            span_name="first phase",
        ),
        definitions=("first_phase_duration",),
        observed_by=("sliding_slide", "sliding_slip", "moving_speed"),
        recorded=RecordedData(("speed", "wheel_speed_{n}"), bounded=False),
        column=StopColumn(
            "initial_adhesion_g",
            "g",
            meaning="initial adhesion by the first phase of the first criterion that defines one, else 3 s",
            overview=Overview("initial adhesion\ng", digits=4, rank=7, short="adhesion\ng", few_digits=3),
            read=lambda stop, definition: _or_nan(initial_adhesion(stop, definition["first_phase_duration"])),
            defaults={"first_phase_duration": _DEFAULT_FIRST_PHASE},
        ),
    ),
)
