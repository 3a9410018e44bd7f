"""The cylinder's transfer function at another sampling time than it was identified at."""

import math


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
    import numpy as np
    from scipy.linalg import fractional_matrix_power
    from scipy.signal import ss2tf, tf2ss

    a, b, c, d = tf2ss(numerator, [1.0, *denominator])
    identity = np.eye(len(a))
    faster = np.real(fractional_matrix_power(a, step / sampling_time))
    held = (faster - identity) @ np.linalg.solve(a - identity, b)
    b_new, a_new = ss2tf(faster, held, c, d)
    return _unity_gain([float(x) for x in b_new[0]], [float(x) for x in a_new[1:]])


def _unity_gain(numerator: list[float], denominator: list[float]) -> tuple[list[float], list[float]]:
    """Make the gain at rest one again: rounding the last digits of the coefficients changes it."""
    rest = math.fsum([1.0, *denominator])
    return [math.fsum([rest, *(-b for b in numerator[1:])]), *numerator[1:]], denominator
