"""The measures a criterion can name, and how each is read from the records of a stop.

The catalogue of names, units and definitions is part of the criteria file format (`scenario.parts.criteria`);
here stands what each name computes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from uictest.evaluation import adhesion, slide, stopping
from uictest.evaluation.measure_value import MeasureValue, unsupported, value
from uictest.evaluation.records import StopMeasures, Wheelsets
from uictest.units import normal_volume

Definition = Mapping[str, float]
"""Definition parameter -> its SI value."""

Measure = Callable[[StopMeasures, Wheelsets, Definition], MeasureValue]


def read(name: str, measures: StopMeasures, wheelsets: Wheelsets, definition: Definition) -> MeasureValue:
    """Return what the measure `name` gives under a definition, in SI units."""
    return MEASURE_READERS[name](measures, wheelsets, definition)


def _of_stop(field: str) -> Measure:
    return lambda measures, wheelsets, definition: value(getattr(measures, field))


def _magnitude_of_stop(field: str) -> Measure:
    # A residual is as bad below zero as above it.
    return lambda measures, wheelsets, definition: value(abs(getattr(measures, field)))


def _of_wheelsets(field: str) -> Measure:
    return lambda measures, wheelsets, definition: MeasureValue(
        tuple(float(getattr(w, field)) for w in wheelsets)
    )


def _deceleration(field: str) -> Measure:
    def measure(measures: StopMeasures, wheelsets: Wheelsets, definition: Definition) -> MeasureValue:
        deceleration = getattr(measures, field)
        if math.isnan(deceleration):
            return unsupported("the brake was never fully developed while the train ran")
        return value(deceleration)

    return measure


MEASURE_READERS: dict[str, Measure] = {
    "braking_distance": lambda measures, wheelsets, definition: stopping.braking_distance(measures),
    "braking_time": lambda measures, wheelsets, definition: stopping.braking_time(measures),
    "mean_deceleration": lambda measures, wheelsets, definition: stopping.mean_deceleration(measures),
    "standstill": lambda measures, wheelsets, definition: stopping.standstill(measures),
    "initial_adhesion": lambda measures, wheelsets, definition: adhesion.initial_adhesion(
        measures, definition["first_phase_duration"]
    ),
    "minimum_deceleration": _deceleration("minimum_deceleration"),
    "maximum_deceleration": _deceleration("maximum_deceleration"),
    "reservoir_minimum_pressure": _of_stop("reservoir_minimum_pressure"),
    "air_consumed": lambda measures, wheelsets, definition: value(normal_volume(measures.air_consumed)),
    "energy_residual": _magnitude_of_stop("energy_residual"),
    "air_residual": _magnitude_of_stop("air_residual"),
    "maximum_slide_above_cutoff": lambda measures, wheelsets, definition: slide.maximum_slide_above_cutoff(
        measures, wheelsets, definition["low_speed_cutoff"]
    ),
    "locked_time": _of_wheelsets("locked_time"),
    "longest_lock": _of_wheelsets("longest_lock"),
    "sliding_duration": _of_wheelsets("sliding_duration"),
    "valve_actuations": _of_wheelsets("valve_actuations"),
    "maximum_clamping_force": _of_wheelsets("maximum_clamping_force"),
    "air_vented": lambda measures, wheelsets, definition: MeasureValue(
        tuple(normal_volume(float(wheelset.air_vented)) for wheelset in wheelsets)
    ),
}
