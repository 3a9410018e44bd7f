"""Records of stops and wheelsets, each with a sound default and what a test changes."""

import numpy as np

from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES

KMH = 1 / 3.6
G = 9.80665
REACHED = np.array([24.0, 22.0, 20.0, 18.0, 17.0, 16.0, 12.0, 8.0, 6.0, 4.0])
"""s: when the train runs at 10, 20, .. 100 km/h; at 60 km/h after 16 s."""


def slow_times(share):
    """Times of so much of the 16 s down to 60 km/h, all above 100 km/h, below every share of its speed."""
    return np.concatenate([np.zeros(27), np.full(3, 16.0 * share)])


def _record(dtype, fields):
    records = np.zeros(1, dtype=dtype).view(np.recarray)
    for name, value in fields.items():
        records[name][0] = value
    return records[0]


def stop(**changes):
    """A sound dry stop from 120 km/h within 465 m, in which no wheelset slid."""
    sound = {
        "initial_speed": 120 * KMH,
        "stopped": 1.0,
        "braking_time": 28.0,
        "braking_distance": 465.0,
        "end_time": 28.0,
        "end_distance": 465.0,
        "minimum_deceleration": 1.1,
        "maximum_deceleration": 1.4,
        "reached_time": REACHED,
        "sliding_time": np.nan,
        "speed_after_sliding": np.nan,
        "reservoir_minimum_pressure": 7.2e5,
        "reservoir_margin": 3.4e5,
        "reference_distance": 450.0,
        "build_up_time": 0.5,
        "build_up_distance": 16.7,
        "adhesion_utilisation": np.nan,
        "deceleration_bogie_1": 0.6,
        "deceleration_bogie_2": 0.59,
        "air_consumed": 0.1185,
        "energy_residual": 2e-8,
        "air_residual": -3e-14,
        "air_energy_residual": 2e-13,
    }
    return _record(STOP_MEASURES, {**sound, **changes})


def sliding_stop(deceleration=0.07 * G, share=0.75, **changes):
    """A stop in which a wheelset slides after a second, from when on the train decelerates evenly (m/s2).

    Half of the wheelsets slide at once in a `share` of the time until 60 km/h.
    """
    speed = 33.0 - deceleration * np.arange(11.0)
    slid = {
        "half_slow_time": slow_times(share),
        "sliding_time": 1.0,
        "speed_after_sliding": speed,
        "adhesion_utilisation": 0.8,
        "has_diagnosis": 1.0,
    }
    return stop(**{**slid, **changes})


def wheelsets(*slides, **changes):
    """One wheelset per slide, the same above every train speed; those above 10 % slide 75 % of the time."""
    records = np.zeros(len(slides), dtype=WHEELSET_MEASURES).view(np.recarray)
    for record, slide in zip(records, slides, strict=True):
        record.maximum_slide = slide
        record.maximum_slide_above[:] = slide
        record.slow_time[:] = slow_times(0.75 if slide > 0.1 else 0.0)
    for name, value in changes.items():
        records[name] = value
    return records
