"""Measures, SI, turned into the figures of the result document."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from uictest.evaluation.adhesion import initial_adhesion
from uictest.evaluation.coverage import Coverage
from uictest.evaluation.measure_value import MeasureValue
from uictest.evaluation.records import StopMeasures, WheelsetMeasures
from uictest.evaluation.result import CaseMeasures, CaseWheelsetMeasures, whole
from uictest.evaluation.stopping import mean_deceleration
from uictest.units import in_unit, normal_volume


def figures_of(measures: StopMeasures, first_phase_duration: float) -> CaseMeasures:
    """Return the figures of a stop; initial adhesion over `first_phase_duration` (s)."""
    return CaseMeasures(
        braking_distance_m=float(measures.braking_distance),
        braking_time_s=float(measures.braking_time),
        mean_deceleration_mps2=_value(mean_deceleration(measures)) if measures.stopped else math.nan,
        initial_adhesion_g=in_unit(_value(initial_adhesion(measures, first_phase_duration)), "g"),
        minimum_deceleration_mps2=float(measures.minimum_deceleration),
        maximum_deceleration_mps2=float(measures.maximum_deceleration),
        reservoir_minimum_bar=in_unit(float(measures.reservoir_minimum_pressure), "bar"),
        air_consumed_nl=in_unit(normal_volume(float(measures.air_consumed)), "NL"),
        energy_residual=float(measures.energy_residual),
        air_residual=float(measures.air_residual),
    )


def wheelset_figures_of(wheelset: WheelsetMeasures) -> CaseWheelsetMeasures:
    """Return the figures of one wheelset."""
    return CaseWheelsetMeasures(
        maximum_slide=float(wheelset.maximum_slide),
        locked_time_s=float(wheelset.locked_time),
        valve_actuations=whole(float(wheelset.valve_actuations)),
        maximum_clamping_force_n=float(wheelset.maximum_clamping_force),
        air_vented_nl=in_unit(normal_volume(float(wheelset.air_vented)), "NL"),
    )


# Measure -> the figure that needs the same data.
_FIGURE_OF = {
    "braking_distance": "braking_distance_m",
    "braking_time": "braking_time_s",
    "mean_deceleration": "mean_deceleration_mps2",
    "initial_adhesion": "initial_adhesion_g",
    "minimum_deceleration": "minimum_deceleration_mps2",
    "maximum_deceleration": "maximum_deceleration_mps2",
    "reservoir_minimum_pressure": "reservoir_minimum_bar",
    "air_consumed": "air_consumed_nl",
}
_WHEELSET_FIGURE_OF = {
    "maximum_slide_above_cutoff": "maximum_slide",
    "locked_time": "locked_time_s",
    "valve_actuations": "valve_actuations",
    "maximum_clamping_force": "maximum_clamping_force_n",
    "air_vented": "air_vented_nl",
}


def known_figures(figures: CaseMeasures, coverage: Coverage) -> CaseMeasures:
    """Return the figures of a recorded stop, NaN where the record lacks data of one."""
    return replace(figures, **_unknown(_FIGURE_OF, coverage))


def known_wheelset_figures(figures: CaseWheelsetMeasures, coverage: Coverage) -> CaseWheelsetMeasures:
    """Return the figures of a wheelset, NaN where the record lacks data of one of any wheelset."""
    return replace(figures, **_unknown(_WHEELSET_FIGURE_OF, coverage))


def _unknown(figure_of: Mapping[str, str], coverage: Coverage) -> dict[str, Any]:
    return {figure: math.nan for measure, figure in figure_of.items() if measure in coverage.missing}


def _value(reading: MeasureValue) -> float:
    return reading.values[0] if reading.values else math.nan
