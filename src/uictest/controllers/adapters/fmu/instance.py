"""An FMU as a controller for one stop, by our names of variables or by those that the scenario gives.

An FMU with an output that version 2 of the contract adds is of that version; any other is of version 1, and
what only version 2 has is then not set.

An FMU is instantiated once per thread and reset between stops: some tools' FMUs fail after a thousand
instances. Each thread unpacks a copy of its library, so that static variables are not shared.
"""

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from threading import local
from typing import Any, Final

from uictest.controllers.adapters.errors import ControllerError, OnlyOneError
from uictest.controllers.adapters.fmu.names import (
    BoundVariable,
    Declared,
    Values,
    VariableGroup,
    bind,
    bound_parameters,
    grouped,
)
from uictest.controllers.adapters.fmu.slave import Slave, load_slave
from uictest.controllers.adapters.instance import CalledInstance
from uictest.controllers.declared import ControllerProgram
from uictest.controllers.interface import WHEELSETS, Config, Inputs, Outputs

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
INPUTS_2: Final = (
    Declared("dynamic_brake", "input", WHEELSETS),
    Declared("axle_load", "input"),
    Declared("brake_command", "input"),
    Declared("train_speed", "input"),
    Declared("train_speed_valid", "input", is_whole=True),
    Declared("acceleration", "input"),
    Declared("acceleration_valid", "input", is_whole=True),
)
"""Set in every cycle as well, in version 2."""
OUTPUTS_2: Final = (
    Declared("dynamic_reduction", "output", WHEELSETS),
    Declared("sand_request", "output", WHEELSETS, is_whole=True),
    Declared("track_brake_request", "output", is_whole=True),
)
"""Read in every cycle as well, in version 2: having one of them makes an FMU one of that version."""
_BITS: Final = 0xFFFF_FFFF


class _Slaves:
    """Instances of one FMU: those that no stop uses, and those in use, of which the cars of a train need
    several.
    """

    def __init__(self) -> None:
        self.idle: list[Slave] = []
        self.in_use: list[Slave] = []

    def take(self, program: ControllerProgram) -> Slave:
        """Return an idle one, or load one. Raises ControllerError."""
        path = Path(program.location)
        others = self.in_use
        if others and others[0].description.coSimulation.canBeInstantiatedOnlyOncePerProcess:
            raise OnlyOneError(
                f"{path.name} can be instantiated only once in a process, so that only one car of a train can"
                " have it"
            )
        slave = self.idle.pop() if self.idle else load_slave(path, program.sha256)
        self.in_use.append(slave)
        return slave

    def give_back(self, slave: Slave) -> None:
        """Keep one for the next stop; one that has failed is released."""
        self.in_use.remove(slave)
        if slave.usable:
            self.idle.append(slave)
        else:
            slave.release()


class _OfThread(local):
    """The FMUs of a thread, by path and SHA-256."""

    def __init__(self) -> None:
        self.slaves: defaultdict[tuple[str, str], _Slaves] = defaultdict(_Slaves)


_of_thread = _OfThread()


def open_fmu(program: ControllerProgram, config: Config) -> "FmuInstance":
    """Take an idle FMU of this file, or load one. Raises ControllerError."""
    slaves = _of_thread.slaves[program.location, program.sha256]
    slave = slaves.take(program)
    try:
        return FmuInstance(slave, slaves, config, program.options.get("variables", {}))
    except ControllerError as error:
        slaves.give_back(slave)
        raise ControllerError(f"{Path(program.location).name} {error}") from error


class FmuInstance(CalledInstance):
    """An FMU, for one stop."""

    def __init__(self, slave: Slave, slaves: _Slaves, config: Config, names: Mapping[str, str]) -> None:
        super().__init__()
        slave.check_step_size(config.cycle_time)
        known = [declared.name for declared in (*INPUTS, *CONSTANTS, *OUTPUTS, *INPUTS_2, *OUTPUTS_2)]
        for name in names:
            if name not in known:
                raise ControllerError(f"has no use for variables.{name}; the keys are {', '.join(known)}")
        self.version = slave.description.version or ""
        self._slave = slave
        self._slaves = slaves
        self._config = config
        self.contract = 2 if bind(slave.description, OUTPUTS_2, names) else 1
        added = (INPUTS_2, OUTPUTS_2) if self.contract > 1 else ((), ())
        for each in INPUTS_2:
            if self.contract == 1 and each.name in names:
                needed = " or ".join(output.name for output in OUTPUTS_2)
                raise ControllerError(f"has no output {needed}: without one variables.{each.name} has no use")
        inputs, constants, outputs = (
            bind(slave.description, declared, names)
            for declared in ((*INPUTS, *added[0]), CONSTANTS, (*OUTPUTS, *added[1]))
        )
        parameters, self._parameter_values = bound_parameters(slave, config.parameters)
        self._inputs = grouped(slave, inputs)
        self._parameters = grouped(slave, [*constants, *parameters])
        self._outputs = grouped(slave, outputs)
        self._magnets = {name: _labels(outputs, name) for name in ("hold", "vent")}

    def reset(self) -> None:
        """Set all variables to their start values, parameters to those of the scenario, and initialise.

        The inputs are at first those of a train that rolls with its brakes released.
        """
        config = self._config
        constants = {
            "initial_speed": (config.initial_speed,),
            "cycle_time": (config.cycle_time,),
            "wheel_radius": config.wheel_radius,
        }
        speeds, pressures = (config.initial_speed,) * WHEELSETS, (0.0,) * WHEELSETS
        with self._slave.checked():
            self._slave.reset()
            _set(self._parameters, constants | self._parameter_values)
            with self._slave.initialising():
                self._set_inputs(Inputs(0, 0.0, speeds, (True,) * WHEELSETS, pressures, 0.0))

    def step(self, inputs: Inputs) -> Outputs:
        """Set the inputs, make a step of one cycle, read the outputs."""
        read: dict[str, list[Any]] = {
            "hold": [0] * WHEELSETS,
            "vent": [0] * WHEELSETS,
            "reference_speed": [math.nan],
            "diagnosis": [0],
            "dynamic_reduction": [0.0] * WHEELSETS,
            "sand_request": [0] * WHEELSETS,
            "track_brake_request": [0],
        }
        with self._slave.checked():
            self._set_inputs(inputs)
            self._slave.step(inputs.time, self._config.cycle_time)
            for group in self._outputs:
                group.get(read)
        hold, vent = (_magnets(read[name], self._magnets[name]) for name in ("hold", "vent"))
        answer = Outputs(hold, vent, read["reference_speed"][0], _bits(read["diagnosis"][0]))
        if self.contract > 1:
            answer.dynamic_reduction, answer.sand_request = read["dynamic_reduction"], read["sand_request"]
            answer.track_brake_request = read["track_brake_request"][0]
        return answer

    def close(self) -> None:
        """Keep the FMU for the next stop of this thread; one that has failed is released."""
        self._slaves.give_back(self._slave)

    def _set_inputs(self, inputs: Inputs) -> None:
        values = {
            "wheel_speed": inputs.wheel_speed,
            "speed_valid": inputs.speed_valid,
            "cylinder_pressure": inputs.cylinder_pressure,
            "brake_demand": (inputs.brake_demand,),
            "time": (inputs.time,),
            "cycle": (inputs.cycle,),
            "dynamic_brake": inputs.dynamic_brake,
            "axle_load": (inputs.axle_load,),
            "brake_command": (inputs.brake_command,),
            "train_speed": (inputs.train_speed,),
            "train_speed_valid": (inputs.train_speed_valid,),
            "acceleration": (inputs.acceleration,),
            "acceleration_valid": (inputs.acceleration_valid,),
        }
        _set(self._inputs, values)


def _set(groups: Sequence[VariableGroup], values: Values) -> None:
    for group in groups:
        group.set(values)


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
