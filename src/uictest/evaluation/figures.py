"""Measures, SI, turned into the figures of the result document."""

from __future__ import annotations

import math

from uictest.evaluation.adhesion import initial_adhesion
from uictest.evaluation.reading import Reading
from uictest.evaluation.records import StopMeasures, WheelsetMeasures
from uictest.evaluation.result import Figures, WheelsetFigures, whole
from uictest.evaluation.stopping import mean_deceleration
from uictest.evaluation.units import in_unit, normal_volume


def figures_of(measures: StopMeasures, first_phase_duration: float) -> Figures:
    """Return the figures of a stop; initial adhesion over `first_phase_duration` (s)."""
    return Figures(
        braking_distance_m=float(measures.braking_distance),
        braking_time_s=float(measures.braking_time),
        mean_deceleration_mps2=_value(mean_deceleration(measures)),
        initial_adhesion_g=in_unit(_value(initial_adhesion(measures, first_phase_duration)), "g"),
        minimum_deceleration_mps2=float(measures.minimum_deceleration),
        maximum_deceleration_mps2=float(measures.maximum_deceleration),
        reservoir_minimum_bar=in_unit(float(measures.reservoir_minimum_pressure), "bar"),
        air_consumed_nl=in_unit(normal_volume(float(measures.air_consumed)), "NL"),
        energy_residual=float(measures.energy_residual),
        air_residual=float(measures.air_residual),
    )


def wheelset_figures_of(wheelset: WheelsetMeasures) -> WheelsetFigures:
    """Return the figures of one wheelset."""
    return WheelsetFigures(
        maximum_slide=float(wheelset.maximum_slide),
        locked_time_s=float(wheelset.locked_time),
        valve_actuations=whole(float(wheelset.valve_actuations)),
        maximum_clamping_force_n=float(wheelset.maximum_clamping_force),
        air_vented_nl=in_unit(normal_volume(float(wheelset.air_vented)), "NL"),
    )


def _value(reading: Reading) -> float:
    return reading.values[0] if reading.values else math.nan
