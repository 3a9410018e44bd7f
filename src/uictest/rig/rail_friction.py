"""Friction of the rail as it is found: along the track, over time and at random."""

import math
from itertools import pairwise
from typing import Final

from uictest.core.ensemble import Ensemble
from uictest.plans.scenario import Scenario
from uictest.rig.derived_parameters import Assignment
from uictest.rig.model.parameters import Parameters

_ALWAYS: Final = 1.0
_VARIATION_SPACING: Final = 2.0
"""Largest distance of two points at which friction is drawn, m; chosen."""
_SHARE_OF_LENGTH: Final = 0.1
"""The same as a share of the correlation length: chosen, for a variance between points 3 % lower."""

_DIGITS: Final = 12
"""Decimals that are kept: they are alike on every machine."""


def _friction(p: Parameters, scenario: Scenario) -> None:
    p.friction_points = len(friction_along_track(scenario))
    p.friction_times = len(friction_factor_over_time(scenario))


def _variation(p: Parameters, scenario: Scenario) -> None:
    """Numbers of :mod:`uictest.rig.model.random_rail`; zero where friction does not vary."""
    variation = scenario.rail.variation_in_force
    p.varies_friction = float(variation is not None)
    p.variation_points_per_metre = p.variation_persistence = 0.0
    p.variation_renewal = p.variation_log_spread = 0.0
    if variation is not None:
        length = float(variation.correlation_length)
        spacing = min(_VARIATION_SPACING, length * _SHARE_OF_LENGTH)
        persistence = round(math.exp(-spacing / length), _DIGITS)
        p.variation_points_per_metre = 1.0 / spacing
        p.variation_persistence = persistence
        p.variation_renewal = math.sqrt(1.0 - persistence**2)
        p.variation_log_spread = round(variation.log_spread, _DIGITS)


def friction_along_track(scenario: Scenario) -> list[tuple[float, float]]:
    """Return places in m and friction coefficients, linear between them; a step is two points there."""
    friction = scenario.rail.friction
    if friction is None:
        return [(0.0, scenario.rail.condition.friction)]
    if isinstance(friction, float | Ensemble):
        return [(0.0, friction)]
    points = [(float(point.position), float(point.friction)) for point in friction.points]
    if friction.interpolation == "linear":
        return points
    steps = points[:1]
    for (_, before), (place, after) in pairwise(points):
        steps += [(place, before), (place, after)]
    return steps


def friction_factor_over_time(scenario: Scenario) -> list[tuple[float, float]]:
    """Return times in s and factors of the friction, linear between them."""
    law = scenario.rail.friction_over_time
    return [(0.0, _ALWAYS)] if law is None else [(float(p.time), float(p.factor)) for p in law.points]


RAIL_FRICTION: Final = (Assignment(_friction, ("rail",)), Assignment(_variation, ("rail",)))
"""What sets the parameters of the friction of the rail as it is found."""
