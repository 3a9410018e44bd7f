"""Four-phase hysteresis from a record: Lee and Kang (2015), equations (4)-(7)."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.units import BAR, KILONEWTON, KILONEWTON_PER_BAR, PERCENT
from uictest.rig.identification.lines import FittedLine, Mask, Samples, computed_force, on_lines, robust_line
from uictest.rig.identification.record import (
    UnsuitableRecordError,
    held_out,
    require_duration,
    require_finite,
    sampling_time,
)

PHASES: Final = MappingProxyType(
    {
        "bc_squeezing": (False, True),
        "bc_releasing": (False, False),
        "wsp_squeezing": (True, True),
        "wsp_releasing": (True, False),
    }
)
"""Phase -> whether the WSP acts, and whether the pressure rises."""
HIGH_FORCE = 0.9
"""Force at which the width of the loop is reported, share of the largest recorded force; chosen."""
_SHORTEST = 2.0
"""s: shortest record; chosen."""
_LONGEST_STEP = 0.05
"""s: longest sampling time; chosen."""
_SMALLEST_FORCE = 100.0
"""N: the largest force of a record must reach it; chosen."""
_INDEPENDENT = 0.01
"""Sampling time in s of the points that are fitted; closer readings are not independent; chosen."""
_LEAST_SPAN = 0.1
"""Share of the record's range of pressures that a phase must cover, and of its forces; chosen."""
_POOREST_ERROR = 0.1
"""Largest rms error of the computed force on held-out parts, share of the largest force; chosen."""


@dataclass(frozen=True, slots=True)
class HysteresisResult:
    """The lines of the phases in a record, and how well they compute its force.

    Attributes:
        lines: by phase, through the recorded points; a phase that the record does not support is missing.
        level_lines: the same, shifted until the force that the model computes is right on average on each.
        linear: one line for force without hysteresis, midway between the BC lines.
        loop_widths: BC and WSP: width of the loop in Pa at ``high_force``.
        high_force: force in N at which the widths are reported.
        largest_error: of the computed force where the record was held out, share of the largest force.
        rms_error: as ``largest_error``.
        largest_force: largest recorded force, N.
    """

    lines: dict[str, FittedLine]
    level_lines: dict[str, FittedLine]
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
    wsp_acting: Mask,
    transition_time: float = 0.1,
    held_out_share: float = 0.25,
) -> HysteresisResult:
    """Detect the phases, fit their lines and compare the computed force with the recorded one.

    Without a WSP phase in the record, the lines of the BC stand in for those of the WSP.

    Args:
        time: s, evenly sampled.
        pressure: gauge pressure of the brake cylinder, Pa.
        force: recorded clamping force, N.
        wsp_acting: when the WSP acts; see :mod:`uictest.rig.identification.lines`.
        transition_time: time of the transition from one pair of lines to the other, s.
        held_out_share: share of the record that is excluded from the fit and gives the errors.

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
    is_held_out = held_out(len(time), held_out_share)
    points = _level_points(pressure, force, wsp_acting, ~is_held_out, step)
    lines = _fitted_lines(pressure, force, points)

    def computed_by(lines: Mapping[str, FittedLine]) -> Samples:
        return computed_force(pressure, wsp_acting, all_four(lines), transition_time, step, float(force[0]))

    # The play between the lines keeps the peaks of a noisy pressure: a line through the middle of the points
    # would give too much force where it squeezes and too little where it releases.
    mean_error = computed_by(lines) - force
    level_lines = {
        phase: replace(line, intercept=line.intercept - float(np.mean(mean_error[points[phase]])))
        for phase, line in lines.items()
    }
    computed = computed_by(level_lines)
    error = ((computed - force) / largest)[is_held_out]
    squeezing, releasing = lines["bc_squeezing"], lines["bc_releasing"]
    return HysteresisResult(
        lines,
        level_lines,
        FittedLine(
            0.5 * (squeezing.slope + releasing.slope), 0.5 * (squeezing.intercept + releasing.intercept)
        ),
        _hysteresis_widths(lines, HIGH_FORCE * largest),
        HIGH_FORCE * largest,
        float(np.abs(error).max()),
        float(np.sqrt(np.mean(error**2))),
        largest,
    )


def require_force_fit(result: HysteresisResult) -> None:
    """Raise UnsuitableRecordError if the lines hardly compute the force of the held-out parts."""
    if not result.rms_error <= _POOREST_ERROR:
        raise UnsuitableRecordError(
            f"the force does not follow from the pressure by four lines: its rms error on held-out parts is"
            f" {100.0 * result.rms_error:.3g} % of the largest force, at most {100.0 * _POOREST_ERROR:g} %"
            " are accepted"
        )


def hysteresis_text(result: HysteresisResult) -> str:
    """Return the lines of the four phases, the widths of the loops and the errors on held-out samples."""
    lines = [
        f"{phase:<16}{line.slope / KILONEWTON_PER_BAR:9.4f} kN/bar"
        f" +-{line.slope_confidence / KILONEWTON_PER_BAR:8.4f}"
        f"{line.intercept:10.1f} N +-{line.intercept_confidence:7.1f}  {line.points} points"
        f", shifted by {result.level_lines[phase].intercept - line.intercept:+.1f} N"
        for phase, line in result.lines.items()
    ]
    lines += [
        f"{kind} loop width {width / BAR:.4f} bar at {result.high_force / KILONEWTON:.2f} kN"
        for kind, width in result.loop_widths.items()
    ]
    largest, rms = result.largest_error / PERCENT, result.rms_error / PERCENT
    force = result.largest_force / KILONEWTON
    lines.append(f"force error, held out: largest {largest:.2f} %, rms {rms:.2f} % of {force:.2f} kN")
    return "\n".join(lines)


def _level_points(
    pressure: Samples, force: Samples, acting: Mask, fitted: Mask, step: float
) -> dict[str, NDArray[np.int_]]:
    """Return the samples to be fitted of each phase that spans enough pressure."""
    squeezing, releasing = on_lines(pressure, force, step)
    every = max(round(_INDEPENDENT / step), 1)
    points = {}
    for phase, (wsp_acts, rises) in PHASES.items():
        mask = fitted & (acting if wsp_acts else ~acting) & (squeezing if rises else releasing)
        of_phase = np.flatnonzero(mask)[::every]
        if len(of_phase) and np.ptp(pressure[of_phase]) >= _LEAST_SPAN * np.ptp(pressure):
            points[phase] = of_phase
    return points


def _fitted_lines(
    pressure: Samples, force: Samples, points: Mapping[str, NDArray[np.int_]]
) -> dict[str, FittedLine]:
    lines: dict[str, FittedLine] = {}
    for phase, of_phase in points.items():
        with suppress(ValueError):  # too few points
            lines[phase] = robust_line(pressure[of_phase], force[of_phase])
    for phase in ("bc_squeezing", "bc_releasing"):
        if phase not in lines:
            raise UnsuitableRecordError(
                f"phase {phase!r} not found: the pressure must rise and fall far enough"
            )
    return lines


def all_four(lines: Mapping[str, FittedLine]) -> dict[str, FittedLine]:
    """Return a line for every phase: a phase of the WSP without one has the line of the BC."""
    squeezing, releasing = lines["bc_squeezing"], lines["bc_releasing"]
    return {
        "bc_squeezing": squeezing,
        "bc_releasing": releasing,
        "wsp_squeezing": lines.get("wsp_squeezing", squeezing),
        "wsp_releasing": lines.get("wsp_releasing", releasing),
    }


def _hysteresis_widths(lines: dict[str, FittedLine], force: float) -> dict[str, float]:
    pairs = {"bc": ("bc_squeezing", "bc_releasing"), "wsp": ("wsp_squeezing", "wsp_releasing")}
    return {
        kind: lines[squeezing].pressure(force) - lines[releasing].pressure(force)
        for kind, (squeezing, releasing) in pairs.items()
        if squeezing in lines and releasing in lines
    }
