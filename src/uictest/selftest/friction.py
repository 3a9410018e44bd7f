"""Known answers of the brake's friction: the loops of the play and of the caliper, and a textbook stop."""

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
