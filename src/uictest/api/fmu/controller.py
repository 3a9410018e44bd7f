"""A controller as an FMU: its variables, and what they become for the controller."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from uictest import __version__, rig
from uictest.api.fmu.building import SYSTEMS, archive_of, this_system
from uictest.api.fmu.description import (
    FmiVersion,
    Model,
    Variable,
    of_wheelsets,
    page,
    table,
    table_of_variables,
)
from uictest.api.fmu.resource import Content
from uictest.controllers import (
    CONTROLLERS,
    DEFAULT,
    EXCHANGE,
    INPUTS,
    Config,
    ControllerError,
    ControllerProgram,
    DeclaredParameter,
    parameter_problems,
    shown_version,
    stated_declarations,
)
from uictest.core import files
from uictest.core.units import KINDS
from uictest.plans import scenario
from uictest.plans.scenario.yaml import parse_quantity


def _input(name: str, description: str, unit: str = "", *, truth: str = "") -> Variable:
    kind, start = ("boolean", truth) if truth else ("real", "0.0")
    return Variable(name, f"exchange.{name}", description, unit, kind, "input", start=start)  # type: ignore[arg-type]


def _output(name: str, description: str, unit: str = "", kind: Any = "boolean") -> Variable:
    return Variable(name, f"exchange.{name}", description, unit, kind)


VARIABLES: Final = (
    Variable("time", "time", "Time of the simulation", "s", causality="independent"),
    *of_wheelsets(
        _input("wheel_speed", "Circumferential, as its sensor gives it", "m/s"),
        _input("speed_valid", "False where the speed sensor reports a fault", truth="true"),
        _input("cylinder_pressure", "Above atmospheric, as its sensor gives it", "Pa"),
    ),
    _input("brake_demand", "Share of full service; a brake is demanded above 0"),
    *of_wheelsets(
        _output("hold", "Holding magnet energised"),
        _output("vent", "Venting magnet energised, only with the holding magnet"),
    ),
    _output("reference_speed", "Estimated speed of the train; NaN: none", "m/s", "real"),
    _output("diagnosis", "32 bits of the controller's own", kind="integer"),
)
"""Variables other than parameters. A scenario finds all of them by these names."""


VARIABLES_2: Final = (
    *of_wheelsets(_input("dynamic_brake", "What the motor gives of what it could at its speed")),
    _input("axle_load", "Of one axle at rest", "N"),
    _input("brake_command", "Share of full service, before the delays of the brake"),
    _input("train_speed", "From outside the wheelsets; 0 where it is not valid", "m/s"),
    _input("train_speed_valid", "False without such a source, and while it is lost", truth="false"),
    _input("acceleration", "As an accelerometer on the car shows it; 0 where it is not valid", "m/s2"),
    _input("acceleration_valid", "False without an accelerometer", truth="false"),
    *of_wheelsets(
        _output("dynamic_reduction", "Share that is taken off the dynamic brake", kind="real"),
        _output("sand_request", "Asks for sand"),
    ),
    _output("track_brake_request", "Asks for the track brake"),
)
"""Further ones of a controller of contract version 2."""


class ControllerFmu(NamedTuple):
    """The file of an FMU, and what its user should know of it."""

    content: bytes
    notes: tuple[str, ...]


def build_controller_fmu(
    part: Any, version: FmiVersion, libraries: Mapping[str, bytes] | None = None
) -> ControllerFmu:
    """Return the controller of a scenario as an FMU.

    Args:
        part: the controller.
        version: of FMI.
        libraries: as :func:`~uictest.api.fmu.compiled` gives them; None: the part's own, for this system.

    Raises:
        NotExportableError: it is of a kind that cannot be exported, or has a parameter that cannot.
        CannotBuildError: this package has no library of FMUs, or no FMU can run a library of this system.
        ControllerError: its library cannot be loaded, or creates no controller.
    """
    vehicle: Any = scenario.load_part("vehicles/intercity-180")
    radii = (float(vehicle.wheelset.radius),) * 4
    config = Config(4, float(part.cycle_time), 0.0, radii, getattr(part, "parameters", {}))
    controller = exported(part, config, libraries)
    return ControllerFmu(
        _packed_fmu(part.label, controller, config, version),
        tuple(_notes_for_people(part.program, controller)),
    )


def _notes_for_people(program: ControllerProgram | None, controller: Exported) -> Iterator[str]:
    for parameter in controller.parameters:
        if not parameter.is_variable:
            yield f"the parameter {parameter.name} is no number: it cannot be set in the FMU"
    if controller.libraries and len(controller.libraries) < len(SYSTEMS):
        yield (
            f"the FMU is for {' and '.join(controller.libraries)} alone; from its C sources, with ziglang"
            f" installed, it is for {', '.join(SYSTEMS)}"
        )
    folder = str(Path(program.location).parent) if program is not None else "/"
    if folder != "/" and any(folder.encode() in library for library in controller.libraries.values()):
        yield f"the library holds the name of the folder {folder}: build it without -g, or use `strip -g`"


def _packed_fmu(name: str, controller: Exported, config: Config, version: FmiVersion) -> bytes:
    paths = _paths_of_parameters(controller)
    start = _initial_memory(controller, config, paths)
    model = Model(
        name=f"controller {name}",
        identifier=re.sub(r"\W", "_", f"controller_{name}", flags=re.ASCII),
        description=f"Wheel-slide-protection controller {name}",
        version=controller.version,
        variables=_variables_of_controller(controller, config, paths),
        can_save=not controller.libraries,
    )
    libraries = {
        f"resources/{SYSTEMS[system].folder}/controller.{SYSTEMS[system].suffix}": library
        for system, library in controller.libraries.items()
    }
    return archive_of(
        model,
        version,
        _model_content(controller, start, paths),
        {**libraries, "documentation/index.html": _page(model, libraries)},
        controller.libraries or SYSTEMS,
    )


_OUTSIDE: Final[Any] = np.dtype(
    [("exchange", EXCHANGE), ("parameters", [("cycle_time", "f8"), ("initial_speed", "f8")])]
)
"""Memory of an instance for a controller in a library, which keeps its own state."""
_PATHS: Final = {
    "exchange": "exchange",
    "time": "time",
    "cycle_time": "parameters.cycle_time",
    "initial_speed": "parameters.initial_speed",
    "wheel_radius": "wheel_radius",
}
"""Name of a place -> path in the memory of an instance."""


def _paths_of_parameters(controller: Exported) -> dict[str, str]:
    if not controller.libraries:
        return {parameter.name: f"parameters.{parameter.name}" for parameter in controller.parameters}
    settable = (parameter for parameter in controller.parameters if parameter.is_variable)
    return {parameter.name: f"parameter_{number}" for number, parameter in enumerate(settable)}


def _initial_memory(controller: Exported, config: Config, paths: Mapping[str, str]) -> Any:
    """Return the memory of an instance before anybody sets a variable."""
    own = _OUTSIDE if controller.libraries else rig.CONTROLLER_MEMORY
    fields = [(name, own[name]) for name in own.names]
    numbers = [path for path in paths.values() if path.startswith("parameter_")]
    others = [("time", "f8"), ("wheel_radius", "f8", 4), *((path, "f8") for path in numbers)]
    start = np.zeros(1, [*fields, *others])
    start["exchange"]["speed_valid"], start["exchange"]["reference_speed"] = 1, np.nan
    start["wheel_radius"] = config.wheel_radius
    parameters = start["parameters"]
    parameters["cycle_time"], parameters["initial_speed"] = config.cycle_time, config.initial_speed
    if controller.algorithm:
        names = [choice.name for choice in rig.CHOICES]
        parameters["controller"] = names.index(controller.algorithm)
    for parameter in controller.parameters:
        if parameter.is_variable:
            folder, _, name = paths[parameter.name].rpartition(".")
            (start[folder] if folder else start)[name] = parameter.value
    return start


def _model_content(controller: Exported, start: Any, paths: Mapping[str, str]) -> Content:
    if controller.libraries:
        return Content("library", start, _PATHS, json=[*_json_rows(controller, paths)])
    given = tuple(start[0][name] for name in rig.CONTROLLER_MEMORY.names)
    return Content("built_in", start, _PATHS, [*rig.placed(rig.ALONE.arguments, given, start)])


def _json_rows(controller: Exported, paths: Mapping[str, str]) -> Iterator[tuple[str, str, str]]:
    """Yield the parameters as the library writes them into the JSON object that the controller is given."""
    for parameter in controller.parameters:
        key = f"{json.dumps(parameter.name)}: "
        if parameter.is_variable:
            yield "truth" if isinstance(parameter.value, bool) else "number", key, paths[parameter.name]
        else:
            yield "fixed", key + json.dumps(parameter.value), ""


def _variables_of_controller(
    controller: Exported, config: Config, paths: Mapping[str, str]
) -> tuple[Variable, ...]:
    cycle_time = CONTROLLERS[DEFAULT].declared_parameters()["cycle_time"]
    speed = Parameter("initial_speed", config.initial_speed, "m/s", None, "Of the train at the brake command")
    radius = Parameter("wheel_radius", config.wheel_radius[0], "m", None, "That its speed is computed with")
    variables = (
        *VARIABLES,
        *(VARIABLES_2 if controller.contract > 1 else ()),
        speed.variable(_PATHS["initial_speed"]),
        parameter_of("cycle_time", config.cycle_time, cycle_time).variable(_PATHS["cycle_time"]),
        *of_wheelsets(radius.variable("wheel_radius")),
    )
    settable = [parameter for parameter in controller.parameters if parameter.is_variable]
    for name in {parameter.name for parameter in settable}.intersection(
        parameter.name for parameter in variables
    ):
        raise NotExportableError(f"the parameter {name} has the name of a variable of the FMU: rename it")
    return (*variables, *(parameter.variable(paths[parameter.name]) for parameter in settable))


def _page(model: Model, libraries: Mapping[str, bytes]) -> bytes:
    digests = ((name, hashlib.sha256(library).hexdigest()) for name, library in libraries.items())
    facts = (("version", model.version), ("exported by", f"uictest {__version__}"), *digests)
    note = (
        "Each step is a controller cycle, as long as the parameter cycle_time says: the inputs are read, and"
        " the outputs are the answer to them. Set initial_speed and the wheel radii to those of the train."
    )
    return page(
        model.description,
        f"<p>{escape(note)}</p>",
        *table(("controller", "version or SHA-256"), facts),
        *table_of_variables(model.variables),
    )


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
    """An exported controller: libraries by the names of their systems, or a built-in one by its name."""

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
        drives = workers.drive(rig.DriveRequest(program, config, np.zeros(0, INPUTS)))
    declared: Any = part.declared_parameters or stated_declarations(drives.declares or "{}")
    defaults = {
        name: declaration.default for name, declaration in declared.items() if declaration.default is not None
    }
    values = {**defaults, **part.parameters}
    if problems := [*parameter_problems(declared, values, free=True)]:
        raise ControllerError(
            "; ".join(f"parameter {declaration.name}: {declaration}" for declaration in problems)
        )
    parameters = []
    for name, value in values.items():
        declaration = declared.get(name)
        about = (
            (
                declaration.unit,
                tuple(declaration.range) if declaration.range else None,
                declaration.description,
            )
            if declaration
            else ()
        )
        parameters.append(Parameter(name, value, *about))
    version = part.version or shown_version(drives.version)
    return Exported(libraries, version, tuple(parameters), drives.contract)


def parameter_of(name: str, value: float, declared: DeclaredParameter) -> Parameter:
    """Return a parameter of a built-in controller."""
    at_least, at_most = (
        float(parse_quantity(bound, declared.kind)) for bound in (declared.at_least, declared.at_most)
    )
    return Parameter(name, value, KINDS[declared.kind].canonical, (at_least, at_most), declared.description)


def _built_in(part: Any) -> Exported:
    controller = CONTROLLERS[part.algorithm]
    declared = {
        name: declaration
        for name, declaration in controller.declared_parameters().items()
        if name != "cycle_time"
    }
    parameters = (
        parameter_of(name, float(getattr(part, name)), declaration) for name, declaration in declared.items()
    )
    return Exported({}, __version__, tuple(parameters), controller.contract, part.algorithm)
