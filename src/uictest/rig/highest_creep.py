"""The largest creep force on a rail condition, and the cylinder at another sampling time."""

import math
from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.ensemble import case_by_case
from uictest.core.physics import FITTED_TERMS, contact_stiffness, highest_creep_force
from uictest.plans.scenario import CreepCurve, RailCondition
from uictest.rig.model.running_gear import LOWEST_LOAD
from uictest.rig.model.slip_search import HIGHEST_LOAD

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
_DIGITS: Final = 9
"""Decimals that are kept: they are alike on every machine."""


def highest_creep_law(condition: RailCondition | CreepCurve) -> tuple[float, tuple[float, ...]]:
    """Return the scale B / u1^2 in s/m and the coefficients, lowest power first."""
    law = condition.friction_ratio, condition.reduction_adhesion, condition.reduction_slip
    end, *coefficients = case_by_case(_fitted, *law)
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
def _fitted(ratio: float, reduction_adhesion: float, reduction_slip: float) -> tuple[float, ...]:
    """Return u1, then the coefficients.

    Args:
        ratio: A.
        reduction_adhesion: kA.
        reduction_slip: kS.
    """
    law = (ratio, reduction_adhesion, reduction_slip)
    end = round(_end(*law), _DIGITS)
    shares = 0.5 - 0.5 * np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
    highest = highest_shares(end * shares, *law)
    fitted = np.polynomial.Chebyshev.fit(shares, highest, FITTED_TERMS - 1, domain=[0.0, 1.0])
    powers = _powers_of_terms() @ np.asarray(fitted.coef, float)
    return end, *(round(float(power), _DIGITS) for power in powers)


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


def _end(ratio: float, reduction_adhesion: float, reduction_slip: float) -> float:
    """Return u1: halve the interval of its logarithm."""
    low, high = _NARROWEST, _WIDEST
    for _ in range(_HALVINGS):
        middle = (low * high) ** 0.5
        (share,) = highest_shares(np.array([middle]), ratio, reduction_adhesion, reduction_slip)
        low, high = (middle, high) if share > max(_NEAR * ratio, _LOWEST) else (low, middle)
    return low


def resampled_transfer_function(
    numerator: list[float], denominator: list[float], sampling_time: float, step: float
) -> tuple[list[float], list[float]]:
    """Coefficients that give at ``step`` the response of those given at ``sampling_time`` (both s).

    The held input that the model assumes is kept: the state matrix is taken to a fractional power and
    the input matrix follows from the same steady state. At the sampling time itself the coefficients
    are returned as they are.
    """
    if abs(step - sampling_time) < 1e-12 * sampling_time:
        return numerator, denominator
    # Scipy's `tf2ss` and `ss2tf` give the same bits; loading them takes as long as a hundred stops.
    from scipy.linalg import fractional_matrix_power

    order, through = len(denominator), numerator[0]
    identity = np.eye(order)
    a = np.vstack([np.negative(denominator), np.eye(order - 1, order)])
    b, c = identity[:, :1], np.array(numerator[1:]) - through * np.array(denominator)
    faster = np.real(fractional_matrix_power(a, step / sampling_time))
    held = (faster - identity) @ np.linalg.solve(a - identity, b)
    a_new = np.poly(faster)
    b_new = np.poly(faster - held * c) + (through - 1.0) * a_new
    return _unity_gain([float(x) for x in b_new], [float(x) for x in a_new[1:]])


def _unity_gain(numerator: list[float], denominator: list[float]) -> tuple[list[float], list[float]]:
    """Make the gain at rest one again: rounding the last digits of the coefficients changes it."""
    rest = math.fsum([1.0, *denominator])
    return [math.fsum([rest, *(-b for b in numerator[1:])]), *numerator[1:]], denominator
