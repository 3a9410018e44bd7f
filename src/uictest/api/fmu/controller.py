"""A controller as an FMU: its variables, and what they become for the controller."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from html import escape
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from uictest import __version__, rig
from uictest.api.fmu.binaries import SYSTEMS
from uictest.api.fmu.building import archive_of
from uictest.api.fmu.description import FmiVersion, Model, page, table, table_of_variables
from uictest.api.fmu.exported import Exported, NotExportableError, Parameter, exported, parameter_of
from uictest.api.fmu.resource import Content
from uictest.api.fmu.variables import Variable, of_wheelsets
from uictest.controllers import CONTROLLERS, DEFAULT, EXCHANGE, Config, ControllerProgram
from uictest.plans import scenario


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
"""Those that are no parameters. A scenario finds all of them by these names."""


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
        _fmu(part.label, controller, config, version), tuple(_notes(part.program, controller))
    )


def _notes(program: ControllerProgram | None, controller: Exported) -> Iterator[str]:
    for each in controller.parameters:
        if not each.is_variable:
            yield f"the parameter {each.name} is no number: it cannot be set in the FMU"
    if controller.libraries and len(controller.libraries) < len(SYSTEMS):
        yield (
            f"the FMU is for {' and '.join(controller.libraries)} alone; from its C sources, with ziglang"
            f" installed, it is for {', '.join(SYSTEMS)}"
        )
    folder = str(Path(program.location).parent) if program is not None else "/"
    if folder != "/" and any(folder.encode() in each for each in controller.libraries.values()):
        yield f"the library holds the name of the folder {folder}: build it without -g, or use `strip -g`"


def _fmu(name: str, controller: Exported, config: Config, version: FmiVersion) -> bytes:
    paths = _paths_of_parameters(controller)
    start = _start(controller, config, paths)
    model = Model(
        name=f"controller {name}",
        identifier=re.sub(r"\W", "_", f"controller_{name}", flags=re.ASCII),
        description=f"Wheel-slide-protection controller {name}",
        version=controller.version,
        variables=_variables(controller, config, paths),
        can_save=not controller.libraries,
    )
    libraries = {
        f"resources/{SYSTEMS[system].folder}/controller.{SYSTEMS[system].suffix}": library
        for system, library in controller.libraries.items()
    }
    return archive_of(
        model,
        version,
        _content(controller, start, paths),
        {**libraries, "documentation/index.html": _page(model, libraries)},
        controller.libraries or SYSTEMS,
    )


_OUTSIDE: Final[Any] = np.dtype(
    [("exchange", EXCHANGE), ("parameters", [("cycle_time", "f8"), ("initial_speed", "f8")])]
)
"""What an instance remembers of a controller in a library, which has a memory of its own."""
_PATHS: Final = {
    "exchange": "exchange",
    "time": "time",
    "cycle_time": "parameters.cycle_time",
    "initial_speed": "parameters.initial_speed",
    "wheel_radius": "wheel_radius",
}
"""Name of a place -> path in the memory of an instance."""


def _paths_of_parameters(controller: Exported) -> dict[str, str]:
    """Return where the parameters lie in the memory of an instance."""
    if not controller.libraries:
        return {each.name: f"parameters.{each.name}" for each in controller.parameters}
    own = (each for each in controller.parameters if each.is_variable)
    return {each.name: f"parameter_{place}" for place, each in enumerate(own)}


def _start(controller: Exported, config: Config, paths: Mapping[str, str]) -> Any:
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
        names = [each.name for each in rig.CHOICES]
        parameters["controller"] = names.index(controller.algorithm)
    for each in controller.parameters:
        if each.is_variable:
            folder, _, name = paths[each.name].rpartition(".")
            (start[folder] if folder else start)[name] = each.value
    return start


def _content(controller: Exported, start: Any, paths: Mapping[str, str]) -> Content:
    if controller.libraries:
        return Content("library", start, _PATHS, json=[*_json(controller, paths)])
    given = tuple(start[0][name] for name in rig.CONTROLLER_MEMORY.names)
    return Content("built_in", start, _PATHS, [*rig.placed(rig.ALONE.arguments, given, start)])


def _json(controller: Exported, paths: Mapping[str, str]) -> Iterator[tuple[str, str, str]]:
    """Yield the parameters as the library writes them into the JSON object that the controller is given."""
    for each in controller.parameters:
        key = f"{json.dumps(each.name)}: "
        if each.is_variable:
            yield "truth" if isinstance(each.value, bool) else "number", key, paths[each.name]
        else:
            yield "fixed", key + json.dumps(each.value), ""


def _variables(controller: Exported, config: Config, paths: Mapping[str, str]) -> tuple[Variable, ...]:
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
    own = [each for each in controller.parameters if each.is_variable]
    for name in {each.name for each in own}.intersection(each.name for each in variables):
        raise NotExportableError(f"the parameter {name} has the name of a variable of the FMU: rename it")
    return (*variables, *(each.variable(paths[each.name]) for each in own))


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
