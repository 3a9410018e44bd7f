"""Valves of the brake: the relay valve of the brake operating unit (BOU), and the WSP valve.

A command reaches the armatures of the WSP valve a whole delay after the controller issues it. Commands change
only with the controller's cycle, so the past is kept as a shift register of two bits per cycle.
"""

from uictest.core.physics.arithmetic import clamp

MOST_COMMANDS = 16
"""Brake commands of one stop; chosen: far more than drivers give."""


def demanded_pressure(time: float, start: float, change: float, begins: float, rate: float) -> float:
    """Return the gauge pressure demanded at a time, Pa.

    It is a ramp by ``change`` Pa from ``start`` Pa that begins at ``begins`` s, a dead time after the
    command; ``rate`` is the share of the change that comes per second.

    A UIC distributor and an electropneumatic unit differ here only in their times (UIC 540: 3-5 s in
    positions R and P, 18-30 s in G).
    """
    return start + change * clamp((time - begins) * rate, 0.0, 1.0)


def relay_opening(demanded_pressure: float, pressure: float, gain: float) -> float:
    """Opening of the relay valve: 1 fully open to the reservoir, -1 fully open to atmosphere, 0 lapped.

    Proportional to the pressure still missing, fully open from 1 / ``gain`` Pa on.
    """
    return clamp((demanded_pressure - pressure) * gain, -1.0, 1.0)


FILL = 0
"""Command: brake line connected to the tank (increase the brake force)."""
HOLD = 1
"""Command: tank closed (hold the brake force)."""
VENT = 2
"""Command: tank connected to the atmosphere (reduce the brake force)."""

LONGEST_DELAY_CYCLES = 24
"""Controller cycles that the register remembers, besides the newest command."""
_REGISTER_MASK = (1 << 2 * (LONGEST_DELAY_CYCLES + 2)) - 1


def remember(register: int, command: int) -> int:
    """Shift the newest command into the register."""
    return ((register << 2) | command) & _REGISTER_MASK


def command_before(register: int, cycles: int) -> int:
    """Return the command issued ``cycles`` controller cycles before the newest one."""
    return (register >> (2 * cycles)) & 3


def travel(opening: float, target: float, largest_change: float) -> float:
    """Opening (0 closed, 1 open) after one step towards ``target``, at most ``largest_change`` away."""
    return opening + clamp(target - opening, -largest_change, largest_change)
