"""Pressure sensors, loadcells and toothed-wheel speed sensors."""

from uictest.core.physics.arithmetic import clamp, floor, fma, maximum, select

_ROUNDING = 6755399441055744.0
"""1.5 x 2^52: adding and subtracting it rounds a number below 2^51 to the nearest whole one."""


def analogue_reading(
    value: float,
    gain_error: float,
    offset: float,
    noise: float,
    measuring_range: float,
    resolution: float,
    steps_per_unit: float,
) -> float:
    """Reading of a pressure sensor or loadcell in the unit of ``value``, limited to 0 .. ``measuring_range``.

    Args:
        value: true value.
        gain_error: share by which the sensitivity is off.
        offset: reading at zero, in the unit of ``value``.
        noise: momentary error, in the unit of ``value``.
        measuring_range: largest reading.
        resolution: step of the converter, in the unit of ``value``.
        steps_per_unit: its inverse.
    """
    limited = clamp(fma(value, 1.0 + gain_error, offset + noise), 0.0, measuring_range)
    return rounded_to_whole(limited * steps_per_unit) * resolution


def beyond_range(
    value: float, gain_error: float, offset: float, noise: float, measuring_range: float
) -> float:
    """1 where an analogue sensor would read more than its range and is limited to it, else 0."""
    return select(fma(value, 1.0 + gain_error, offset + noise) > measuring_range, 1.0, 0.0)


def rounded_to_whole(x: float) -> float:
    """Nearest whole number, ties to even, of a number below 2^51 in size."""
    return (x + _ROUNDING) - _ROUNDING


def speed_reading(
    circumferential_speed: float,
    tooth_pitch: float,
    timer_resolution: float,
    cycle_time: float,
    slowest: float,
    noise: float,
) -> float:
    """Circumferential speed in m/s as a toothed wheel and a timer measure it once per controller cycle.

    The time of the whole teeth that pass in a cycle (at least one) is counted in ticks of the timer.
    Below ``slowest`` the next tooth does not come before the time-out and the reading is zero.

    Args:
        circumferential_speed: true speed r omega, m/s.
        tooth_pitch: distance at the tread between two teeth, m.
        timer_resolution: one tick of the timer, s.
        cycle_time: cycle of the controller, s.
        slowest: lowest speed that can be measured, m/s, > 0.
        noise: relative error of this reading (tooth pitch, tread, jitter).
    """
    measurable = maximum(circumferential_speed, slowest)
    teeth = maximum(floor(measurable * cycle_time / tooth_pitch), 1.0)
    distance = teeth * tooth_pitch
    ticks = maximum(floor(distance / measurable / timer_resolution + 0.5), 1.0)
    reading = distance / (ticks * timer_resolution) * (1.0 + noise)
    return select(circumferential_speed < slowest, 0.0, reading)
