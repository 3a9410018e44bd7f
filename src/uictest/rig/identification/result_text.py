"""What was identified, as data and as text for the terminal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from uictest.core.units import BAR, KILONEWTON, KILONEWTON_PER_BAR, PERCENT, in_unit
from uictest.plans.scenario import RIG_SOURCE, Compensation, Quantity
from uictest.rig.identification.cylinder import CylinderResult
from uictest.rig.identification.hysteresis import HysteresisResult


@dataclass(frozen=True, slots=True)
class AirResult:
    """Numbers of :mod:`uictest.core.physics.module_air` and their errors where the record was held out.

    Attributes:
        tank_heat_conductance: from the wall of a tank to its air, W/K.
        caliper_heat_conductance: from wall and balls of the caliper's module to its air, W/K.
        swept_volume: that the piston sweeps until the pads touch the disc, m3.
        closing_pressure: at which the piston moves to the disc, gauge, Pa.
        opening_pressure: at which it moves back, gauge, Pa.
        largest_before: largest difference of the two pressures as they are, share of the largest.
        largest_after: largest error of the computed pressure, as ``largest_before``.
        rms_after: its root mean square, as ``largest_before``.
        largest_pressure: largest cylinder pressure of the record, Pa.
    """

    tank_heat_conductance: float
    caliper_heat_conductance: float
    swept_volume: float
    closing_pressure: float
    opening_pressure: float
    largest_before: float
    largest_after: float
    rms_after: float
    largest_pressure: float


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


def cylinder_text(result: CylinderResult) -> str:
    """Return the transfer function, its band and the errors on held-out samples."""
    model = result.transfer_function
    before, after = result.largest_before / PERCENT, result.largest_after / PERCENT
    pressure = result.largest_pressure / BAR
    poles = ", ".join(f"{pole.real:.6f}{pole.imag:+.6f}j" for pole in model.poles)
    return "\n".join(
        [
            f"sampling time {in_unit(model.sampling_time, 'ms'):g} ms",
            f"numerator {', '.join(map(repr, model.numerator))}",
            f"denominator 1.0, {', '.join(map(repr, model.denominator))}",
            f"poles {poles}",
            f"gain within 3 dB up to {model.band:.4g} Hz",
            f"fit, held out: {result.fit:.2f} %",
            f"largest error, held out: {before:.2f} % -> {after:.2f} % of {pressure:.3f} bar",
        ]
    )


def air_text(result: AirResult) -> str:
    """Return the numbers of the modelled air and the errors on held-out samples."""
    before, after = result.largest_before / PERCENT, result.largest_after / PERCENT
    rms, pressure = result.rms_after / PERCENT, result.largest_pressure / BAR
    return "\n".join(
        [
            f"heat conductance of a tank {result.tank_heat_conductance:.4g} W/K",
            f"heat conductance of the caliper's module {result.caliper_heat_conductance:.4g} W/K",
            f"swept volume {in_unit(result.swept_volume, 'L'):.4g} L",
            f"piston moves out at {result.closing_pressure / BAR:.4f} bar",
            f"piston moves back at {result.opening_pressure / BAR:.4f} bar",
            f"largest error, held out: {before:.2f} % -> {after:.2f} % of {pressure:.3f} bar",
            f"rms error, held out: {rms:.2f} %",
        ]
    )


Numbers = dict[str, Any]
"""Nested mapping like the file; a number is a pair of its text and the key of its source."""

TOLERANCES_OF: Final = "six-inch"
"""The compensation of the library whose tolerances others take."""
RIG_DESCRIBED: Final = {"mark": "identified", "text": "The rig of the records, as built"}
_SUBJECTS: Final = ("hysteresis", "cylinder", "air")


def is_of_one_rig(facts: Mapping[str, str]) -> bool:
    """Return whether all numbers of a compensation with this provenance were identified on one known rig."""
    digests = {facts.get(f"{subject} rig sha256", "") for subject in _SUBJECTS}
    return len(digests) == 1 and "" not in digests


def listed_rig(rig: Mapping[str, str], tolerances_of: Compensation) -> Numbers:
    """Return the section that lists a rig, given by the keys of a scenario; the last two elements tell."""
    assert tolerances_of.identified_for is not None
    numbers: Numbers = {"caliper": {}, "wsp_valve": {}}
    for key, text in rig.items():
        section, name = key.split(".")[-2:]
        if section == "tank":
            numbers["tank_volume"] = (text, RIG_SOURCE)
        else:
            numbers[section][name] = (text, RIG_SOURCE)
    tolerances = {
        name: with_source(value) if isinstance(value, Quantity) else with_sources(value)
        for name, value in tolerances_of.identified_for.tolerances
    }
    return {**numbers, "tolerances": tolerances}


def with_sources(section: Any) -> Numbers:
    """Return the quantities of a section, each with its source."""
    return {name: with_source(value) for name, value in section}


def with_source(quantity: Quantity) -> tuple[str, str]:
    """Return a quantity as written, and its source."""
    return quantity.text, quantity.source
