"""The variables of an FMU that a controller needs, by our names or by those that the scenario gives."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

from uictest.controllers.adapters.fmu.names import (
    BoundVariable,
    Declared,
    Values,
    VariableGroup,
    bind,
    bound_parameters,
    grouped,
)
from uictest.controllers.adapters.fmu.slave import Slave
from uictest.controllers.adapters.instance import ControllerError
from uictest.controllers.exchange import WHEELSETS
from uictest.controllers.interface import Config, Inputs, Outputs

INPUTS: Final = (
    Declared("wheel_speed", "input", WHEELSETS, is_needed=True),
    Declared("speed_valid", "input", WHEELSETS, is_whole=True),
    Declared("cylinder_pressure", "input", WHEELSETS),
    Declared("brake_demand", "input"),
    Declared("time", "input"),
    Declared("cycle", "input", is_whole=True),
)
"""Set in every cycle."""
CONSTANTS: Final = (
    Declared("initial_speed", "parameter"),
    Declared("cycle_time", "parameter"),
    Declared("wheel_radius", "parameter", WHEELSETS),
)
"""Set before a stop."""
OUTPUTS: Final = (
    Declared("hold", "output", WHEELSETS, is_whole=True, is_needed=True),
    Declared("vent", "output", WHEELSETS, is_whole=True, is_needed=True),
    Declared("reference_speed", "output"),
    Declared("diagnosis", "output", is_whole=True),
)
"""Read in every cycle."""
_BITS: Final = 0xFFFF_FFFF


class ControllerVariables:
    """The variables of an FMU, set from what a controller is given and read as what it answers."""

    def __init__(self, slave: Slave, config: Config, names: Mapping[str, str]) -> None:
        _check_names(names)
        inputs, constants, outputs = (
            bind(slave.description, declared, names) for declared in (INPUTS, CONSTANTS, OUTPUTS)
        )
        parameters, values = bound_parameters(slave, config.parameters)
        self._inputs = grouped(slave, "Set", inputs)
        self._parameters = grouped(slave, "Set", [*constants, *parameters])
        self._parameter_values = _constants(config) | values
        self._initial_inputs = _input_values(_initial_inputs(config))
        self._outputs = grouped(slave, "Get", outputs)
        self._magnets = {name: _labels(outputs, name) for name in ("hold", "vent")}

    def set_parameters(self) -> None:
        """Set the parameters of the scenario and what a controller is given once."""
        _set(self._parameters, self._parameter_values)

    def set_initial_inputs(self) -> None:
        """Set the inputs of a train that rolls with its brakes released."""
        _set(self._inputs, self._initial_inputs)

    def set_inputs(self, inputs: Inputs) -> None:
        """Set the inputs of a cycle."""
        _set(self._inputs, _input_values(inputs))

    def outputs(self) -> Outputs:
        """Read the answer. Raises ControllerError where it is none."""
        read: dict[str, list[Any]] = {
            "hold": [0] * WHEELSETS,
            "vent": [0] * WHEELSETS,
            "reference_speed": [math.nan],
            "diagnosis": [0],
        }
        for group in self._outputs:
            group.get(read)
        hold, vent = (_magnets(read[name], self._magnets[name]) for name in ("hold", "vent"))
        return Outputs(hold, vent, read["reference_speed"][0], _bits(read["diagnosis"][0]))


def _check_names(names: Mapping[str, str]) -> None:
    known = [declared.name for declared in (*INPUTS, *CONSTANTS, *OUTPUTS)]
    for name in names:
        if name not in known:
            raise ControllerError(f"has no use for variables.{name}; the keys are {', '.join(known)}")


def _set(groups: Sequence[VariableGroup], values: Values) -> None:
    for group in groups:
        group.set(values)


def _constants(config: Config) -> dict[str, Sequence[Any]]:
    return {
        "initial_speed": (config.initial_speed,),
        "cycle_time": (config.cycle_time,),
        "wheel_radius": config.wheel_radius,
    }


def _initial_inputs(config: Config) -> Inputs:
    speeds = (config.initial_speed,) * WHEELSETS
    return Inputs(0, 0.0, speeds, (True,) * WHEELSETS, (0.0,) * WHEELSETS, 0.0)


def _input_values(inputs: Inputs) -> Values:
    return {
        "wheel_speed": inputs.wheel_speed,
        "speed_valid": inputs.speed_valid,
        "cylinder_pressure": inputs.cylinder_pressure,
        "brake_demand": (inputs.brake_demand,),
        "time": (inputs.time,),
        "cycle": (inputs.cycle,),
    }


def _labels(outputs: Sequence[BoundVariable], name: str) -> list[str]:
    """Return what the FMU calls the four magnets of a name."""
    of_place = {
        place: each.label(index)
        for each in outputs
        for index, (own, place) in enumerate(each.slots)
        if own == name
    }
    return [of_place[place] for place in range(WHEELSETS)]


def _magnets(values: Sequence[Any], labels: Sequence[str]) -> list[int]:
    for value, label in zip(values, labels, strict=True):
        if value not in (0, 1):
            raise ControllerError(f"{label} is {value!r}, expected 0 or 1")
    return [int(value) for value in values]


def _bits(value: Any) -> int:
    """Return 32 bits; an Integer of FMI 2.0 has a sign."""
    if not math.isfinite(value) or value != int(value):
        raise ControllerError(f"diagnosis is {value!r}, expected a whole number of 32 bits")
    return int(value) & _BITS
