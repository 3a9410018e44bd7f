"""Measures of a stop as records: one per stop and one per wheelset.

SI units; NaN where something never happened.
"""

from collections.abc import MutableSequence
from typing import Annotated

from uictest.record import Record, from_scenario

SPEED_CLASSES = 21
"""Classes of train speed, 10 km/h apart: the largest slide is kept above each of 0, 10, .. 200 km/h."""
WINDOW_SECONDS = 10
"""Whole seconds after the first sliding at which the train's speed is kept."""


class StopMeasures(Record):
    """Measures of a stop; pressures are gauge."""

    initial_speed: float  # m/s
    stopped: float  # 1 when the train came to a standstill
    braking_time: float  # from the command to standstill, s
    braking_distance: float  # from the command to standstill, m
    previous_time: float  # last sample but one, s
    previous_speed: float  # m/s
    end_time: float  # last sample, s
    end_distance: float  # m
    end_speed: float  # m/s
    minimum_deceleration: float  # filtered, brake developed, train moving, m/s2
    maximum_deceleration: float  # filtered, train moving, m/s2
    filtered_deceleration: float  # memory of the low-pass, m/s2
    sliding_time: float  # first sliding of any wheelset, s
    sliding_wheelset: float  # which one, 1..4
    speed_after_sliding: Annotated[MutableSequence[float], WINDOW_SECONDS + 1]  # at 0, 1, .. s after it, m/s
    reservoir_minimum_pressure: float  # Pa
    air_consumed: float  # taken from the reservoir, kg
    energy_residual: float  # share of the initial kinetic energy
    air_residual: float  # share of the air taken from the reservoir
    air_energy_residual: float  # share of the enthalpy of that air
    samples: float


class WheelsetMeasures(Record):
    """Measures of one wheelset; slides are shares of the train's speed."""

    slide: float  # last sample, train moving
    maximum_slide: float  # train moving
    maximum_slide_above: Annotated[MutableSequence[float], SPEED_CLASSES]  # train faster than 0, 10, .. km/h
    first_sliding_time: float  # s
    sliding_duration: float  # s
    locked_time: float  # s
    longest_lock: float  # s
    lock: float  # length of the lock that lasts at present, s
    valve_actuations: float  # openings of the vent that also closed, or last to the end
    venting: float  # 1 while the vent is commanded open
    maximum_clamping_force: float  # of one caliper, N
    air_vented: float  # kg
    maximum_disc_temperature: float  # of the friction surface, where modelled, K


class MeasureDefinition(Record):
    """How samples become measures: the ``measures`` part of a scenario."""

    # Relative slide from which a wheelset counts as sliding.
    sliding_slide: float = from_scenario("measures.sliding_slide")
    # Slip speed that it must have as well, m/s.
    sliding_slip: float = from_scenario("measures.sliding_slip")
    # Circumferential speed below which a wheelset counts as locked, m/s.
    locked_speed: float = from_scenario("measures.locked_speed")
    # Train speed above which all of these are observed, m/s.
    moving_speed: float = from_scenario("measures.moving_speed")
    # Time constant of the low-pass of the deceleration, s.
    deceleration_filter: float = from_scenario("measures.deceleration_filter")
    # Time after the command from which the smallest deceleration is kept, s.
    developed_time: float = from_scenario("measures.developed_time")
