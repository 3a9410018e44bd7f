"""A controller that is exported: a library with the functions of `uictest_controller.h`, and its parameters.

A library is taken as it is, C sources are compiled to one, a built-in controller is linked from machine code.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from uictest import __version__, rig
from uictest.api.fmu.building import SOURCES, link
from uictest.api.fmu.variables import Variable, place_of
from uictest.controllers import (
    CONTROLLERS,
    HEADER,
    INPUTS,
    Config,
    Controller,
    ControllerError,
    DeclaredParameter,
    parameter_problems,
    shown_version,
    stated_declarations,
)
from uictest.core import files
from uictest.core.units import KINDS
from uictest.plans.scenario.yaml import parse_quantity

_TARGET: Final = rig.Target("x86-64", in_library=True)
"""Every x86-64 processor: controllers have no operation that newer ones do otherwise."""


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
    """What is exported."""

    library: bytes
    version: str
    parameters: tuple[Parameter, ...]
    contract: int


def library_of_sources(compiler: str, sources: Sequence[Path]) -> bytes:
    """Return the shared library of a controller's C sources. Raises RuntimeError as the compiler says."""
    paths = [each.resolve() for each in sources]
    folders = dict.fromkeys((*(path.parent for path in paths), HEADER.parent))
    includes = [f"-I{folder}" for folder in folders]
    # An `assert` holds the name of its file: without the folders of this machine.
    names = [f"-ffile-prefix-map={folder}=." for folder in folders]
    return link(compiler, {}, ["-ffp-contract=off", *includes, *names, *map(str, paths), "-lm"])


def exported(part: Any, config: Config, compiler: str) -> Exported:
    """Return the controller of a scenario as it is exported.

    Raises:
        NotExportableError: it is of a kind that cannot be exported.
        ControllerError: its library cannot be loaded, or creates no controller.
        RuntimeError: the compiler failed; the message is its own.
    """
    if part.program is None:
        return _built_in(part, compiler)
    if part.program.kind == "library":
        return _in_library(part, config)
    raise NotExportableError(
        f"a {part.tag} cannot be exported; accepted: a shared library (.so) or a part that names one, C"
        f" sources (.c), and the built-in controllers {', '.join(sorted(CONTROLLERS))}"
    )


def _in_library(part: Any, config: Config) -> Exported:
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
    return Exported(path.read_bytes(), version, tuple(parameters), said.contract)


def parameter_of(name: str, value: float, declared: DeclaredParameter) -> Parameter:
    """Return a parameter of a built-in controller."""
    at_least, at_most = (
        float(parse_quantity(each, declared.kind)) for each in (declared.at_least, declared.at_most)
    )
    return Parameter(name, value, KINDS[declared.kind].canonical, (at_least, at_most), declared.description)


def _built_in(part: Any, compiler: str) -> Exported:
    controller = CONTROLLERS[part.algorithm]
    declared = {name: each for name, each in controller.declared_parameters().items() if name != "cycle_time"}
    code = rig.controller_code(controller, _TARGET)
    inputs = {
        "built_in.c": (SOURCES / "built_in.c").read_bytes(),
        HEADER.name: HEADER.read_bytes(),
        "memory.h": _memory_header(controller, tuple(declared), code.function).encode(),
        "code.o": code.content,
    }
    library = link(compiler, inputs, ["built_in.c", "code.o", "-lm"])
    parameters = (parameter_of(name, float(getattr(part, name)), each) for name, each in declared.items())
    return Exported(library, __version__, tuple(parameters), controller.contract)


def _memory_header(controller: Controller, parameters: Sequence[str], function: str) -> str:
    """Return `memory.h`: the name of the machine code, and places in its memory."""
    memory = rig.controller_memory(controller)
    places = {name: place_of(memory, f"parameters.{name}")[0] for name in ("cycle_time", *parameters)}
    rows = (f"{{{json.dumps(json.dumps(name) + ':')}, {places[name]}}}" for name in parameters)
    lines = {
        "UICTEST_ABI_VERSION": controller.contract,
        "FUNCTION": function,
        "MEMORY_SIZE": memory.itemsize,
        "REMEMBERED_SIZE": memory.fields["parameters"][1],
        "CYCLE_TIME_AT": places["cycle_time"],
        "INITIAL_SPEED_AT": memory.fields["initial_speed"][1],
        "PARAMETER_ROWS": ", ".join(rows),
    }
    return "".join(f"#define {name} {value}\n" for name, value in lines.items())
