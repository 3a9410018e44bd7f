"""Sensors of pressure, force and speed, and their reproducible noise.

A toothed wheel is seen once per controller cycle (:func:`speed_reading`). A pole wheel is counted tooth by
tooth; the speed is that of the last whole teeth. An eccentric one passes its sensor too fast on one side and
too slowly on the other: at x turns the sensor has seen x + e (1 - cos 2 pi x) / (2 pi) turns, which is a
relative error e sin 2 pi x of the speed, of mean zero over a turn. A gap of missing teeth passes once per
turn; the evaluation counts one tooth where several pitches have passed.

The noise comes from a counter-based generator, so that no draw depends on how work was split. Threefry-2x32
with 20 rounds: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC'11 (2011). The key is the
seed and the case, the counter the sample and the channel.
"""

from uictest.core.physics.arithmetic import clamp, floor, fma, maximum, select, sqrt

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


def last_tooth(passed: float, teeth: float, missing: float) -> tuple[float, float]:
    """Return what a sensor has counted of a pole wheel, and the place of the last tooth that it saw.

    Args:
        passed: pitches that have passed, whole ones at teeth or, in the gap, where teeth are missing.
        teeth: pitches of a turn.
        missing: teeth missing in the one gap, at the end of each turn; less than ``teeth``.
    """
    pitches = floor(passed)
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


_MASK = 0xFFFFFFFF
_PARITY = 0x1BD11BDA
_HALF_WORD = 0xFFFF
_SCALE = 1.0 / 65536.0
_UNIT_VARIANCE = 1.7320508075688772


def threefry(key_0: int, key_1: int, counter_0: int, counter_1: int) -> tuple[int, int]:
    """Two 32-bit words of random bits for a key and a counter of two 32-bit words each."""
    key_2 = _PARITY ^ key_0 ^ key_1
    x = (counter_0 + key_0) & _MASK
    y = (counter_1 + key_1) & _MASK
    x, y = _four_rounds(x, y, 13, 15, 26, 6)
    x, y = (x + key_1) & _MASK, (y + key_2 + 1) & _MASK
    x, y = _four_rounds(x, y, 17, 29, 16, 24)
    x, y = (x + key_2) & _MASK, (y + key_0 + 2) & _MASK
    x, y = _four_rounds(x, y, 13, 15, 26, 6)
    x, y = (x + key_0) & _MASK, (y + key_1 + 3) & _MASK
    x, y = _four_rounds(x, y, 17, 29, 16, 24)
    x, y = (x + key_1) & _MASK, (y + key_2 + 4) & _MASK
    x, y = _four_rounds(x, y, 13, 15, 26, 6)
    return (x + key_2) & _MASK, (y + key_0 + 5) & _MASK


def _four_rounds(x: int, y: int, r0: int, r1: int, r2: int, r3: int) -> tuple[int, int]:
    x, y = _round(x, y, r0)
    x, y = _round(x, y, r1)
    x, y = _round(x, y, r2)
    return _round(x, y, r3)


def _round(x: int, y: int, rotation: int) -> tuple[int, int]:
    x = x + y  # its upper bits are dropped with the next key
    return x, (((y << rotation) | (y >> (32 - rotation))) ^ x) & _MASK


def uniform(words: tuple[int, int]) -> float:
    """Number between 0 and 1 from the first of two words of random bits."""
    return (words[0] + 0.5) * (_SCALE * _SCALE)


def bell(word_0: int, word_1: int) -> float:
    """Bell-shaped number of mean 0 and variance 1, within +-3.47: the scaled sum of four uniform numbers.

    Bounded, as a sensor's noise is, and free of logarithms.
    """
    total = (word_0 & _HALF_WORD) + (word_0 >> 16) + (word_1 & _HALF_WORD) + (word_1 >> 16)
    return ((total + 2.0) * _SCALE - 2.0) * _UNIT_VARIANCE
