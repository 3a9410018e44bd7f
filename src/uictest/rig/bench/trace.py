"""Channels of a bench recording and how a sample of them is taken."""

from collections.abc import Sequence
from typing import Any

from uictest.physics import analogue_reading

Record = Any

BENCH_CHANNELS = (
    ("time", "s"),
    ("demanded_pressure", "Pa"),
    ("brake_line_pressure", "Pa"),
    ("valve_command_1", "1"),  # 0 fill, 1 hold, 2 vent; the same for both modules
    ("wsp_acting", "1"),
    ("tank_pressure_1", "Pa"),
    ("tank_pressure_2", "Pa"),
    ("measured_pressure_1", "Pa"),  # as the sensor reads it
    ("measured_pressure_2", "Pa"),
    ("cylinder_pressure_1", "Pa"),  # measured
    ("cylinder_pressure_2", "Pa"),  # computed by the cylinder dynamics
    ("stroke_1", "m"),
    ("caliper_force_1", "N"),
    ("loadcell_1", "N"),
    ("loadcell_2", "N"),
    ("loadcell_3", "N"),
    ("clamping_force_1", "N"),  # sum of the loadcells
    ("computed_force_1", "N"),  # by the four-phase hysteresis from the pressure of module 1
    ("computed_force_none_2", "N"),
    ("computed_force_hysteresis_2", "N"),
    ("computed_force_cylinder_2", "N"),
    ("computed_force_full_2", "N"),
)
"""Channels of a bench test; pressures are gauge, the number at the end is that of the module."""

ROW = len(BENCH_CHANNELS)
LOADCELL_SHARES = (0.36, 0.31, 0.33)
"""Shares of the clamping force that the three loadcells between pad and disc carry (chosen)."""


def sample(
    row: Any, car: Record, modules: Sequence[Record], computed: Sequence[Record], loadcells: Any, p: Record
) -> None:
    """Write the present state into ``row``, an array of :data:`ROW` numbers."""
    caliper = modules[0]
    tank = modules[1]
    row[0] = car.time
    row[1] = car.demand
    row[2] = car.line_pressure - p.atmospheric_pressure
    row[3] = caliper.command
    row[4] = caliper.wsp_acting
    row[5] = caliper.pressure - p.atmospheric_pressure
    row[6] = tank.pressure - p.atmospheric_pressure
    row[7] = _measured_pressure(caliper, p)
    row[8] = _measured_pressure(tank, p)
    row[9] = row[7]
    row[10] = computed[3].compensated_pressure
    row[11] = caliper.stroke
    row[12] = caliper.caliper_force
    row[16] = 0.0
    for k in range(3):
        row[13 + k] = _loadcell(caliper.caliper_force * LOADCELL_SHARES[k], loadcells[k], p)
        row[16] += row[13 + k]
    row[17] = caliper.computed_force
    for i in range(4):
        row[18 + i] = computed[i].computed_force


def _measured_pressure(module: Record, p: Record) -> float:
    gauge = module.pressure - p.atmospheric_pressure
    return analogue_reading(
        gauge,
        p.pressure_gain_error,
        p.pressure_offset,
        module.pressure_error,
        p.pressure_range,
        p.pressure_resolution,
        p.pressure_steps,
    )


def _loadcell(force: float, error: float, p: Record) -> float:
    """Reading of one of three loadcells; offset and noise of the force channel are spread over them."""
    return analogue_reading(
        force,
        p.loadcell_gain_error,
        p.loadcell_offset / 3.0,
        error,
        p.loadcell_range,
        p.loadcell_resolution,
        p.loadcell_steps,
    )
