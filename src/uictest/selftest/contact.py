"""Known answers of wheel and rail: Polach's creep force in closed form and as published."""

import math
from typing import Final

from uictest.core import physics
from uictest.selftest.check import Answer, Check

_WHEEL_LOAD: Final = 55e3
"""N; chosen, like the numbers below: any other would do."""
_STIFFNESS: Final = 1e7
"""Of the contact, N."""
_SPEED: Final = 20.0
"""m/s."""
_FRICTION: Final = 0.3


def _share_of_limit(gradient: float, adhesion: float, slip: float) -> float:
    """Return the creep force over the friction limit, which does not fall with the slip speed here.

    Args:
        gradient: eps of the tangential stress.
        adhesion: kA.
        slip: kS.
    """
    limit = _WHEEL_LOAD * _FRICTION
    slip_speed = gradient * limit / _STIFFNESS * _SPEED
    law = _FRICTION, 1.0, 0.0, adhesion, slip
    force, _ = physics.creep_force(slip_speed, _SPEED, _WHEEL_LOAD, _STIFFNESS, *law)
    return force / limit


CONTACT_CHECKS: Final = (
    Check(
        "creep-without-reduction",
        "physics",
        "creep force over Q mu at eps = 1, kA = kS = 1: 1/pi + 1/2",
        *(lambda stops: Answer(1.0 / math.pi + 0.5, _share_of_limit(1.0, 1.0, 1.0)), 1e-12, "1"),
    ),
    Check(
        "creep-on-wet-rail",
        "physics",
        "the same at eps = 4.467 with the factors of a wet rail (Polach 2005): 0.573",
        *(lambda stops: Answer(0.573, _share_of_limit(4.467, 0.3, 0.1)), 1e-3, "1"),
    ),
    Check(
        "highest-creep",
        "physics",
        "the same while everything slides: the friction limit",
        *(lambda stops: Answer(1.0, _share_of_limit(1e9, 1.0, 1.0)), 1e-8, "1"),
    ),
)
