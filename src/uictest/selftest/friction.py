"""Known answers of friction: loops of the play, creep force of wheel and rail."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

from uictest.core import physics
from uictest.selftest.check import Answer, Check
from uictest.selftest.known_stops import KnownStops

_CLEARANCE: Final = 2.9e-3
"""Of the caliper, m; chosen, like the numbers below: any other would do."""
_STROKE: Final = 3.4e-3
"""At which the width of the loop is compared, m."""
_PISTON_AREA: Final = 0.018
_PRELOAD: Final = 700.0
_SPRING: Final = 1645.0
_COULOMB: Final = 60.0
_LOAD_FRICTION: Final = 0.055
_CONTACT: Final = 8e6
_DERIVED: Final = physics.stiffnesses(_SPRING, _LOAD_FRICTION, 0.0, 0.0, _CONTACT, 5e-4)
_HALVINGS: Final = 60


def _play_loop(stops: KnownStops) -> Answer:
    """Area between two lines of the slope s, h apart, over a pressure that runs dp up and down."""
    slope, apart, highest, count = 0.1, 4e3, 4e5, 4000
    up = [highest * place / count for place in range(count + 1)]
    cycle = [*up[:-1], *reversed(up[1:])]
    first = list(_held_forces([*cycle, *cycle], slope, apart))
    closed = list(zip(cycle, first[len(cycle) :], strict=True))
    return Answer(apart * highest - apart**2 / slope, _area(closed))


def _held_forces(pressures: Sequence[float], slope: float, apart: float) -> Iterator[float]:
    force = 0.0
    for pressure in pressures:
        force = physics.force_after(force, slope * pressure, slope * pressure + apart)
        yield force


def _area(corners: Sequence[tuple[float, float]]) -> float:
    """Return the area of a polygon."""
    doubled = math.fsum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in pairwise([*corners, corners[0]]))
    return abs(doubled) / 2.0


def _caliper_loop(stops: KnownStops) -> Answer:
    """At one stroke, squeezing and releasing pressure are 2 (Fc + alpha N) / A apart."""
    load = _CONTACT * (_STROKE - _CLEARANCE)
    expected = 2.0 * (_COULOMB + _LOAD_FRICTION * load) / _PISTON_AREA
    return Answer(expected, _moving_pressure(squeezing=True) - _moving_pressure(squeezing=False))


def _moving_pressure(*, squeezing: bool) -> float:
    """Return the pressure beyond which the piston squeezes, or below which it releases, by halving, Pa."""
    low, high = 0.0, 1e6
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        stroke = physics.stroke_after(
            _STROKE, middle, _PISTON_AREA, _PRELOAD, _COULOMB, _CLEARANCE, *_DERIVED
        )
        is_beyond = stroke > _STROKE if squeezing else stroke >= _STROKE
        low, high = (low, middle) if is_beyond else (middle, high)
    return high


FRICTION_CHECKS: Final = (
    Check(
        "play-loop",
        "physics",
        "area of the closed loop of a play between two lines: h dp - h2/s",
        *(_play_loop, 1e-9, "N Pa"),
    ),
    Check(
        "caliper-loop",
        "physics",
        "width of the caliper's loop: twice the friction over the piston area",
        *(_caliper_loop, 1e-6, "Pa"),
    ),
)


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
