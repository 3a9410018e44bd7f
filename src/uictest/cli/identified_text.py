"""Identified hysteresis and cylinder dynamics as text for the terminal."""

from __future__ import annotations

from uictest import identification


def hysteresis_text(result: identification.HysteresisResult) -> str:
    """Return the lines of the four phases, the widths of the loops and the errors on held-out samples."""
    lines = [
        f"{phase:<16}{line.slope * 100:9.4f} kN/bar +-{line.slope_confidence * 100:8.4f}"
        f"{line.intercept:10.1f} N +-{line.intercept_confidence:7.1f}  {line.points} points"
        for phase, line in result.lines.items()
    ]
    lines += [
        f"{kind} loop width {width / 1e5:.4f} bar at {result.high_force / 1e3:.2f} kN"
        for kind, width in result.loop_widths.items()
    ]
    largest, rms = 100.0 * result.largest_error, 100.0 * result.rms_error
    force = result.largest_force / 1e3
    lines.append(f"force error, held out: largest {largest:.2f} %, rms {rms:.2f} % of {force:.2f} kN")
    return "\n".join(lines)


def cylinder_text(result: identification.CylinderResult) -> str:
    """Return the transfer function, its band and the errors on held-out samples."""
    model = result.transfer_function
    before, after = 100.0 * result.largest_before, 100.0 * result.largest_after
    pressure = result.largest_pressure / 1e5
    poles = ", ".join(f"{pole.real:.6f}{pole.imag:+.6f}j" for pole in model.poles)
    return "\n".join(
        [
            f"sampling time {model.sampling_time * 1e3:g} ms",
            f"numerator {', '.join(map(repr, model.numerator))}",
            f"denominator 1.0, {', '.join(map(repr, model.denominator))}",
            f"poles {poles}",
            f"gain within 3 dB up to {model.band:.4g} Hz",
            f"fit, held out: {result.fit:.2f} %",
            f"largest error, held out: {before:.2f} % -> {after:.2f} % of {pressure:.3f} bar",
        ]
    )
