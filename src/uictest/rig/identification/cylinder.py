"""Cylinder dynamics from a record: Lee and Kang (2015), equation (8). What is identified of the air."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from uictest.core.units import BAR, PERCENT, in_unit
from uictest.rig.identification.lines import Mask, Samples
from uictest.rig.identification.output_error import FitSegment, Poles, free_weights, refined, sections
from uictest.rig.identification.record import (
    UnsuitableRecordError,
    applications,
    held_out,
    required_sampling_time,
)

_SHORTEST = 5.0
"""s: shortest record; chosen."""
_LONGEST_STEP = 0.01
"""s: longest sampling time; chosen."""
_POOREST_FIT = 50.0
"""%: below it the fit is closer to a constant than to the pressure; chosen."""
_GRID = 2.0**-50
"""Coefficients are multiples of this."""


@dataclass(frozen=True)
class TransferFunction:
    """(b0 + b1/z + b2/z2 + b3/z3) / (1 + a1/z + a2/z2 + a3/z3) at a sampling time in s."""

    numerator: tuple[float, float, float, float]
    denominator: tuple[float, float, float]
    sampling_time: float

    def output(self, samples: Samples) -> Samples:
        """The response to ``samples``, at rest at the first of them."""
        from scipy.signal import lfilter

        filtered = lfilter(self.numerator, [1.0, *self.denominator], samples - samples[0])
        return np.asarray(filtered + samples[0])

    @cached_property
    def system(self) -> object:
        """The same as a system of python-control."""
        import control

        return control.TransferFunction(list(self.numerator), [1.0, *self.denominator], self.sampling_time)

    @property
    def poles(self) -> NDArray[np.complex128]:
        """Poles in the z plane."""
        return np.asarray(np.roots([1.0, *self.denominator]), dtype=np.complex128)

    def response(self, frequencies: Samples) -> NDArray[np.complex128]:
        """Complex gain at frequencies in Hz, by python-control."""
        import control

        return np.asarray(control.frequency_response(self.system, 2.0 * np.pi * frequencies).complex)

    @property
    def band(self) -> float:
        """Frequency in Hz up to which the gain stays within 3 dB of one; at most half the sampling rate."""
        frequencies = np.geomspace(1e-3, 0.499 / self.sampling_time, 400)
        outside = np.abs(20.0 * np.log10(np.abs(self.response(frequencies)))) > 3.0
        return float(frequencies[np.argmax(outside)]) if np.any(outside) else 0.5 / self.sampling_time


@dataclass(frozen=True, slots=True)
class CylinderResult:
    """The transfer function and how well it computes the held-out part of the record.

    Attributes:
        transfer_function: from tank pressure to cylinder pressure.
        fit: 100 % less the root-mean-square error over the standard deviation of the cylinder pressure.
        largest_before: largest difference of the two pressures as they are, share of the largest.
        largest_after: largest error with it.
        largest_pressure: largest cylinder pressure of the record, Pa.
    """

    transfer_function: TransferFunction
    fit: float
    largest_before: float
    largest_after: float
    largest_pressure: float


@dataclass(frozen=True, slots=True)
class AirResult:
    """Numbers of :mod:`uictest.core.physics.air` and their errors where the record was held out.

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


def assembled(poles: Poles, weights: Samples, step: float) -> TransferFunction:
    """The transfer function of these poles and weights, its gain at rest one to the last digit."""
    (b_lag, a_lag), (b_low, a_low), (b_band, _) = sections(poles, step)
    denominator = np.convolve(a_lag, a_low)
    c1, c2, c3 = weights
    numerator = (1.0 - c1 - c2) * denominator
    numerator = numerator + c1 * np.convolve(b_lag, a_low) + np.convolve(a_lag, c2 * b_low + c3 * b_band)
    # The gain at rest is the ratio of two small differences of numbers near three. On this grid their sums
    # are exact, in whatever order they are taken; it moves a pole of 20 s by millionths.
    b0, b1, b2 = (round(float(b) / _GRID) * _GRID for b in numerator[:3])
    a1, a2, a3 = (round(float(a) / _GRID) * _GRID for a in denominator[1:])
    b3 = (1.0 + a1 + a2 + a3) - (b0 + b1 + b2)
    return TransferFunction((b0, b1, b2, b3), (a1, a2, a3), step)


def identify_cylinder(
    time: Samples, tank_pressure: Samples, cylinder_pressure: Samples, held_out_share: float = 0.25
) -> CylinderResult:
    """Find the third-order transfer function at the record's sampling time.

    A linear start (ARX, Steiglitz-McBride) and fixed ones are refined for the least output error of the whole
    simulated record, in each of its brake applications. Unity gain at rest and stability hold by
    parametrisation. The response to a step never turns back, since the hysteresis would keep the force of the
    turn.

    Args:
        time: s, evenly sampled, every 10 ms or more often.
        tank_pressure: gauge pressure of a tank without cylinder, Pa.
        cylinder_pressure: gauge pressure of the cylinder under the same valve commands, Pa.
        held_out_share: share of the record that is excluded from the fit and gives the errors.

    Raises:
        UnsuitableRecordError: the record cannot support the fit; the message says why.
    """
    pressures = {"tank": tank_pressure, "cylinder": cylinder_pressure}
    step = required_sampling_time(time, pressures, _SHORTEST, _LONGEST_STEP)
    is_held_out = held_out(len(time), held_out_share)
    brakings = applications(tank_pressure, cylinder_pressure, step)
    if not any(is_held_out[braking].any() and not is_held_out[braking].all() for braking in brakings):
        raise UnsuitableRecordError("no brake application: the pressures must rise from rest and hold")
    segments = [
        _fit_segment(tank_pressure[braking], cylinder_pressure[braking], ~is_held_out[braking])
        for braking in brakings
    ]
    poles, weights = refined(segments, step)
    model = assembled(poles, weights, step)
    computed = [model.output(tank_pressure[braking]) for braking in brakings]
    held = np.concatenate([is_held_out[braking] for braking in brakings])
    tank = np.concatenate([tank_pressure[braking] for braking in brakings])
    cylinder = np.concatenate([cylinder_pressure[braking] for braking in brakings])
    return _assessed_model(model, tank[held], cylinder[held], np.concatenate(computed)[held])


def fitted_freely(time: Samples, tank_pressure: Samples, cylinder_pressure: Samples) -> TransferFunction:
    """Find the third-order transfer function with the least output error over a whole record.

    Nothing is held out, and only unity gain at rest and stability bound it: what such a filter can reach
    where it was fitted. A rig cannot use it, because a step response that turns back is kept as force.
    Arguments are those of :func:`identify_cylinder`.
    """
    pressures = {"tank": tank_pressure, "cylinder": cylinder_pressure}
    step = required_sampling_time(time, pressures, _SHORTEST, _LONGEST_STEP)
    brakings = applications(tank_pressure, cylinder_pressure, step)
    pairs = [(tank_pressure[braking], cylinder_pressure[braking]) for braking in brakings]
    segments = [_fit_segment(tank, cylinder, np.ones(len(tank), bool)) for tank, cylinder in pairs]
    return assembled(*refined(segments, step, free_weights), step)


def require_fit(result: CylinderResult) -> None:
    """Raise UnsuitableRecordError if the result hardly reproduces the held-out part of its record."""
    if not result.fit >= _POOREST_FIT:
        raise UnsuitableRecordError(
            f"the cylinder pressure does not follow from the tank pressure: the fit of the held-out part is"
            f" {result.fit:.3g} %, at least {_POOREST_FIT:g} % are needed"
        )


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


def _fit_segment(tank: Samples, cylinder: Samples, fitted: Mask) -> FitSegment:
    return FitSegment(tank - tank[0], cylinder - tank[0], fitted)


def _assessed_model(
    model: TransferFunction, tank: Samples, cylinder: Samples, computed: Samples
) -> CylinderResult:
    largest = float(cylinder.max())
    spread = float(np.sqrt(np.mean((cylinder - cylinder.mean()) ** 2)))
    return CylinderResult(
        model,
        100.0 * (1.0 - float(np.sqrt(np.mean((computed - cylinder) ** 2))) / spread),
        float(np.abs(tank - cylinder).max()) / largest,
        float(np.abs(computed - cylinder).max()) / largest,
        largest,
    )
