"""An FMU as a controller for one stop.

An FMU is instantiated once per thread and reset between stops: some tools' FMUs fail after a thousand
instances. Each thread unpacks a copy of its library, so that static variables are not shared.
"""

from collections import defaultdict
from pathlib import Path
from threading import local

from uictest.controllers.adapters.fmu.loading import load_slave
from uictest.controllers.adapters.fmu.slave import Slave
from uictest.controllers.adapters.fmu.variables import ControllerVariables
from uictest.controllers.adapters.instance import CalledInstance, ControllerError
from uictest.controllers.declared import ControllerProgram
from uictest.controllers.interface import Config, Inputs, Outputs


class _Idle(local):
    """FMUs of a thread that no stop uses, by path and SHA-256."""

    def __init__(self) -> None:
        self.slaves: defaultdict[tuple[str, str], list[Slave]] = defaultdict(list)


_idle = _Idle()


def open_fmu(program: ControllerProgram, config: Config) -> "FmuInstance":
    """Take an idle FMU of this file, or load one. Raises ControllerError."""
    idle = _idle.slaves[program.location, program.sha256]
    slave = idle.pop() if idle else load_slave(Path(program.location), program.sha256)
    try:
        return FmuInstance(slave, idle, config, program.options.get("variables", {}))
    except ControllerError as error:
        idle.append(slave)
        raise ControllerError(f"{Path(program.location).name} {error}") from error


class FmuInstance(CalledInstance):
    """An FMU, for one stop."""

    def __init__(self, slave: Slave, idle: list[Slave], config: Config, names: dict[str, str]) -> None:
        super().__init__()
        slave.check_step_size(config.cycle_time)
        self.version = slave.description.version or ""
        self._slave = slave
        self._idle = idle
        self._cycle_time = config.cycle_time
        self._variables = ControllerVariables(slave, config, names)

    def reset(self) -> None:
        """Set all variables to their start values, parameters to those of the scenario, and initialise."""
        with self._slave.checked():
            self._slave.reset()
            self._variables.set_parameters()
            self._slave.enter_initialisation()
            self._variables.set_initial_inputs()
            self._slave.exit_initialisation()

    def step(self, inputs: Inputs) -> Outputs:
        """Set the inputs, make a step of one cycle, read the outputs."""
        with self._slave.checked():
            self._variables.set_inputs(inputs)
            self._slave.step(inputs.time, self._cycle_time)
            return self._variables.outputs()

    def close(self) -> None:
        """Keep the FMU for the next stop of this thread; one that has failed is released."""
        if self._slave.usable:
            self._idle.append(self._slave)
        else:
            self._slave.release()
