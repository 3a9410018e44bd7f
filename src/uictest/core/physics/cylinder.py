"""Cylinder dynamics: third-order discrete transfer function from tank pressure to cylinder pressure.

Lee and Kang (2015), equation (8):

    y[n] = (b0 + b1 z^-1 + b2 z^-2 + b3 z^-3) / (1 + a1 z^-1 + a2 z^-2 + a3 z^-3) u[n]

in transposed direct form II: three memories, each the part of later outputs that is already known.
"""

from uictest.core.physics.arithmetic import fma


def output(pressure: float, memory_1: float, b0: float) -> float:
    """Cylinder pressure y[n] for tank pressure u[n], in the unit of the pressures."""
    return fma(b0, pressure, memory_1)


def memory(pressure: float, filtered: float, b: float, a: float, following: float) -> float:
    """Memory i after the step: b_i u[n] - a_i y[n] + memory i+1 before it."""
    return fma(b, pressure, fma(-a, filtered, following))
