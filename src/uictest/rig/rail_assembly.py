"""Parameters of the rail: friction along the track, over time and at random, cleaning, creep curves, sand.

Each function that sets parameters is given what its arguments name (:mod:`uictest.rig.assembly`).
"""

import math
from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.physics import FITTED_TERMS, MOST_SAND_POINTS, contact_stiffness, highest_creep_force
from uictest.core.rail_laws import LAWS, MOST_NUMBERS
from uictest.plans.scenario import WHEELSET_NUMBERS, CreepCurve, Rail, RailCondition, Sander, Vehicle
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import MARGIN, POINTS
from uictest.rig.model.running_gear import HIGHEST_LOAD, LOWEST_LOAD

_ALWAYS: Final = 1.0
_VARIATION_SPACING: Final = 2.0
"""Largest distance of two points at which friction is drawn, m; chosen."""
_SHARE_OF_LENGTH: Final = 0.1
"""The same as a share of the correlation length: chosen, for a variance between points 3 % lower."""
_DIGITS: Final = 12
"""Decimals of numbers from `exp` that are kept: they are alike on every machine."""


def friction_along_track(rail: Rail) -> list[tuple[float, float]]:
    """Return positions in m and friction coefficients, linear between them; a step is two points there."""
    friction: Any = rail.friction
    if friction is None:
        return [(0.0, rail.condition.friction)]
    if not hasattr(friction, "points"):  # a number, maybe of several cases
        return [(0.0, friction)]
    points = [(float(point.position), float(point.friction)) for point in friction.points]
    if friction.interpolation == "linear":
        return points
    steps = points[:1]
    for (_, before), (position, after) in pairwise(points):
        steps += [(position, before), (position, after)]
    return steps


def friction_factor_over_time(rail: Rail) -> list[tuple[float, float]]:
    """Return times in s and factors of the friction, linear between them."""
    law = rail.friction_over_time
    return [(0.0, _ALWAYS)] if law is None else [(float(p.time), float(p.factor)) for p in law.points]


def set_friction(p: Parameters, rail: Rail) -> None:
    """Set the lengths of the friction laws, and how friction varies at random: zero where it does not."""
    p.friction_points = len(friction_along_track(rail))
    p.friction_times = len(friction_factor_over_time(rail))
    over_speed = rail.friction_over_speed_in_force
    p.friction_speed_numerator = 1.0 if over_speed is None else float(over_speed.numerator)
    p.friction_speed_denominator = 1.0 if over_speed is None else float(over_speed.denominator)
    p.friction_speed_scale = 1.0 if over_speed is None else over_speed.scale
    variation = rail.variation_in_force
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


def set_cleaning(p: Parameters, rail: Rail, vehicle: Vehicle) -> None:
    """Set the numbers of :mod:`uictest.core.physics.rail`; zero where nothing is cleaned."""
    cleaning = rail.cleaning_in_force
    p.rail_points_per_metre = (POINTS - MARGIN) / _largest_gap(vehicle)
    p.cleans_rail = float(cleaning is not None)
    p.rail_law = 0 if cleaning is None else list(LAWS).index(cleaning.law.name)
    numbers = () if cleaning is None else cleaning.law_numbers
    p.law_numbers = [*numbers, *[0.0] * (MOST_NUMBERS - len(numbers))]
    p.cleaning_response = 0.0 if cleaning is None else cleaning.response
    p.cleaning_decay = 0.0 if cleaning is None else 1.0 / cleaning.reach
    p.recovered_friction = 0.0 if cleaning is None else cleaning.recovered_friction
    p.carry_over = 0.0 if cleaning is None else cleaning.carry_over
    p.spent_share = 0.0 if cleaning is None else round(cleaning.spent_share, _DIGITS)


def _largest_gap(vehicle: Vehicle) -> float:
    """Return the largest distance between two neighbouring wheelsets of a car, m."""
    wheelbase = 2.0 * vehicle.bogie.half_wheelbase
    return max(wheelbase, 2.0 * vehicle.half_pivot_distance - wheelbase)


def set_creep_curves(p: Parameters, rail: Rail) -> None:
    """Set the contact, the creep curve of a clean rail, and the largest forces of both curves."""
    found, cleaning = rail.condition, rail.cleaning_in_force
    clean = found if cleaning is None or cleaning.clean_curve is None else cleaning.clean_curve
    p.creep_stiffness = found.contact.creep_stiffness
    for name in ("friction_ratio", "friction_decay", "reduction_adhesion", "reduction_slip"):
        setattr(p, f"clean_{name}", getattr(clean, name))
    for prefix, curve in (("", found), ("clean_", clean)):
        scale, coefficients = highest_creep_law(curve)
        setattr(p, f"{prefix}highest_creep_scale", scale)
        for power, coefficient in enumerate(coefficients):
            setattr(p, f"{prefix}highest_creep_{power}", coefficient)


_GAIN_OF_SPEED: Final = 1.5
"""Largest speed over the initial one for which the rings have room; chosen: no braked train gains so much."""


def sand_grid(largest_gap: float, initial_speed: float, cycle_time: float) -> float:
    """Return the points per metre of a grid whose rings hold a gap and what is run in a controller cycle.

    Args:
        largest_gap: between two wheelsets, m.
        initial_speed: m/s.
        cycle_time: s.
    """
    return (POINTS - 2 * MARGIN) / (largest_gap + _GAIN_OF_SPEED * initial_speed * cycle_time)


def set_sanders(p: Parameters, sanders: Sequence[Sander], cycle_time: float) -> None:
    """Set what each sander lays and when; zero where there is none."""
    of_wheelset = {sander.wheelset: sander for sander in sanders}
    cycle = float(cycle_time)

    def table(of: Callable[[Sander], float]) -> list[float]:
        return [of(of_wheelset[number]) if number in of_wheelset else 0.0 for number in WHEELSET_NUMBERS]

    p.has_sanders = float(bool(of_wheelset))
    p.sander_rates = table(lambda sander: sander.largest_rate)
    p.sander_densities = table(lambda sander: math.inf if sander.density is None else float(sander.density))
    p.sander_distances = table(lambda sander: float(sander.distance))
    p.sander_delays = table(lambda sander: round(sander.delay / cycle))
    p.sander_off_speeds = table(lambda sander: float(sander.off_below))
    p.sanders_always = table(lambda sander: float(sander.when == "always"))
    p.sanders_on_slide = table(lambda sander: float(sander.when == "sliding"))
    p.sanders_on_request = table(lambda sander: float(sander.when == "requested"))
    p.sander_slide_cycles = table(lambda sander: round(sander.sliding_time / cycle))
    p.sander_run_on_cycles = table(lambda sander: round(sander.run_on / cycle))


def set_sand(
    p: Parameters,
    sanders: Sequence[Sander],
    rail: Rail,
    vehicle: Vehicle,
    initial_speed: float,
    cycle_time: float,
) -> None:
    """Set what sand does on the rail; zero without sanders."""
    points = rail.sand.points if sanders else ()
    blank = [0.0] * (MOST_SAND_POINTS - len(points))
    p.sand_points = len(points)
    p.sand_densities = [*(float(point.density) for point in points), *blank]
    p.sand_shares = [*(float(point.share) for point in points), *blank]
    p.sand_friction = p.sand_kept = p.sand_points_per_metre = 0.0
    if points:
        p.sand_friction, p.sand_kept = float(rail.sand.friction), float(rail.sand.kept)
        gap = float(_largest_gap(vehicle))
        p.sand_points_per_metre = sand_grid(gap, float(initial_speed), float(cycle_time))


RAIL: Final = (set_friction, set_cleaning, set_creep_curves, set_sanders, set_sand)
"""What sets parameters of the rail and of sand on it."""


_SLIPS: Final = np.geomspace(1e-5, 60.0, 800)
"""Values of x = B w among which the maximum is sought; it is flat, so that steps of 2 % suffice."""
_FALL: Final = np.exp(-_SLIPS)
_WIDEST: Final = 3.0
"""Largest u1; that of a fast train on dry rail is 0.8."""
_NARROWEST: Final = 1e-3
_NEAR: Final = 1.005
"""Share of A to which the maximum has fallen at u1."""
_LOWEST: Final = 0.25
"""Or this share of mu0, where A is smaller: a polynomial does not follow so deep a fall."""
_HALVINGS: Final = 12
_NODES: Final = FITTED_TERMS + 4
_DIGITS_OF_FIT: Final = 9
"""Decimals that are kept: they are alike on every machine."""


def highest_creep_law(condition: RailCondition | CreepCurve) -> tuple[float, tuple[float, ...]]:
    """Return the scale B / u1^2 in s/m and the coefficients, lowest power first."""
    law = condition.friction_ratio, condition.reduction_adhesion, condition.reduction_slip
    end, *coefficients = _fitted_coefficients(*map(float, law))
    return condition.friction_decay / end**2, tuple(coefficients)


def highest_creep_forces(
    condition: RailCondition,
    speed: NDArray[np.float64],
    wheel_load: NDArray[np.float64],
    friction: NDArray[np.float64],
    curve: CreepCurve | None = None,
) -> NDArray[np.float64]:
    """Return the largest creep force of one wheel in N at each sample, NaN where something is not known.

    Args:
        condition: of the rail; its friction coefficient does not count.
        speed: of the train, m/s.
        wheel_load: of one wheel, N.
        friction: initial friction coefficient under it.
        curve: shape of the creep curve [default: the condition's].
    """
    scale, coefficients = highest_creep_law(curve or condition)
    stiffness, reference = condition.contact.creep_stiffness, float(condition.contact.reference_wheel_load)
    least, most = LOWEST_LOAD * reference, HIGHEST_LOAD
    highest = np.full(speed.shape, np.nan)
    for k in np.flatnonzero(np.isfinite(speed * wheel_load * friction) & (speed >= 0.0)):
        load = max(float(wheel_load[k]), least)
        stiff = contact_stiffness(stiffness, min(load / reference, most))
        highest[k] = highest_creep_force(
            float(speed[k]), load, float(friction[k]), stiff, scale, *coefficients
        )
    return highest


@cache
def _fitted_coefficients(ratio: float, reduction_adhesion: float, reduction_slip: float) -> tuple[float, ...]:
    """Return u1, then the coefficients.

    Args:
        ratio: A.
        reduction_adhesion: kA.
        reduction_slip: kS.
    """
    law = (ratio, reduction_adhesion, reduction_slip)
    end = round(_end_of_fit(*law), _DIGITS_OF_FIT)
    shares = 0.5 - 0.5 * np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
    highest = highest_shares(end * shares, *law)
    fitted = np.polynomial.Chebyshev.fit(shares, highest, FITTED_TERMS - 1, domain=[0.0, 1.0])
    powers = _powers_of_terms() @ np.asarray(fitted.coef, float)
    return end, *(round(float(power), _DIGITS_OF_FIT) for power in powers)


@cache
def _powers_of_terms() -> NDArray[np.float64]:
    """Return the coefficients of each Chebyshev term on 0 to 1, lowest power first, as columns."""
    terms = (np.polynomial.Chebyshev.basis(term, domain=[0.0, 1.0]) for term in range(FITTED_TERMS))
    powers = (term.convert(kind=np.polynomial.Polynomial).coef for term in terms)
    return np.array([np.pad(each, (0, FITTED_TERMS - each.size)) for each in powers]).T


def highest_shares(
    u: NDArray[np.float64], ratio: float, reduction_adhesion: float, reduction_slip: float
) -> NDArray[np.float64]:
    """Return the maximum of F / (Q mu0) for each u > 0."""
    falling = (1.0 - ratio) * _FALL + ratio
    gradient = _SLIPS / falling / np.square(u)[:, None]
    adhering = reduction_adhesion * gradient
    curve = falling * (adhering / (1.0 + adhering**2) + np.arctan(reduction_slip * gradient))
    highest: NDArray[np.float64] = 2.0 / np.pi * curve.max(axis=1)
    return highest


def _end_of_fit(ratio: float, reduction_adhesion: float, reduction_slip: float) -> float:
    low, high = _NARROWEST, _WIDEST
    for _ in range(_HALVINGS):
        middle = (low * high) ** 0.5
        (share,) = highest_shares(np.array([middle]), ratio, reduction_adhesion, reduction_slip)
        low, high = (middle, high) if share > max(_NEAR * ratio, _LOWEST) else (low, middle)
    return low
