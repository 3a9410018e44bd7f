"""A controller that is exported: libraries with the functions of `uictest_controller.h` or one that is built
in, and its parameters.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from uictest import __version__, rig
from uictest.api.fmu.compiling import this_system
from uictest.api.fmu.variables import Variable
from uictest.controllers import (
    CONTROLLERS,
    INPUTS,
    Config,
    ControllerError,
    DeclaredParameter,
    parameter_problems,
    shown_version,
    stated_declarations,
)
from uictest.core import files
from uictest.core.units import KINDS
from uictest.plans.scenario.yaml import parse_quantity


class NotExportableError(Exception):
    """A controller cannot be an FMU; the message says what can."""


class Parameter(NamedTuple):
    """One parameter and its value where nobody sets it."""

    name: str
    value: Any
    unit: str = ""
    range: tuple[float, float] | None = None
    description: str = ""

    @property
    def is_variable(self) -> bool:
        """Whether the FMU has it as a variable: numbers and truth values, not texts, lists and mappings."""
        return isinstance(self.value, bool | int | float)

    def variable(self, path: str) -> Variable:
        """Return it as a variable whose value lies in a field."""
        is_truth = isinstance(self.value, bool)
        return Variable(
            self.name,
            path,
            self.description or f"Parameter {self.name} of the controller",
            "" if self.unit == "1" else self.unit,
            "boolean" if is_truth else "real",
            "parameter",
            start=json.dumps(self.value) if is_truth else repr(float(self.value)),
            range=self.range,
        )


class Exported(NamedTuple):
    """What is exported: libraries by the names of their systems, or a built-in one by its name."""

    libraries: Mapping[str, bytes]
    version: str
    parameters: tuple[Parameter, ...]
    contract: int
    algorithm: str = ""


def exported(part: Any, config: Config, libraries: Mapping[str, bytes] | None) -> Exported:
    """Return the controller of a scenario as it is exported.

    Args:
        part: the controller.
        config: what it is given while it is asked for its parameters.
        libraries: as :func:`~uictest.api.fmu.compiled` gives them; None: the part's own, for this system.

    Raises:
        NotExportableError: it is of a kind that cannot be exported.
        CannotBuildError: no FMU can run a library of this system.
        ControllerError: its library cannot be loaded, or creates no controller.
    """
    if part.program is None:
        return _built_in(part)
    if part.program.kind == "library":
        own = libraries or {this_system(): Path(part.program.location).read_bytes()}
        return _in_library(part, config, own)
    raise NotExportableError(
        f"a {part.tag} cannot be exported; accepted: a shared library (.so) or a part that names one, C"
        f" sources (.c), and the built-in controllers {', '.join(sorted(CONTROLLERS))}"
    )


def _in_library(part: Any, config: Config, libraries: Mapping[str, bytes]) -> Exported:
    """Ask a library for its version and parameters; it creates one controller, in a child process."""
    path = Path(part.program.location)
    with files.temporary_folder() as folder, rig.Workers() as workers:
        # Alone, as in the FMU: a library that it needs and that lies beside it is not there.
        files.write(folder, path.name, path.read_bytes())
        program = replace(part.program, location=str(folder / path.name))
        said = workers.drive(rig.DriveRequest(program, config, np.zeros(0, INPUTS)))
    declared: Any = part.declared_parameters or stated_declarations(said.declares or "{}")
    defaults = {name: each.default for name, each in declared.items() if each.default is not None}
    values = {**defaults, **part.parameters}
    if problems := [*parameter_problems(declared, values, free=True)]:
        raise ControllerError("; ".join(f"parameter {each.name}: {each}" for each in problems))
    parameters = []
    for name, value in values.items():
        each = declared.get(name)
        about = (each.unit, tuple(each.range) if each.range else None, each.description) if each else ()
        parameters.append(Parameter(name, value, *about))
    version = part.version or shown_version(said.version)
    return Exported(libraries, version, tuple(parameters), said.contract)


def parameter_of(name: str, value: float, declared: DeclaredParameter) -> Parameter:
    """Return a parameter of a built-in controller."""
    at_least, at_most = (
        float(parse_quantity(each, declared.kind)) for each in (declared.at_least, declared.at_most)
    )
    return Parameter(name, value, KINDS[declared.kind].canonical, (at_least, at_most), declared.description)


def _built_in(part: Any) -> Exported:
    controller = CONTROLLERS[part.algorithm]
    declared = {name: each for name, each in controller.declared_parameters().items() if name != "cycle_time"}
    parameters = (parameter_of(name, float(getattr(part, name)), each) for name, each in declared.items())
    return Exported({}, __version__, tuple(parameters), controller.contract, part.algorithm)
