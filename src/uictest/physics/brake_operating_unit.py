"""Brake operating unit (BOU): pressure demand of the brake command and the relay valve that follows it."""

from uictest.physics.arithmetic import clamp


def demand(time: float, full_demand: float, dead_time: float, filling_rate: float) -> float:
    """Gauge pressure demanded, Pa: a ramp to ``full_demand``, of which ``filling_rate`` is added per second.

    It begins ``dead_time`` s after the command.

    A UIC distributor and an electropneumatic unit differ here only in their times (UIC 540: 3-5 s in
    positions R and P, 18-30 s in G).
    """
    return full_demand * clamp((time - dead_time) * filling_rate, 0.0, 1.0)


def relay_opening(demanded: float, pressure: float, gain: float) -> float:
    """Opening of the relay valve: 1 fully open to the reservoir, -1 fully open to atmosphere, 0 lapped.

    Proportional to the pressure still missing, fully open from 1 / ``gain`` Pa on.
    """
    return clamp((demanded - pressure) * gain, -1.0, 1.0)
