"""Brake operating unit (BOU): pressure demand of the brake command and the relay valve that follows it."""

from uictest.core.physics.arithmetic import clamp


def demanded_pressure(time: float, commanded_pressure: float, dead_time: float, filling_rate: float) -> float:
    """Return the gauge pressure demanded at a time after the command, Pa.

    It is a ramp to ``commanded_pressure`` that begins after ``dead_time`` s; ``filling_rate`` is the share of
    that pressure added per second.

    A UIC distributor and an electropneumatic unit differ here only in their times (UIC 540: 3-5 s in
    positions R and P, 18-30 s in G).
    """
    return commanded_pressure * clamp((time - dead_time) * filling_rate, 0.0, 1.0)


def relay_opening(demanded_pressure: float, pressure: float, gain: float) -> float:
    """Opening of the relay valve: 1 fully open to the reservoir, -1 fully open to atmosphere, 0 lapped.

    Proportional to the pressure still missing, fully open from 1 / ``gain`` Pa on.
    """
    return clamp((demanded_pressure - pressure) * gain, -1.0, 1.0)
