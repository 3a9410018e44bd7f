"""Initial adhesion: the mean deceleration of the train in the first phase of sliding."""

from __future__ import annotations

import math

from uictest.evaluation.measure_value import MeasureValue, unsupported, value
from uictest.evaluation.records import SECONDS_AFTER_SLIDING, StopMeasures

DEFAULT_FIRST_PHASE = 3.0
"""s; chosen. Used for the figure of a case none of whose criteria defines its own first phase."""


def initial_adhesion(measures: StopMeasures, first_phase_duration: float) -> MeasureValue:
    """Return (v(0) - v(T)) / T in m/s2, T = `first_phase_duration` (s) counted from the first sliding.

    v is known at whole seconds after the first sliding and taken as linear between them. There is no value
    where no wheelset slid, or where the train stood or the record ended before the phase was over: the phase
    would then not be one of sliding at all.
    """
    if not math.isfinite(measures.sliding_time):
        return unsupported("no wheelset slid, so the first phase has no beginning")
    at_start = float(measures.speed_after_sliding[0])
    at_end = _speed_after(measures, first_phase_duration)
    if not (at_start > 0.0 and at_end > 0.0):
        return unsupported(
            f"the stop or its record ended within {first_phase_duration:.4g} s of the first sliding"
        )
    return value((at_start - at_end) / first_phase_duration)


def _speed_after(measures: StopMeasures, seconds: float) -> float:
    """Return the train speed (m/s) `seconds` after the first sliding; NaN where it may not be running."""
    whole = math.floor(seconds)
    if not 0 <= whole < SECONDS_AFTER_SLIDING:
        return math.nan
    before = float(measures.speed_after_sliding[whole])
    if seconds == whole:
        return before
    after = float(measures.speed_after_sliding[whole + 1]) if whole + 1 < SECONDS_AFTER_SLIDING else math.nan
    return before + (seconds - whole) * (after - before) if after > 0.0 else math.nan
