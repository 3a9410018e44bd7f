"""Layout of the measures: one record per stop and one per wheelset.

SI units; NaN where something never happened.
"""

import numpy as np

SPEED_CLASSES = 21
"""Classes of train speed, 10 km/h apart: the largest slide is kept above each of 0, 10, .. 200 km/h."""
WINDOW_SECONDS = 10
"""Whole seconds after the first sliding at which the train's speed is kept."""

STOP_MEASURES = np.dtype(
    (
        np.record,
        [
            ("initial_speed", "f8"),  # m/s
            ("stopped", "f8"),  # 1 when the train came to a standstill
            ("braking_time", "f8"),  # from the command to standstill, s
            ("braking_distance", "f8"),  # from the command to standstill, m
            ("previous_time", "f8"),  # last sample but one, s
            ("previous_speed", "f8"),  # m/s
            ("end_time", "f8"),  # last sample, s
            ("end_distance", "f8"),  # m
            ("end_speed", "f8"),  # m/s
            ("minimum_deceleration", "f8"),  # filtered, brake developed, train moving, m/s2
            ("maximum_deceleration", "f8"),  # filtered, train moving, m/s2
            ("filtered_deceleration", "f8"),  # memory of the low-pass, m/s2
            ("sliding_time", "f8"),  # first sliding of any wheelset, s
            ("sliding_wheelset", "f8"),  # which one, 1..4
            ("speed_after_sliding", "f8", (WINDOW_SECONDS + 1,)),  # at 0, 1, .. s after it, m/s
            ("reservoir_minimum_pressure", "f8"),  # gauge, Pa
            ("air_consumed", "f8"),  # taken from the reservoir, kg
            ("energy_residual", "f8"),  # share of the initial kinetic energy
            ("air_residual", "f8"),  # share of the air that the rig held at the start
            ("samples", "f8"),
        ],
    )
)

WHEELSET_MEASURES = np.dtype(
    (
        np.record,
        [
            ("slide", "f8"),  # last sample, train moving
            ("maximum_slide", "f8"),  # train moving
            ("maximum_slide_above", "f8", (SPEED_CLASSES,)),  # train faster than 0, 10, .. km/h
            ("first_sliding_time", "f8"),  # s
            ("sliding_duration", "f8"),  # s
            ("locked_time", "f8"),  # s
            ("longest_lock", "f8"),  # s
            ("lock", "f8"),  # length of the lock that lasts at present, s
            ("valve_actuations", "f8"),  # openings of the vent that also closed, or last to the end
            ("venting", "f8"),  # 1 while the vent is commanded open
            ("maximum_clamping_force", "f8"),  # of one caliper, N
            ("air_vented", "f8"),  # kg
        ],
    )
)

DEFINITION = (
    ("sliding_slide", "f8"),  # relative slide from which a wheelset counts as sliding
    ("sliding_slip", "f8"),  # slip speed that it must have as well, m/s
    ("locked_speed", "f8"),  # circumferential speed below which a wheelset counts as locked, m/s
    ("moving_speed", "f8"),  # train speed above which all of these are observed, m/s
    ("deceleration_filter", "f8"),  # time constant of the low-pass of the deceleration, s
    ("developed_time", "f8"),  # time after the command from which the smallest deceleration is kept, s
)
"""Fields of the record that says how samples become measures: the ``measures`` part of a scenario."""
