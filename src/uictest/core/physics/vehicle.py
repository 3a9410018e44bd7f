"""Planar vehicle: seventeen degrees of freedom.

Car body and two bogies move longitudinally, vertically and in pitch; four wheelsets move longitudinally
and turn on a rigid rail. Coordinates are displacements from running at rest on level track: x forward,
z up, pitch positive nose up. The point at distance L ahead of and height h above a centre of gravity
moves by (x - h pitch, z + L pitch).
"""

from uictest.core.physics.arithmetic import fma


def longitudinal(position: float, pitch: float, height: float) -> float:
    """Longitudinal displacement (or speed) of a point ``height`` m above the centre of gravity."""
    return fma(-height, pitch, position)


def vertical(position: float, pitch: float, ahead: float) -> float:
    """Vertical displacement (or speed) of a point ``ahead`` m in front of the centre of gravity."""
    return fma(ahead, pitch, position)


def suspension_force(stiffness: float, damping: float, deflection: float, rate: float) -> float:
    """Force of a spring and a damper side by side, N, in the direction of the deflection."""
    return fma(stiffness, deflection, damping * rate)


def spring_energy(stiffness: float, deflection: float) -> float:
    """Energy stored in a spring, J."""
    return 0.5 * stiffness * deflection * deflection


def kinetic_energy(inertia: float, speed: float) -> float:
    """Kinetic energy of a mass (or a moment of inertia) at a speed (or a rate), J."""
    return 0.5 * inertia * speed * speed
