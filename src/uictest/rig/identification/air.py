"""What is identified of the air of the caliper's module, and how well it computes its pressure."""

from __future__ import annotations

from dataclasses import dataclass


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
