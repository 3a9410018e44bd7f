"""The creep force of the simulated rail, over arrays."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.core.physics import contact_stiffness, creep_force, fma, maximum, select
from uictest.plans import scenario
from uictest.rig import translate

Array = NDArray[np.float64]
# numpy has no fused multiply-add, and a fit does not need its last bit.
_FOR_ARRAYS: dict[Any, Any] = {fma: lambda a, b, c: a * b + c, maximum: np.maximum, select: np.where}


def wheelset_creep(
    slip: Array, speed: Array, load: Array, friction: Array, rail: scenario.RailCondition
) -> Array:
    """Return the force of the rail on a wheelset of two wheels, N.

    Args:
        slip: slip speed v - r omega, m/s, positive while braking.
        speed: running speed, m/s, > 0.
        load: of one wheel, N.
        friction: initial friction coefficient under the wheelset.
        rail: the other parameters of the law.

    """
    contact = rail.contact
    area = np.pi * contact.semi_axis_longitudinal * contact.semi_axis_lateral
    reference = 0.25 * contact.shear_modulus * area * contact.kalker_coefficient
    load_ratio = load / float(contact.reference_wheel_load)
    force, _ = _of_arrays(creep_force)(
        slip,
        speed,
        load,
        _of_arrays(contact_stiffness)(float(reference), load_ratio),
        friction,
        float(rail.friction_ratio),
        float(rail.friction_decay),
        float(rail.reduction_adhesion),
        float(rail.reduction_slip),
    )
    wheels = 2.0
    total: Array = wheels * force
    return total


@cache
def _of_arrays(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function of the rig's creep law with numpy's functions for its scalar ones."""
    translated: Callable[..., Any] = translate(function, lambda f: f, dict(_FOR_ARRAYS))
    return translated
