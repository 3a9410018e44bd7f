"""Identified hysteresis, cylinder dynamics and air as text for the terminal."""

from __future__ import annotations

from uictest.core.units import BAR, KILONEWTON, KILONEWTON_PER_BAR, PERCENT, in_unit
from uictest.rig.identification.air import AirResult
from uictest.rig.identification.cylinder import CylinderResult
from uictest.rig.identification.hysteresis import HysteresisResult


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
