"""The few operations that differ between plain Python, compiled code and SIMD lanes.

Physics uses these instead of branches and of the C library: a lane cannot branch, and libm's ``exp``
and ``atan`` neither vectorise nor give the same bits on every machine. Both operands of :func:`select`
are always evaluated, so neither may divide by zero.
"""

import math

# Rational approximation of arctan on [0, 0.66]: S. L. Moshier, Cephes Mathematical Library, atan.c.
_P0, _P1, _P2, _P3, _P4 = (
    -8.750608600031904122785e-1,
    -1.615753718733365076637e1,
    -7.500855792314704667340e1,
    -1.228866684490136173410e2,
    -6.485021904942025371773e1,
)
_Q0, _Q1, _Q2, _Q3, _Q4 = (
    2.485846490142306297962e1,
    1.650270098316988542046e2,
    4.328810604912902668951e2,
    4.853903996359136964868e2,
    1.945506571482613964425e2,
)
_TAN_3_PI_8 = 2.414213562373095
_ARCTAN_SPLIT = 0.66
_HALF_PI = 1.5707963267948966
_QUARTER_PI = 0.7853981633974483
# Least-squares cubic for x^(-1/3) on [0.2, 2.5], where the iteration of power_two_thirds starts.
_ROOT_START_0, _ROOT_START_1, _ROOT_START_2, _ROOT_START_3 = 1.908649, -1.571604, 0.793567, -0.141773
_EXP_FLOOR = -40.0
_EXP_REDUCTION = 1.0 / 256.0


def select(condition: bool, when_true: float, when_false: float) -> float:
    """Return one of two values; both have been evaluated."""
    return when_true if condition else when_false


def minimum(a: float, b: float) -> float:
    """Return the smaller of two numbers (``b`` when they cannot be ordered)."""
    return a if a < b else b


def maximum(a: float, b: float) -> float:
    """Return the larger of two numbers (``b`` when they cannot be ordered)."""
    return a if a > b else b


def sqrt(x: float) -> float:
    """Return the square root, correctly rounded (IEEE 754), of ``x >= 0``."""
    return math.sqrt(x)


def clamp(x: float, low: float, high: float) -> float:
    """Limit ``x`` to ``[low, high]``."""
    return minimum(maximum(x, low), high)


def exp(x: float) -> float:
    """Exponential of ``x <= 0``: relative error below 1e-13 on [-40, 0]; smaller arguments count as -40.

    exp(x) = p(x / 256)^256 with p the Taylor polynomial of degree 10. Polynomials are summed in pairs: the
    processor then works on several terms at once.
    """
    t = maximum(x, _EXP_FLOOR) * _EXP_REDUCTION
    t2 = t * t
    t4 = t2 * t2
    low = (1.0 + t) + t2 * (0.5 + t * (1.0 / 6.0))
    middle = (1.0 / 24.0 + t * (1.0 / 120.0)) + t2 * (1.0 / 720.0 + t * (1.0 / 5040.0))
    high = (1.0 / 40320.0 + t * (1.0 / 362880.0)) + t2 * (1.0 / 3628800.0)
    p = low + t4 * (middle + t4 * high)
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    return p * p


def arctan(x: float) -> float:
    """Inverse tangent of ``x >= 0``: relative error below 1e-15 (Cephes)."""
    large = x > _TAN_3_PI_8
    middle = x > _ARCTAN_SPLIT
    numerator = select(large, -1.0, select(middle, x - 1.0, x))
    denominator = select(large, x, select(middle, x + 1.0, 1.0))
    base = select(large, _HALF_PI, select(middle, _QUARTER_PI, 0.0))
    t = numerator / denominator
    z = t * t
    z2 = z * z
    p = (_P4 + _P3 * z) + z2 * ((_P2 + _P1 * z) + _P0 * z2)
    q = (_Q4 + _Q3 * z) + z2 * ((_Q2 + _Q1 * z) + z2 * (_Q0 + z))
    return base + (t * (z * p / q) + t)


def power_two_thirds(x: float) -> float:
    """x^(2/3) for ``0.2 <= x <= 2.5``: relative error below 1e-12, without a division.

    Three steps of Householder's iteration for y = x^(-1/3), y <- y (14 - x y^3 (7 - 2 x y^3)) / 9; then
    x^(2/3) = x y.
    """
    y = _ROOT_START_0 + x * (_ROOT_START_1 + x * (_ROOT_START_2 + x * _ROOT_START_3))
    for _ in range(3):
        cube = x * y * y * y
        y = y * (14.0 - cube * (7.0 - 2.0 * cube)) * (1.0 / 9.0)
    return x * y
