"""The air of the caliper's module identified from a record, by the code that follows it in the rig."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest import identification
from uictest.rig.assembly import assemble
from uictest.rig.backends.compiled import OPTIONS, compiled_operations, compiler, translate
from uictest.rig.model.cycle import command_valve
from uictest.rig.model.module_air import follow_tank
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.pneumatics import move_valve
from uictest.rig.model.start import start_module
from uictest.rig.model.state import CAR, WHEELSET, Car, Wheelset
from uictest.scenario import Case

Samples = NDArray[np.float64]
_SPACING = 0.01
"""Time in s between the samples that are fitted; closer readings are not independent; chosen."""
_LONGEST_STEP = 0.001
"""s: longest sampling time; valves travel within some of them; chosen."""
_SHORTEST = 5.0
"""s: shortest record; chosen."""
_LOG_STEP = 1e-4
"""Relative step of the unknowns in numerical derivatives; chosen."""


def identify_air(
    channels: Mapping[str, Samples], case: Case, held_out_share: float = 0.25
) -> identification.AirResult:
    """Find heat conductances, swept volume and the pressures at which the piston moves.

    The squares of the pressure error are minimised (Levenberg-Marquardt), from the numbers that the case's
    compensation has. Tank volume, valve conductances and times are those of the case's brake system.

    Args:
        channels: `time` in s, evenly sampled; gauge pressures `tank`, `cylinder` and `line` in Pa; `command`
            of the valves of both modules. The record begins with released brakes.
        case: the rig of the record.
        held_out_share: share of the record that is excluded from the fit and gives the errors.

    Raises:
        UnsuitableRecordError: the record cannot support the fit; the message says why.
    """
    from scipy.optimize import least_squares

    pressures = {name: channels[name] for name in ("tank", "cylinder", "line")}
    step = identification.required_sampling_time(channels["time"], pressures, _SHORTEST, _LONGEST_STEP)
    model = _ModelledPressure(channels, case, step)
    held_out = identification.held_out(len(channels["time"]), held_out_share)
    fitted = np.flatnonzero(~held_out)[:: max(round(_SPACING / step), 1)]
    cylinder, scale = channels["cylinder"], float(channels["cylinder"].max())

    def error(logarithms: Samples) -> Samples:
        return (model(np.exp(logarithms)) - cylinder)[fitted] / scale

    unknowns = np.exp(least_squares(error, np.log(model.start), diff_step=_LOG_STEP).x)
    tank, caliper, swept, closing, opening = map(float, unknowns)
    after = (model(unknowns) - cylinder)[held_out] / scale
    before = (channels["tank"] - cylinder)[held_out] / scale
    return identification.AirResult(
        tank,
        caliper,
        swept,
        closing,
        opening,
        float(np.abs(before).max()),
        float(np.abs(after).max()),
        float(np.sqrt(np.mean(after**2))),
        scale,
    )


class _ModelledPressure:
    """The cylinder pressure along a record as a function of the five unknowns, in the order of the result."""

    def __init__(self, channels: Mapping[str, Samples], case: Case, step: float) -> None:
        self._channels = channels
        self._case = _at_step(case, step)
        air = case.scenario.rig.compensation_model.air
        self.start = np.array([float(value) for _, value in air])

    def __call__(self, unknowns: Samples) -> Samples:
        channels = self._channels
        car: Any = np.zeros(1, CAR)[0]
        wheelset: Any = np.zeros(1, WHEELSET)[0]
        computed = np.empty(len(channels["time"]))
        _compiled()(
            car,
            wheelset,
            assemble(_with_unknowns(self._case, unknowns)).parameters,
            channels["tank"],
            channels["line"],
            channels["command"].astype(np.int64),
            computed,
        )
        return computed


def _at_step(case: Case, step: float) -> Case:
    return _changed(case, "simulation", {"time_step": step})


def _with_unknowns(case: Case, unknowns: Samples) -> Case:
    rig = case.scenario.rig
    air = rig.compensation_model.air
    values = {name: float(value) for (name, _), value in zip(air, unknowns, strict=True)}
    model = rig.compensation_model.model_copy(update={"air": air.model_copy(update=values)})
    return _changed(case, "rig", {"compensation_model": model})


def _changed(case: Case, section: str, values: Mapping[str, object]) -> Case:
    changed = getattr(case.scenario, section).model_copy(update=values)
    return replace(case, scenario=case.scenario.model_copy(update={section: changed}))


@cache
def _compiled() -> Callable[..., None]:
    numba = compiler()
    function: Callable[..., None] = translate(_follow, numba.njit(**OPTIONS), compiled_operations())
    return function


def _follow(
    car: Car, wheelset: Wheelset, p: Parameters, tank: Any, line: Any, commands: Any, computed: Any
) -> None:
    """Follow a record sample by sample and fill ``computed`` with gauge pressures, Pa."""
    start_module(wheelset, 0.0, p)
    wheelset.pressure_reading = tank[0]
    computed[0] = tank[0]
    for n in range(1, len(tank)):
        within = (n - 1) % p.steps_per_cycle
        if within == 0:
            wheelset.valve_command = commands[n]
            command_valve(wheelset, p)
        car.substep = float(within)
        move_valve(wheelset, car, p)
        wheelset.pressure_reading = tank[n]
        follow_tank(wheelset, line[n] + p.atmospheric_pressure, p)
        computed[n] = wheelset.modelled_pressure - p.atmospheric_pressure
