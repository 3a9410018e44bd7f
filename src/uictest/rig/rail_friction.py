"""The rail: friction as it is found along the track, over time and at random; how sliding cleans it."""

import math
from itertools import pairwise
from typing import Final

from uictest.core.ensemble import Ensemble
from uictest.core.rail_laws import LAWS, MOST_NUMBERS
from uictest.plans.scenario import Scenario
from uictest.rig.derived_parameters import Assignment
from uictest.rig.highest_creep import highest_creep_law
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import MARGIN, POINTS

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


def _cleaning(p: Parameters, scenario: Scenario) -> None:
    """Numbers of :mod:`uictest.core.physics.rail`; zero where nothing is cleaned."""
    cleaning = scenario.rail.cleaning_in_force
    wheelbase = 2.0 * scenario.vehicle.bogie.half_wheelbase
    largest = max(wheelbase, 2.0 * scenario.vehicle.half_pivot_distance - wheelbase)
    p.rail_points_per_metre = (POINTS - MARGIN) / largest
    p.cleans_rail = float(cleaning is not None)
    p.rail_law = 0 if cleaning is None else list(LAWS).index(cleaning.law.name)
    numbers = () if cleaning is None else cleaning.law_numbers
    p.law_numbers = [*numbers, *[0.0] * (MOST_NUMBERS - len(numbers))]
    p.cleaning_response = 0.0 if cleaning is None else cleaning.response
    p.cleaning_decay = 0.0 if cleaning is None else 1.0 / cleaning.reach
    p.recovered_friction = 0.0 if cleaning is None else cleaning.recovered_friction
    p.carry_over = 0.0 if cleaning is None else cleaning.carry_over
    p.spent_share = 0.0 if cleaning is None else round(cleaning.spent_share, _DIGITS)


def _creep_curves(p: Parameters, scenario: Scenario) -> None:
    """Numbers of :mod:`uictest.core.physics.polach` for a clean rail, and of both for the largest force."""
    found, cleaning = scenario.rail.condition, scenario.rail.cleaning_in_force
    clean = found if cleaning is None or cleaning.clean_curve is None else cleaning.clean_curve
    for name in ("friction_ratio", "friction_decay", "reduction_adhesion", "reduction_slip"):
        setattr(p, f"clean_{name}", getattr(clean, name))
    for prefix, curve in (("", found), ("clean_", clean)):
        scale, coefficients = highest_creep_law(curve)
        setattr(p, f"{prefix}highest_creep_scale", scale)
        for power, coefficient in enumerate(coefficients):
            setattr(p, f"{prefix}highest_creep_{power}", coefficient)


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


RAIL: Final = (
    Assignment(_friction, ("rail",)),
    Assignment(_variation, ("rail",)),
    Assignment(_cleaning, ("rail", "vehicle.bogie", "vehicle.half_pivot_distance")),
    Assignment(_creep_curves, ("rail",)),
)
"""What sets the parameters of the rail that follow from several values."""
