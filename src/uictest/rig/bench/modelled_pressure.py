"""The cylinder pressure along a record as the rig's code follows it: compiled once, kept in the cache."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.plans.scenario import Case
from uictest.rig.assembly import assemble
from uictest.rig.backends.compiled import (
    compile_inner,
    compiled_operations,
    compiler,
    translate,
)
from uictest.rig.backends.machine_code import Entries, Unit, address, native_function
from uictest.rig.model.cycle import command_valve
from uictest.rig.model.module_air import follow_tank
from uictest.rig.model.parameters import PARAMETERS, Parameters
from uictest.rig.model.pneumatics import move_valve
from uictest.rig.model.start import start_module
from uictest.rig.model.state import CAR, WHEELSET, Car, Wheelset
from uictest.rig.model.wheelset_parameters import (
    WHEELSET_PARAMETERS,
    WheelsetParameters,
    copy_wheelset_parameters,
)
from uictest.rig.noise_key import StopInputs

Samples = NDArray[np.float64]
_NAME = "uictest_modelled_pressure"
_ARGUMENTS = (CAR, WHEELSET, PARAMETERS, WHEELSET_PARAMETERS, "f8", "f8", "i8", "f8", int)


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
        simulation = case.scenario.simulation.model_copy(update={"time_step": step})
        self._case = _with(case, simulation=simulation)

    def __call__(self, unknowns: Samples) -> Samples:
        """Return gauge pressures, Pa, at the record's instants.

        Args:
            unknowns: heat conductances of tank and caliper, W/K; swept volume as a share of a tank's;
                opening pressure, and closing less opening pressure, gauge Pa.
        """
        return self._follow(assemble(_with_unknowns(self._case, unknowns)))

    def _follow(self, inputs: StopInputs) -> Samples:
        computed = np.empty(self._tank.size)
        follow = native_function(_UNIT, _NAME, len(_ARGUMENTS))
        car, wheelset, rows = np.zeros(1, CAR), np.zeros(1, WHEELSET), computed.shape
        follow(
            address(car, CAR, (1,)),
            address(wheelset, WHEELSET, (1,)),
            address(inputs.parameters, PARAMETERS),
            address(inputs.wheelset_parameters[0], WHEELSET_PARAMETERS),
            address(self._tank, "f8", rows),
            address(self._line, "f8", rows),
            address(self._commands, "i8", rows),
            address(computed, "f8", rows),
            computed.size,
        )
        return computed


def _with_unknowns(case: Case, unknowns: Samples) -> Case:
    tank, caliper, swept, opening, gap = map(float, unknowns)
    rig = case.scenario.rig
    values = {
        "tank_heat_conductance": tank,
        "caliper_heat_conductance": caliper,
        "swept_volume": swept * case.scenario.brake.system.tank.volume,
        "opening_pressure": opening,
        "closing_pressure": opening + gap,
    }
    air = rig.compensation_model.air.model_copy(update=values)
    model = rig.compensation_model.model_copy(update={"air": air})
    return _with(case, rig=rig.model_copy(update={"compensation_model": model}))


def _with(case: Case, **sections: object) -> Case:
    return replace(case, scenario=case.scenario.model_copy(update=sections))


def _entries() -> Entries:
    """Return the walk along a record as a function of addresses and its length."""
    carray = compiler().carray
    entry = translate(_follow, compile_inner, compiled_operations())

    def on_addresses(
        car: Any,
        wheelset: Any,
        p: Any,
        own: Any,
        tank: Any,
        line: Any,
        commands: Any,
        computed: Any,
        rows: int,
    ) -> int:
        entry(
            carray(car, 1)[0],
            carray(wheelset, 1)[0],
            carray(p, 1)[0],
            carray(own, 1)[0],
            carray(tank, rows),
            carray(line, rows),
            carray(commands, rows),
            carray(computed, rows),
        )
        return 0

    return {_NAME: (on_addresses, _ARGUMENTS)}


def _follow(
    car: Car,
    wheelset: Wheelset,
    p: Parameters,
    own: WheelsetParameters,
    tank: Any,
    line: Any,
    commands: Any,
    computed: Any,
) -> None:
    """Follow a record sample by sample and fill ``computed`` with gauge pressures, Pa."""
    copy_wheelset_parameters(wheelset, own)
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


_UNIT = Unit(_NAME, {_NAME: "the air of a record"}, _entries)
