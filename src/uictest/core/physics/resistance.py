"""Running resistance and gradient."""

from uictest.core.physics.arithmetic import fma, select


def running_resistance(speed: float, constant: float, linear: float, quadratic: float) -> float:
    """Force against the motion, N: R = a + b v + c v^2 (Davis), none at standstill; ``speed`` in m/s."""
    size = abs(speed)
    direction = select(speed > 0.0, 1.0, select(speed < 0.0, -1.0, 0.0))
    return direction * fma(fma(quadratic, size, linear), size, constant)


def gradient_force(mass: float, gradient: float, gravity: float) -> float:
    """Force in N on ``mass`` kg against the motion uphill; gradient as height over length, small."""
    return mass * gravity * gradient
