"""WSP valve: fill, hold and vent, with a switching delay and a finite travel.

A command reaches the valve's armatures a whole delay after the controller issues it. Commands change only
with the controller's cycle, so the past is kept as a shift register of two bits per cycle.
"""

from uictest.core.physics.arithmetic import clamp

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
