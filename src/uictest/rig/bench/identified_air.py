"""The air of the caliper's module identified from a record, by the code that follows it in the rig."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.core.physics import REFERENCE_DENSITY, REFERENCE_TEMPERATURE, VENT
from uictest.core.units import BAR, in_unit
from uictest.plans.scenario import Case, ModuleAir
from uictest.rig import identification
from uictest.rig.assembly import assemble
from uictest.rig.brake_assembly import set_module_air
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, native_function
from uictest.rig.model.cycle import command_valve
from uictest.rig.model.friction_brake import follow_tank
from uictest.rig.model.parameters import (
    PARAMETERS,
    WHEELSET_PARAMETERS,
    Parameters,
    WheelsetParameters,
    copy_wheelset_parameters,
)
from uictest.rig.model.pneumatics import move_valve
from uictest.rig.model.state import CAR, WHEELSET, Car, Wheelset
from uictest.rig.model.stop import start_module

Samples = NDArray[np.float64]
_SPACING = 0.01
"""Time in s between the samples that are fitted; closer readings are not independent; chosen."""
_LONGEST_STEP = 0.001
"""s: longest sampling time; valves travel within some of them; chosen."""
_SHORTEST = 5.0
"""s: shortest record; chosen."""
_LOG_STEP = 1e-4
"""Relative step of the unknowns in numerical derivatives; chosen."""
_AT_REST = 0.02
"""Share of its largest value that a pressure may have where the record begins; chosen."""
_LEAST_PRESSURE = -0.5 * BAR
"""Gauge pressure in Pa below which no valve leads; chosen."""
_VENT_WINDOW = 0.05
"""s: over which the rate of an emptying tank is taken; chosen."""
_LEAST_VENTED = 0.2
"""s: of choked venting that a record must have to tell the tank's volume; chosen."""
_VOLUME_MARGIN = 1.2
"""Factor by which volume or conductance may be off: heat conductances hardly depend on so much; chosen."""
_NAMES = (
    "tank_heat_conductance",
    "caliper_heat_conductance",
    "swept_volume",
    "opening_pressure",
    "closing_gap",
)
"""The unknowns: W/K, W/K, share of a tank's volume, gauge Pa, and closing less opening pressure, Pa."""
_LOWEST = np.array([0.01, 0.01, 1e-3, 0.01 * BAR, 0.001 * BAR])
_HIGHEST = np.array([500.0, 500.0, 0.5, 4.0 * BAR, 3.0 * BAR])
_STARTS = (
    np.array([2.0, 10.0, 0.02, 0.3 * BAR, 0.1 * BAR]),
    np.array([5.0, 20.0, 0.05, 0.6 * BAR, 0.2 * BAR]),
    np.array([1.0, 4.0, 0.01, 0.2 * BAR, 0.05 * BAR]),
)
"""Bounds of the unknowns, and where the search starts; chosen."""
_AT_A_BOUND = 1e-3
"""Relative distance from a bound at which a record says nothing about an unknown; chosen."""
_EXPONENTS = (8, 32, 128)
"""Powers of the error whose sum is minimised in turn on the way to the least largest error; chosen. With the
last, the largest of some 30 000 errors is within 9 % of the sum's root."""
_CONVERGED = 1e-10
"""Relative change of error and unknowns at which the search ends; chosen."""


def identify_air(
    channels: Mapping[str, Samples],
    case: Case,
    held_out_share: float = 0.25,
    starts_near: ModuleAir | identification.AirResult | None = None,
    largest: bool = False,
) -> identification.AirResult:
    """Find heat conductances, swept volume and the pressures at which the piston moves.

    The squares of the pressure error are minimised (trust region, reflective) from several starts, whatever
    the case's compensation holds. Tank volume, valve conductances and times are those of the case's brake
    system.

    Args:
        channels: `time` in s, evenly sampled; gauge pressures `tank`, `cylinder` and `line` in Pa; `command`
            of the valves of both modules. The record begins with released brakes.
        case: the rig of the record.
        held_out_share: share of the record that is excluded from the fit and gives the errors.
        starts_near: where the one search starts [default: three searches from far apart].
        largest: whether the largest error is minimised, from there on, instead of the mean square.

    Raises:
        UnsuitableRecordError: the record cannot support the fit; the message says why.
    """
    pressures = {name: channels[name] for name in ("tank", "cylinder", "line")}
    step = identification.required_sampling_time(channels["time"], pressures, _SHORTEST, _LONGEST_STEP)
    _require_rest(pressures)
    _require_volume(channels, case, step)
    model = ModelledPressure(channels, case, step)
    held_out = identification.held_out(len(channels["time"]), held_out_share)
    fitted = np.flatnonzero(~held_out)[:: max(round(_SPACING / step), 1)]
    cylinder, scale = channels["cylinder"], float(channels["cylinder"].max())
    starts = _STARTS if starts_near is None else (_start_near(starts_near, case),)

    def error(x: Samples) -> Samples:
        return (model(x) - cylinder)[fitted] / scale

    unknowns = _least_squares(error, starts)
    for exponent in _EXPONENTS if largest else ():
        unknowns = _least_squares(
            _powered(error, exponent, float(np.abs(error(unknowns)).max())), (unknowns,)
        )
    after = (model(unknowns) - cylinder)[held_out] / scale
    before = (channels["tank"] - cylinder)[held_out] / scale
    if not np.mean(after**2) < np.mean(before**2):
        raise identification.UnsuitableRecordError(
            "the modelled air is no nearer to the cylinder pressure than the tank pressure is"
        )
    tank, caliper, swept, opening, gap = map(float, unknowns)
    return identification.AirResult(
        tank,
        caliper,
        swept * float(case.scenario.brake.system.tank.volume),
        opening + gap,
        opening,
        float(np.abs(before).max()),
        float(np.abs(after).max()),
        float(np.sqrt(np.mean(after**2))),
        scale,
    )


def _require_rest(pressures: Mapping[str, Samples]) -> None:
    """Raise UnsuitableRecordError for pressures that begin braked, or that no valve can reach."""
    for name, pressure in pressures.items():
        if pressure.min() < _LEAST_PRESSURE:
            raise identification.UnsuitableRecordError(
                f"the {name} pressure falls to {pressure.min() / BAR:.3g} bar: is it gauge pressure?"
            )
        if pressure[0] > _AT_REST * pressure.max():
            raise identification.UnsuitableRecordError(
                f"the record must begin with released brakes, but the {name} pressure begins at"
                f" {pressure[0] / BAR:.3g} bar"
            )


def _require_volume(channels: Mapping[str, Samples], case: Case, step: float) -> None:
    """Raise UnsuitableRecordError for a tank that empties as one of quite another volume would.

    Through an open vent that is choked, d ln p / dt = -n C rho0 R sqrt(T0 T) / V (ISO 6358, ideal gas), n
    from 1 (isothermal) to the ratio of heat capacities (adiabatic). A record without such vents says nothing.
    """
    system = case.scenario.brake.system
    air, valve, window = system.air, system.wsp_valve, max(round(_VENT_WINDOW / step), 1)
    absolute = channels["tank"] + air.atmospheric_pressure
    settling = round((valve.switching_delay + valve.travel_time) / step) + window
    flows = (channels["command"] == VENT) & (
        absolute > air.atmospheric_pressure / system.critical_pressure_ratio
    )
    since_shut = np.arange(flows.size) - np.maximum.accumulate(np.where(flows, -1, np.arange(flows.size)))
    ends = np.flatnonzero(since_shut > settling)
    if ends.size * step < _LEAST_VENTED:
        return
    rates = np.log(absolute[ends - window] / absolute[ends]) / (window * step)
    temperature = float(np.sqrt(REFERENCE_TEMPERATURE * air.temperature))
    flow = valve.vent_conductance * REFERENCE_DENSITY * air.gas_constant * temperature
    lowest = flow / max(float(np.median(rates)), 1e-9)
    highest = lowest * air.heat_capacity_ratio
    if not lowest / _VOLUME_MARGIN <= system.tank.volume <= highest * _VOLUME_MARGIN:
        raise identification.UnsuitableRecordError(
            f"the tank empties through its vent as one of {in_unit(lowest, 'L'):.3g} to"
            f" {in_unit(highest, 'L'):.3g} L would, the assumed rig has {system.tank.volume.text}:"
            " set brake.system.tank.volume, or brake.system.wsp_valve.vent_conductance, of the record's rig"
        )


def _powered(error: Callable[[Samples], Samples], exponent: int, unit: float) -> Callable[[Samples], Samples]:
    def powered(x: Samples) -> Samples:
        relative = error(x) / unit
        return np.asarray(np.sign(relative) * np.abs(relative) ** (exponent // 2))

    return powered


def _start_near(air: ModuleAir | identification.AirResult, case: Case) -> Samples:
    swept = float(air.swept_volume) / float(case.scenario.brake.system.tank.volume)
    gap = float(air.closing_pressure) - float(air.opening_pressure)
    pressures = float(air.opening_pressure), gap
    start = np.array([air.tank_heat_conductance, air.caliper_heat_conductance, swept, *pressures])
    return np.asarray(np.clip(start, 1.01 * _LOWEST, 0.99 * _HIGHEST))


def _least_squares(error: Callable[[Samples], Samples], starts: Sequence[Samples]) -> Samples:
    """Return the best unknowns of all starts. Raises UnsuitableRecordError where one is not determined."""
    from scipy.optimize import least_squares

    bounds = np.log(_LOWEST), np.log(_HIGHEST)
    ends = [
        least_squares(
            lambda logarithms: error(np.exp(logarithms)),
            np.log(start),
            bounds=bounds,
            diff_step=_LOG_STEP,
            ftol=_CONVERGED,
            xtol=_CONVERGED,
        )
        for start in starts
    ]
    best = np.exp(min(ends, key=lambda end: end.cost).x)
    for name, value, low, high in zip(_NAMES, best, _LOWEST, _HIGHEST, strict=True):
        if value < low * (1.0 + _AT_A_BOUND) or value > high * (1.0 - _AT_A_BOUND):
            raise identification.UnsuitableRecordError(
                f"the record does not determine the {name.replace('_', ' ')}: do the valves vent and fill for"
                " long enough, and does the piston move back?"
            )
    return np.asarray(best)


class ModelledPressure:
    """The cylinder pressure along a record as a function of the air's five unknowns.

    Args:
        channels: time, tank and line pressure and valve commands of the record; Pa, gauge.
        case: the rig that it was recorded on.
        step: sampling time, s.
    """

    def __init__(self, channels: Mapping[str, Samples], case: Case, step: float) -> None:
        self._tank, self._line = (np.ascontiguousarray(channels[name], "f8") for name in ("tank", "line"))
        self._commands = np.ascontiguousarray(channels["command"], "i8")
        scenario = case.scenario
        simulation = scenario.simulation.model_copy(update={"time_step": step})
        inputs = assemble(replace(case, scenario=scenario.model_copy(update={"simulation": simulation})))
        self._parameters, self._of_wheelset = inputs.parameters, inputs.wheelset_parameters[0]
        self._air, self._system = scenario.rig.compensation_model.air, scenario.brake.system
        self._step = step

    def __call__(self, unknowns: Samples) -> Samples:
        """Return gauge pressures, Pa, at the record's instants.

        Args:
            unknowns: heat conductances of tank and caliper, W/K; swept volume as a share of a tank's;
                opening pressure, and closing less opening pressure, gauge Pa.
        """
        tank, caliper, swept, opening, gap = map(float, unknowns)
        values = {
            "tank_heat_conductance": tank,
            "caliper_heat_conductance": caliper,
            "swept_volume": swept * self._system.tank.volume,
            "opening_pressure": opening,
            "closing_pressure": opening + gap,
        }
        set_module_air(self._parameters, self._air.model_copy(update=values), self._system, self._step)
        computed = np.empty(self._tank.size)
        native_function(WALK)(
            *(np.zeros(1, CAR)[0], np.zeros(1, WHEELSET)[0], self._parameters, self._of_wheelset),
            *(self._tank, self._line, self._commands, computed),
        )
        return computed


def follow_record_of_air(
    car: Car,
    wheelset: Wheelset,
    p: Parameters,
    wheelset_parameters: WheelsetParameters,
    tank: Any,
    line: Any,
    commands: Any,
    computed: Any,
) -> None:
    """Simulate the air of a caliper's module, driven by a record, sample by sample.

    A sample is one base step; valves are commanded at the first step of each controller cycle.

    Args:
        car: zeroed car record; its ``substep`` counts the steps within a cycle.
        wheelset: zeroed wheelset record.
        p: parameter record.
        wheelset_parameters: parameters of the wheelset.
        tank: recorded tank pressures, gauge Pa; they are the readings of the pressure sensor.
        line: recorded brake line pressures, gauge Pa; the tank fills from them.
        commands: recorded valve commands.
        computed: filled with the modelled cylinder pressures, gauge Pa.
    """
    copy_wheelset_parameters(wheelset, wheelset_parameters)
    start_module(wheelset, 0.0, p)
    wheelset.pressure_reading = tank[0]
    computed[0] = tank[0]
    for n in range(1, len(tank)):
        within = (n - 1) % p.steps_per_cycle
        if within == 0:
            wheelset.valve_command = commands[n]
            command_valve(wheelset, p)
        car.substep = float(within)
        move_valve(wheelset, car)
        wheelset.pressure_reading = tank[n]
        follow_tank(wheelset, line[n] + p.atmospheric_pressure, p)
        computed[n] = wheelset.modelled_pressure - p.atmospheric_pressure


_ROWS = Length("rows")
WALK = Entry(
    f"{__name__}:follow_record_of_air",
    (
        *(at(CAR), at(WHEELSET), at(PARAMETERS), at(WHEELSET_PARAMETERS)),
        *(at("f8", _ROWS), at("f8", _ROWS), at("i8", _ROWS), at("f8", _ROWS)),
    ),
)
