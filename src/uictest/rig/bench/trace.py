"""Channels of a bench recording and how a sample of them is taken."""

from uictest.core.physics import analogue_reading
from uictest.core.record import Record, channel, layout_of, units_of
from uictest.rig.bench.rig import CYLINDER, FULL, HYSTERESIS, LOADCELLS, NONE, THERMAL, BenchRig
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Wheelset


class BenchSample(Record):
    """Channels of a bench test; pressures are gauge, the number at the end is that of the module."""

    time: float = channel("s")
    demanded_pressure: float = channel("Pa")
    brake_line_pressure: float = channel("Pa")
    valve_command_1: float = channel("1")  # 0 fill, 1 hold, 2 vent; the same for both modules
    wsp_acting: float = channel("1")
    tank_pressure_1: float = channel("Pa")
    tank_pressure_2: float = channel("Pa")
    measured_pressure_1: float = channel("Pa")  # as the sensor reads it
    measured_pressure_2: float = channel("Pa")
    cylinder_pressure_1: float = channel("Pa")  # measured
    cylinder_pressure_2: float = channel("Pa")  # computed by the cylinder dynamics
    cylinder_pressure_thermal_2: float = channel("Pa")  # computed by the modelled air
    stroke_1: float = channel("m")
    caliper_force_1: float = channel("N")
    loadcell_1: float = channel("N")
    loadcell_2: float = channel("N")
    loadcell_3: float = channel("N")
    clamping_force_1: float = channel("N")  # sum of the loadcells
    computed_force_1: float = channel("N")  # by the four-phase hysteresis from the pressure of module 1
    computed_force_none_2: float = channel("N")
    computed_force_hysteresis_2: float = channel("N")
    computed_force_cylinder_2: float = channel("N")
    computed_force_full_2: float = channel("N")
    computed_force_thermal_2: float = channel("N")


BENCH_CHANNELS = units_of(BenchSample)
"""Channels of a bench test and their units."""
BENCH_SAMPLE = layout_of(BenchSample)
"""Layout of :class:`BenchSample`."""
LOADCELL_SHARES = (0.36, 0.31, 0.33)
"""Shares of the clamping force that the three loadcells between pad and disc carry (chosen)."""


def sample(row: BenchSample, rig: BenchRig) -> None:
    """Write the present state into one record of a trace."""
    p = rig.settings[0]
    _sample_pressures(row, rig, p)
    _sample_forces(row, rig, p)


def _sample_pressures(row: BenchSample, rig: BenchRig, p: Parameters) -> None:
    caliper, tank = rig.modules[0], rig.modules[1]
    row.time = rig.car.time
    row.demanded_pressure = rig.car.demanded_pressure
    row.brake_line_pressure = rig.car.line_pressure - p.atmospheric_pressure
    row.valve_command_1 = caliper.valve_command
    row.wsp_acting = caliper.wsp_acting
    row.tank_pressure_1 = caliper.pressure - p.atmospheric_pressure
    row.tank_pressure_2 = tank.pressure - p.atmospheric_pressure
    row.measured_pressure_1 = _measured_pressure(caliper, p)
    row.measured_pressure_2 = _measured_pressure(tank, p)
    row.cylinder_pressure_1 = row.measured_pressure_1
    row.cylinder_pressure_2 = rig.computed[FULL].compensated_pressure
    row.cylinder_pressure_thermal_2 = rig.computed[THERMAL].compensated_pressure


def _sample_forces(row: BenchSample, rig: BenchRig, p: Parameters) -> None:
    caliper = rig.modules[0]
    row.stroke_1 = caliper.stroke
    row.caliper_force_1 = caliper.caliper_force
    row.loadcell_1 = _loadcell(caliper, 0, rig, p)
    row.loadcell_2 = _loadcell(caliper, 1, rig, p)
    row.loadcell_3 = _loadcell(caliper, 2, rig, p)
    row.clamping_force_1 = row.loadcell_1 + row.loadcell_2 + row.loadcell_3
    row.computed_force_1 = caliper.computed_force
    row.computed_force_none_2 = rig.computed[NONE].computed_force
    row.computed_force_hysteresis_2 = rig.computed[HYSTERESIS].computed_force
    row.computed_force_cylinder_2 = rig.computed[CYLINDER].computed_force
    row.computed_force_full_2 = rig.computed[FULL].computed_force
    row.computed_force_thermal_2 = rig.computed[THERMAL].computed_force


def _measured_pressure(module: Wheelset, p: Parameters) -> float:
    gauge = module.pressure - p.atmospheric_pressure
    return analogue_reading(
        gauge,
        module.pressure_gain_error,
        module.pressure_offset,
        module.pressure_error,
        p.pressure_range,
        p.pressure_resolution,
        p.pressure_steps,
    )


def _loadcell(caliper: Wheelset, place: int, rig: BenchRig, p: Parameters) -> float:
    """Return the reading of one of three loadcells; they share offset and noise of the force channel."""
    return analogue_reading(
        caliper.caliper_force * LOADCELL_SHARES[place],
        caliper.loadcell_gain_error,
        caliper.loadcell_offset / LOADCELLS,
        rig.loadcell_errors[place],
        p.loadcell_range,
        p.loadcell_resolution,
        p.loadcell_steps,
    )
