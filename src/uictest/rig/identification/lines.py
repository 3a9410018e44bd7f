"""Robust straight lines, the phases of a record and the play that follows them.

A caliper is a play operator: after the pressure turns, the force stays until the other line is reached. A
sample therefore lies on a line only when its force has left the value at which the pressure turned; every
other sample is inside the loop and does not belong to a line.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uictest.core.physics import FILL

Samples = NDArray[np.float64]
"""Samples of one channel in SI units."""
Mask = NDArray[np.bool_]
"""For each sample of a record, whether something holds there."""


_FEWEST_POINTS = 10
"""Points that a line needs; chosen."""
_NORMAL_MAD = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""
_NORMAL_95_PERCENT = 1.96
"""Half-width of the 95 % interval of a normal distribution over its standard deviation."""
_ROUNDS = 4
"""Rounds in which the noise is estimated; chosen."""
_SMALLEST_SCALE = 1e-6
"""Smallest scale of the scaled forces, so that nothing is divided by zero; chosen."""


@dataclass(frozen=True, slots=True)
class FittedLine:
    """Clamping force over gauge pressure: slope in N/Pa, intercept in N, with 95 % confidence half-widths."""

    slope: float
    intercept: float
    slope_confidence: float = 0.0
    intercept_confidence: float = 0.0
    points: int = 0

    def force(self, pressure: Samples) -> Samples:
        """Force in N at gauge pressures in Pa, never negative."""
        return np.maximum(self.slope * pressure + self.intercept, 0.0)

    def pressure(self, force: float) -> float:
        """Gauge pressure in Pa at a force > 0 in N."""
        return (force - self.intercept) / self.slope


def robust_line(pressure: Samples, force: Samples) -> FittedLine:
    """Fit force = slope x pressure + intercept with the loss soft_l1.

    Points that a phase detector let through by mistake lie to one side of the line, inside the loop. Least
    squares would follow them; soft_l1 counts them by their distance alone beyond the noise, which is
    estimated from the median residual. Unlike Theil-Sen's pairs it is fast on thousands of points and gives
    a covariance.

    Raises:
        ValueError: fewer than ten points, or all at one pressure.
    """
    from scipy.optimize import least_squares

    if len(pressure) < _FEWEST_POINTS or np.ptp(pressure) <= 0.0:
        raise ValueError(f"{len(pressure)} points do not make a line")
    centre, width, height = pressure.mean(), pressure.std(), max(force.std(), _SMALLEST_SCALE)
    x, y = (pressure - centre) / width, (force - force.mean()) / height
    line = np.polyfit(x, y, 1)
    # The first estimate of the noise includes the outliers that its line followed; each round improves it.
    for _ in range(_ROUNDS):
        scale = max(_NORMAL_MAD * float(np.median(np.abs(y - np.polyval(line, x)))), _SMALLEST_SCALE)
        solution = least_squares(lambda fit: fit[0] * x + fit[1] - y, line, loss="soft_l1", f_scale=scale)
        line = solution.x
    covariance = np.linalg.inv(solution.jac.T @ solution.jac) * 2.0 * solution.cost / (len(x) - 2)
    spread = _NORMAL_95_PERCENT * np.sqrt(np.diag(covariance))
    slope = solution.x[0] * height / width
    at_zero = -centre / width
    intercept = force.mean() + height * (solution.x[1] + solution.x[0] * at_zero)
    intercept_spread = np.hypot(spread[1], spread[0] * at_zero)
    return FittedLine(
        float(slope),
        float(intercept),
        float(spread[0] * height / width),
        float(intercept_spread * height),
        len(x),
    )


TURNING = 0.02
"""Change back after which the pressure counts as turned, share of its range; chosen."""
SETTLING = 0.05
"""Time in s for which the force must have left the inside, as pads settle on the disc; chosen."""
DEPARTURE = 0.03
"""Force by which a sample must have left the loop's inside, share of the largest force; chosen."""
SMOOTHING = 0.02
"""Time in s over which pressure and force are averaged before turns are looked for; chosen."""


def smoothed(samples: Samples, width: int) -> Samples:
    """Centred moving mean over an odd number of samples; the ends are repeated."""
    half = width // 2
    if half == 0:
        return samples
    padded = np.concatenate([np.full(half, samples[0]), samples, np.full(half, samples[-1])])
    sums = np.concatenate([[0.0], np.cumsum(padded)])
    return np.asarray((sums[2 * half + 1 :] - sums[: -2 * half - 1]) / (2 * half + 1))


def runs(pressure: Samples, smallest: float) -> list[tuple[int, int, int]]:
    """Runs (first, end, direction) in which a pressure rises (1) or falls (-1).

    A run ends at its extreme; the pressure has turned once it has come back by ``smallest``.
    """
    segments: list[tuple[int, int, int]] = []
    pressures = pressure.tolist()
    first = extreme = low = high = 0
    direction = 0
    for n, value in enumerate(pressures):
        if direction >= 0 and value > pressures[high]:
            high = n
        if direction <= 0 and value < pressures[low]:
            low = n
        turned = 0
        if direction >= 0 and value < pressures[high] - smallest:
            turned, extreme = -1, high
        elif direction <= 0 and value > pressures[low] + smallest:
            turned, extreme = 1, low
        if turned:
            if direction != 0:
                segments.append((first, extreme, direction))
            first, direction = extreme, turned
            low = high = n
    if direction != 0:
        segments.append((first, high if direction > 0 else low, direction))
    return segments


def on_lines(pressure: Samples, force: Samples, step: float) -> tuple[Mask, Mask]:
    """Which samples lie on the squeezing and on the releasing line."""
    width = max(round(SMOOTHING / step), 1) | 1
    calm_pressure, calm_force = smoothed(pressure, width), smoothed(force, width)
    margin = DEPARTURE * float(force.max())
    settled = max(round(SETTLING / step), 1)
    earlier = np.concatenate([np.full(settled, calm_force[0]), calm_force[:-settled]])
    squeezing, releasing = np.zeros(len(force), bool), np.zeros(len(force), bool)
    for first, end, direction in runs(calm_pressure, TURNING * float(np.ptp(pressure))):
        inside = calm_force[first]
        run = slice(first + settled, end + 1)
        if direction > 0:
            squeezing[run] = earlier[run] > inside + margin
        else:
            releasing[run] = (earlier[run] < inside - margin) & (calm_force[run] > margin)
    return squeezing, releasing


def wsp_acting_from_commands(time: Samples, commands: Samples, acting_time: float) -> Mask:
    """When the WSP acts: since its last command other than fill, ``acting_time`` s have not passed."""
    last = np.where(commands != FILL, time, -np.inf)
    return np.asarray(time - np.maximum.accumulate(last) < acting_time)


def wsp_acting_in_intervals(time: Samples, intervals: Sequence[tuple[float, float]]) -> Mask:
    """When the WSP acts: in given intervals (first, last) of time in s."""
    acting = np.zeros(len(time), bool)
    for first, last in intervals:
        acting |= (time >= first) & (time <= last)
    return acting


def computed_force(
    pressure: Samples,
    wsp_acting: Mask,
    lines: Mapping[str, FittedLine],
    transition_time: float,
    step: float,
    start: float,
) -> Samples:
    """Clamping force in N that the four lines give along a record.

    Args:
        pressure: gauge pressure, Pa.
        wsp_acting: when the lines of the WSP apply.
        lines: by the name of the phase, ``bc_squeezing`` to ``wsp_releasing``.
        transition_time: time in which one pair of lines turns into the other, s.
        step: sampling time, s.
        start: force before the record, N.
    """
    share = _rate_limited_shares(wsp_acting, step / max(transition_time, step))
    lower = _force_of_mixed_lines(pressure, lines["bc_squeezing"], lines["wsp_squeezing"], share)
    upper = np.maximum(
        _force_of_mixed_lines(pressure, lines["bc_releasing"], lines["wsp_releasing"], share), lower
    )
    force, held = [], start
    for low, high in zip(lower.tolist(), upper.tolist(), strict=True):
        if held < low:
            held = low
        if held > high:
            held = high
        force.append(held)
    return np.array(force)


def _force_of_mixed_lines(pressure: Samples, bc: FittedLine, wsp: FittedLine, share: Samples) -> Samples:
    slope = bc.slope + share * (wsp.slope - bc.slope)
    intercept = bc.intercept + share * (wsp.intercept - bc.intercept)
    return np.asarray(np.maximum(slope * pressure + intercept, 0.0))


def _rate_limited_shares(acting: Mask, largest_change: float) -> Samples:
    if acting.all() or not acting.any():
        return acting.astype(float)
    shares, share = [], float(acting[0])
    for target in acting.astype(float).tolist():
        share += min(max(target - share, -largest_change), largest_change)
        shares.append(share)
    return np.array(shares)
