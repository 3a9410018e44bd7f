"""Adhesion of one wheel on a rail of which sliding has cleaned a share, by the numbers of a rail law."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from uictest.core.physics import cleaned_friction, contact_stiffness, creep_force

_SHAPE: Final = ("friction_ratio", "friction_decay", "reduction_adhesion", "reduction_slip")
Adhesion = Callable[[float, float], float]
"""F/Q at a creepage, slip speed over the speed of the train, on a rail of which a share is clean, or bare."""


def adhesion_of(rail: Any, speed: float, load: float, friction: float) -> Adhesion:
    """Return F/Q as a function of creepage and cleaned share; the rail's law says how much the share counts.

    Args:
        rail: condition of a rail that is cleaned.
        speed: of the train, m/s.
        load: of the wheel, N.
        friction: of the rail as found.
    """
    cleaning = rail.cleaning
    found, clean = (
        [float(getattr(curve, name)) for name in _SHAPE] for curve in (rail, cleaning.clean_curve or rail)
    )
    ratio = load / float(rail.contact.reference_wheel_load)
    stiffness = contact_stiffness(float(rail.contact.creep_stiffness), ratio)
    law, own, recovered = cleaning.law, cleaning.law_numbers, float(cleaning.recovered_friction)

    def adhesion(creepage: float, share: float) -> float:
        part = law.clean_part(share, own)
        curve = [a + part * (b - a) for a, b in zip(found, clean, strict=True)]
        now = cleaned_friction(friction, part, recovered)
        force, _ = creep_force(creepage * speed, speed, load, stiffness, now, *curve)
        return float(force / load)

    return adhesion
