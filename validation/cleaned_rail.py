"""Adhesion of one wheel on a rail of which sliding has cleaned a share, by the numbers of a rail law."""

from __future__ import annotations

from typing import Any, Final

from uictest.core.physics import cleaned_friction, contact_stiffness, creep_force

_SHAPE: Final = ("friction_ratio", "friction_decay", "reduction_adhesion", "reduction_slip")


def adhesion(rail: Any, creepage: float, speed: float, load: float, friction: float, share: float) -> float:
    """Return F/Q.

    Args:
        rail: condition of a rail that is cleaned.
        creepage: slip speed over the speed of the train.
        speed: of the train, m/s.
        load: of the wheel, N.
        friction: of the rail as found.
        share: of it that is clean, or bare; its law says how much that counts.
    """
    contact, cleaning = rail.contact, rail.cleaning
    clean, part = cleaning.clean_curve or rail, cleaning.clean_part(share)
    curve = [getattr(rail, name) + part * (getattr(clean, name) - getattr(rail, name)) for name in _SHAPE]
    stiffness = contact_stiffness(contact.creep_stiffness, load / contact.reference_wheel_load)
    now = cleaned_friction(friction, part, cleaning.recovered_friction)
    force, _ = creep_force(creepage * speed, speed, load, stiffness, now, *curve)
    return float(force / load)
