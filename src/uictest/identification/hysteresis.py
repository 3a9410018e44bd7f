"""Four-phase hysteresis from a record: Lee and Kang (2015), equations (4)-(7)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uictest.identification.lines import FittedLine, robust_line
from uictest.identification.phases import on_lines
from uictest.identification.play import computed_force
from uictest.identification.suitability import (
    UnsuitableRecordError,
    held_out,
    require_duration,
    require_finite,
    sampling_time,
)

Samples = NDArray[np.float64]
PHASES = ("bc_squeezing", "bc_releasing", "wsp_squeezing", "wsp_releasing")
HIGH_FORCE = 0.9
"""Where the width of the loop is told, share of the largest measured force."""
_SHORTEST = 2.0
_LONGEST_STEP = 0.05
_SMALLEST_FORCE = 100.0
_INDEPENDENT = 0.01
"""Sampling time in s of the points that are fitted; closer readings of a sensor are not independent."""
_LEAST_SPAN = 0.1
"""Range of pressures that the points of a phase must cover, and of forces, share of the record's own."""


@dataclass(frozen=True, slots=True)
class HysteresisResult:
    """The lines of the phases that the record holds, and how well they compute its force.

    Attributes:
        lines: by phase; a phase that the record does not support is not there.
        linear: one line for force without hysteresis, midway between the BC lines.
        loop_widths: BC and WSP: width of the loop in Pa at ``high_force``.
        high_force: force in N at which the widths are told.
        largest_error: of the computed force where the record was held out, share of the largest force.
        rms_error: as ``largest_error``.
        largest_force: largest measured force, N.
    """

    lines: dict[str, FittedLine]
    linear: FittedLine
    loop_widths: dict[str, float]
    high_force: float
    largest_error: float
    rms_error: float
    largest_force: float


def identify_hysteresis(
    time: Samples,
    pressure: Samples,
    force: Samples,
    wsp_acting: NDArray[np.bool_],
    transition_time: float = 0.1,
    held_out_share: float = 0.25,
) -> HysteresisResult:
    """Find the phases, fit their lines and hold the computed force against the measured one.

    The lines of the WSP are those of the BC where the record has no WSP phase, so that they can be used.

    Args:
        time: s, evenly sampled.
        pressure: gauge pressure of the brake cylinder, Pa.
        force: measured clamping force, N.
        wsp_acting: when the WSP acts; see :mod:`uictest.identification.phases`.
        transition_time: time in which one pair of lines turns into the other, s.
        held_out_share: share of the record that is kept from the fit and tells the errors.

    Raises:
        UnsuitableRecordError: the record cannot support the fit; the message says why.
    """
    require_finite({"time": time, "pressure": pressure, "force": force})
    require_duration(time, _SHORTEST)
    step = sampling_time(time, _LONGEST_STEP)
    largest = float(force.max())
    if largest < _SMALLEST_FORCE:
        raise UnsuitableRecordError(f"no clamping force: at most {largest:.3g} N")
    if np.ptp(force) < _LEAST_SPAN * largest:
        raise UnsuitableRecordError(f"no excitation: the force varies by {np.ptp(force):.3g} N only")
    kept = held_out(len(time), held_out_share)
    lines = _lines(pressure, force, wsp_acting, ~kept, step)
    computed = computed_force(pressure, wsp_acting, _all_four(lines), transition_time, step, float(force[0]))
    error = ((computed - force) / largest)[kept]
    return HysteresisResult(
        lines,
        _midway(lines["bc_squeezing"], lines["bc_releasing"]),
        _widths(lines, HIGH_FORCE * largest),
        HIGH_FORCE * largest,
        float(np.abs(error).max()),
        float(np.sqrt(np.mean(error**2))),
        largest,
    )


def _lines(
    pressure: Samples, force: Samples, acting: NDArray[np.bool_], fitted: NDArray[np.bool_], step: float
) -> dict[str, FittedLine]:
    squeezing, releasing = on_lines(pressure, force, step)
    every = max(round(_INDEPENDENT / step), 1)
    lines: dict[str, FittedLine] = {}
    for phase in PHASES:
        mask = fitted & (acting if phase.startswith("wsp") else ~acting)
        mask &= squeezing if phase.endswith("squeezing") else releasing
        points = np.flatnonzero(mask)[::every]
        if len(points) and np.ptp(pressure[points]) >= _LEAST_SPAN * np.ptp(pressure):
            try:
                lines[phase] = robust_line(pressure[points], force[points])
            except ValueError:
                continue
    for phase in ("bc_squeezing", "bc_releasing"):
        if phase not in lines:
            raise UnsuitableRecordError(
                f"phase {phase!r} not found: the pressure must rise and fall far enough"
            )
    return lines


def _all_four(lines: dict[str, FittedLine]) -> dict[str, FittedLine]:
    return {phase: lines.get(phase, lines[phase.replace("wsp", "bc")]) for phase in PHASES}


def _midway(squeezing: FittedLine, releasing: FittedLine) -> FittedLine:
    return FittedLine(
        0.5 * (squeezing.slope + releasing.slope), 0.5 * (squeezing.intercept + releasing.intercept)
    )


def _widths(lines: dict[str, FittedLine], force: float) -> dict[str, float]:
    return {
        kind: lines[f"{kind}_squeezing"].pressure(force) - lines[f"{kind}_releasing"].pressure(force)
        for kind in ("bc", "wsp")
        if f"{kind}_squeezing" in lines and f"{kind}_releasing" in lines
    }
