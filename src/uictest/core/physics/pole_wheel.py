"""Speed sensor with a pole wheel: what it counts, and the speed that the last whole teeth give.

An eccentric pole wheel passes its sensor too fast on one side and too slowly on the other: at x turns the
sensor has seen x + e (1 - cos 2 pi x) / (2 pi) turns, which is a relative error e sin 2 pi x of the speed, of
mean zero over a turn. A gap of missing teeth passes once per turn; the evaluation counts one tooth where
several pitches have passed.
"""

from uictest.core.physics.arithmetic import floor, fma, maximum, select, sqrt

_TWO_PI = 6.283185307179586
_QUARTER = 0.25
_SLOWEST = 1e-3
"""Rate, per s, that stands for all below it: nothing passes at a rate of zero."""


def sine_of_turns(turns: float) -> float:
    """Sine of 2 pi ``turns`` to 1e-15, by Taylor's series up to a quarter turn."""
    rest = turns - floor(turns + 0.5)
    folded = select(rest > _QUARTER, 0.5 - rest, select(rest < -_QUARTER, -0.5 - rest, rest))
    x = _TWO_PI * folded
    square = -x * x
    series = fma(square, 1.0 / (20.0 * 21.0), 1.0)
    for n in (18.0, 16.0, 14.0, 12.0, 10.0, 8.0, 6.0, 4.0, 2.0):
        series = fma(series * (1.0 / (n * (n + 1.0))), square, 1.0)
    return x * series


def passed_turns(turns: float, eccentricity: float) -> float:
    """Turns that have passed the sensor of an eccentric pole wheel."""
    return fma(eccentricity / _TWO_PI, 1.0 - sine_of_turns(turns + _QUARTER), turns)


def passing_rate(turns: float, eccentricity: float) -> float:
    """Rate at which an eccentric pole wheel passes its sensor over that of its rotation."""
    return fma(eccentricity, sine_of_turns(turns), 1.0)


def last_tooth(place: float, teeth: float, missing: float) -> tuple[float, float]:
    """Return what a sensor has counted of a pole wheel, and the place of the last tooth that it saw.

    Args:
        place: pitches that have passed, whole ones at teeth or, in the gap, where teeth are missing.
        teeth: pitches of a turn.
        missing: teeth missing in the one gap, at the end of each turn; less than ``teeth``.
    """
    pitches = floor(place)
    turn = floor(pitches / teeth)
    within = fma(-turn, teeth, pitches)
    seen = within - maximum(within - (teeth - missing - 1.0), 0.0)
    return fma(turn, teeth - missing, seen), fma(turn, teeth, seen)


def time_since(distance: float, rate: float, rate_before: float, interval: float) -> float:
    """Time in s since something passed that is ``distance`` behind, at a rate that changed evenly.

    Args:
        distance: not negative, passed within ``interval``.
        rate: present rate, in units of ``distance`` per s.
        rate_before: rate ``interval`` s ago.
        interval: s.
    """
    change = (rate - rate_before) / interval
    root = sqrt(maximum(fma(-2.0 * change, distance, rate * rate), 0.0))
    return 2.0 * distance / maximum(rate + root, _SLOWEST)


def speed_of_teeth(count: float, tooth_pitch: float, duration: float, timer_resolution: float) -> float:
    """Speed in m/s of ``count`` teeth, ``tooth_pitch`` m apart, that took ``duration`` s on a timer."""
    ticks = maximum(floor(duration / timer_resolution + 0.5), 1.0)
    return count * tooth_pitch / (ticks * timer_resolution)
