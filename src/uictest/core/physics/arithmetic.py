"""The few operations that differ between plain Python, compiled code and SIMD lanes.

Physics uses these instead of branches and of the C library: a lane cannot branch, and libm's ``exp``
and ``atan`` neither vectorise nor give the same bits on every machine. Both operands of :func:`select`
are always evaluated, so neither may divide by zero.
"""

import math
from typing import TypeVar

Number = TypeVar("Number", bound=float)

# (exp(t) - 1) / t on [-36/128, 0] and (arctan(t) / t - 1) / t^2 as a polynomial in t^2, |t| <= tan(pi/8):
# interpolated at Chebyshev nodes.
_E0, _E1, _E2, _E3, _E4, _E5, _E6, _E7, _E8 = (
    1.0,
    0.4999999999999881,
    0.1666666666655385,
    0.0416666666254208,
    0.00833333257720033,
    0.0013888810912275637,
    0.0001983653503433632,
    2.463325359996458e-05,
    2.429319469234341e-06,
)
_A0, _A1, _A2, _A3, _A4, _A5, _A6, _A7, _A8, _A9 = (
    -0.3333333333333325,
    0.19999999999898407,
    -0.1428571426609655,
    0.11111109636529681,
    -0.09090852557023653,
    0.0769105515567278,
    -0.0664961366708796,
    0.05736331996459826,
    -0.04483334075026139,
    0.022750519644353994,
)
_TAN_PI_8 = 0.41421356237309503
_TAN_3_PI_8 = 2.414213562373095
_HALF_PI = 1.5707963267948966
_QUARTER_PI = 0.7853981633974483
# Weighted least-squares quartic for x^(-1/3) on [0.2, 2.5], where the iteration of power_two_thirds starts.
_R0, _R1, _R2, _R3, _R4 = 2.13334891, -2.69745314, 2.39251789, -0.99271232, 0.15147739
_TINY, _HUGE = 1e-290, 1e290
_SPLITTER = 134217729.0
_EXP_FLOOR = -36.0
_EXP_REDUCTION = 1.0 / 128.0


def select(condition: bool, when_true: Number, when_false: Number) -> Number:
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


def fma(a: float, b: float, c: float) -> float:
    """Return a b + c rounded once (IEEE 754 fusedMultiplyAdd).

    A compiler that may choose what to fuse rounds differently on each machine, so the source chooses.
    Compiled code uses the processor's instruction where it has one. This is what it computes, in
    operations that every machine has: product and sum are found exactly, as sums of numbers, then rounded
    (S. Boldo and G. Melquiond, Emulation of FMA and correctly rounded sums, IEEE Trans. Computers 57
    (2008) 462-471). Where numbers exceed 1e290 or the product is below 1e-290, the product is rounded
    before it is added.
    """
    product = a * b
    high, low = _exact_sum(c, _lost(a, b, product))
    total, carried = _exact_sum(product, high)
    rest, last = _exact_sum(low, carried)
    rounded = total + rest
    missing = rest - (rounded - total)
    next_to = rounded + 2.0 * missing
    between = (next_to - rounded <= 2.0 * missing) & (next_to - rounded >= 2.0 * missing)
    # Halfway between two numbers, what is left decides.
    onwards = ((missing > 0.0) & (last > 0.0)) | ((missing < 0.0) & (last < 0.0))
    once = select(between & onwards, next_to, rounded)
    largest = maximum(maximum(abs(a), abs(b)), maximum(abs(c), abs(product)))
    return select((abs(product) > _TINY) & (largest < _HUGE), once, product + c)


def _exact_sum(a: float, b: float) -> tuple[float, float]:
    """Sum of two numbers and what its rounding lost (Knuth)."""
    total = a + b
    b_of_it = total - a
    return total, (a - (total - b_of_it)) + (b - b_of_it)


def _lost(a: float, b: float, product: float) -> float:
    """What the rounding of a product lost (Dekker): both factors are split into halves."""
    a_high, b_high = _upper_half(a), _upper_half(b)
    a_low, b_low = a - a_high, b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


def _upper_half(x: float) -> float:
    """Return the number of 26 bits nearest to ``x`` (Veltkamp)."""
    scaled = _SPLITTER * x
    return scaled - (scaled - x)


def floor(x: float) -> float:
    """Return the largest whole number not above ``x``, of less than 2^53 in size."""
    return float(math.floor(x))


def clamp(x: float, low: float, high: float) -> float:
    """Limit ``x`` to ``[low, high]``."""
    return minimum(maximum(x, low), high)


def exp(x: float) -> float:
    """Exponential of ``x <= 0``: relative error below 1e-13 on [-36, 0]; smaller arguments count as -36.

    exp(x) = (1 + t p(t))^128, t = x / 128. Polynomials are summed in pairs: the processor then works on
    several terms at once.
    """
    t = maximum(x, _EXP_FLOOR) * _EXP_REDUCTION
    t2 = t * t
    t4 = t2 * t2
    low = fma(t2, fma(_E3, t, _E2), fma(_E1, t, _E0))
    high = fma(t2, fma(_E7, t, _E6), fma(_E5, t, _E4))
    p = fma(t, fma(t4, fma(t4, _E8, high), low), 1.0)
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    return p * p


def octant(y: float, x: float) -> tuple[float, float, float]:
    """Split arctan(y / x), ``y >= 0`` and ``x > 0``, into an angle and a rest of at most pi/8.

    Returns:
        The angle: 0, pi/4 or pi/2; numerator and denominator, > 0, of the tangent of the rest.
    """
    steep = y > _TAN_3_PI_8 * x
    middle = y > _TAN_PI_8 * x
    angle = select(steep, _HALF_PI, select(middle, _QUARTER_PI, 0.0))
    return angle, select(steep, -x, select(middle, y - x, y)), select(steep, y, select(middle, x + y, x))


def arctan_within_octant(t: float) -> float:
    """Inverse tangent of ``|t| <= tan(pi/8)``: relative error below 1e-15."""
    z = t * t
    z2 = z * z
    z4 = z2 * z2
    low = fma(z2, fma(_A3, z, _A2), fma(_A1, z, _A0))
    middle = fma(z2, fma(_A7, z, _A6), fma(_A5, z, _A4))
    return fma(t * z, fma(z4, fma(z4, fma(_A9, z, _A8), middle), low), t)


def power_two_thirds(x: float) -> float:
    """x^(2/3) for ``0.2 <= x <= 2.5``: relative error below 1e-12, without a division.

    Two steps of Householder's iteration for y = x^(-1/3), y <- y (14 - x y^3 (7 - 2 x y^3)) / 9; then
    x^(2/3) = x y.
    """
    x2 = x * x
    y = fma(x2, fma(x2, _R4, fma(_R3, x, _R2)), fma(_R1, x, _R0))
    for _ in range(2):
        cube = (x * y) * (y * y)
        y = y * fma(-cube, fma(-2.0, cube, 7.0), 14.0) * (1.0 / 9.0)
    return x * y
