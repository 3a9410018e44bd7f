"""The magnetic track brake: magnets that the rail attracts and that rub on it.

The attraction acts between magnet and rail, so that it loads no wheel, and the force needs no adhesion of
the wheels. Friction falls with speed, mu = mu_inf (v + a)/(v + b) with a >= b. The default, 0.095
(v + 9.26 km/h)/(v + 4.63 km/h), is a formula for steel that slides on dry rails, taken for magnets by analogy
(chosen): its published constants for wet rails give more friction, so that the reading is doubtful.
"""

from uictest.core.physics.arithmetic import maximum


def track_brake_force(
    speed: float, attraction: float, friction: float, numerator: float, denominator: float, slowest: float
) -> float:
    """Force on magnets that slide over the rail, along their motion, N: negative while they move forward.

    Below the slowest speed it falls to zero with speed, so that it never moves what stands.

    Args:
        speed: of the magnets, m/s.
        attraction: of all of them together, N.
        friction: coefficient at high speed.
        numerator: a, m/s.
        denominator: b, m/s.
        slowest: speed from which it is whole, m/s.
    """
    sliding = abs(speed)
    coefficient = friction * (sliding + numerator) / (sliding + denominator)
    return 0.0 - attraction * coefficient * (speed / maximum(sliding, slowest))
