"""A controller as an FMU: its variables, and what they become in the functions of `uictest_controller.h`."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from uictest import __version__
from uictest.api.fmu.building import archive_of, token_of
from uictest.api.fmu.description import FmiVersion, Model, page, table, table_of_variables
from uictest.api.fmu.exported import Exported, NotExportableError, Parameter, exported, parameter_of
from uictest.api.fmu.variables import Variable, c_words, model_header, of_wheelsets, place_of
from uictest.controllers import CONTROLLERS, DEFAULT, HEADER, INPUTS, OUTPUTS, Config, ControllerProgram
from uictest.plans import scenario

_LIBRARY: Final = "controller.so"
"""The controller, beside the shared library of the FMU."""


def _input(name: str, description: str, unit: str = "", *, truth: str = "") -> Variable:
    kind, start = ("boolean", truth) if truth else ("real", "0.0")
    return Variable(name, f"inputs.{name}", description, unit, kind, "input", start=start)  # type: ignore[arg-type]


def _output(name: str, description: str, unit: str = "", kind: Any = "boolean") -> Variable:
    return Variable(name, f"outputs.{name}", description, unit, kind)


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


def build_controller_fmu(part: Any, version: FmiVersion, compiler: str) -> ControllerFmu:
    """Return the controller of a scenario as an FMU.

    Args:
        part: the controller.
        version: of FMI.
        compiler: as :func:`~uictest.api.fmu.usable_compiler` gives it.

    Raises:
        NotExportableError: it is of a kind that cannot be exported, or has a parameter that cannot.
        ControllerError: its library cannot be loaded, or creates no controller.
        RuntimeError: the compiler failed; the message is its own.
    """
    vehicle: Any = scenario.load_part("vehicles/intercity-180")
    radii = (float(vehicle.wheelset.radius),) * 4
    config = Config(4, float(part.cycle_time), 0.0, radii, getattr(part, "parameters", {}))
    controller = exported(part, config, compiler)
    return ControllerFmu(
        _fmu(part.label, controller, config, version, compiler), tuple(_notes(part.program, controller))
    )


def _notes(program: ControllerProgram | None, controller: Exported) -> Iterator[str]:
    for each in controller.parameters:
        if not each.is_variable:
            yield f"the parameter {each.name} is no number: it cannot be set in the FMU"
    folder = str(Path(program.location).parent) if program is not None else "/"
    if folder != "/" and folder.encode() in controller.library:
        yield f"the library holds the name of the folder {folder}: build it without -g, or use `strip -g`"


def _fmu(name: str, controller: Exported, config: Config, version: FmiVersion, compiler: str) -> bytes:
    paths = {each.name: f"parameter_{place}" for place, each in enumerate(controller.parameters)}
    memory = np.dtype(
        [
            *(("inputs", INPUTS), ("outputs", OUTPUTS), ("time", "f8")),
            *(("cycle_time", "f8"), ("initial_speed", "f8"), ("wheel_radius", "f8", 4)),
            *((path, "f8") for path in paths.values()),
        ]
    )
    variables = _variables(controller, config, paths)
    given = _given_header(controller, config, memory, paths)
    about = f"{version} {name} {controller.version} {variables} {given}"
    model = Model(
        name=f"controller {name}",
        identifier=re.sub(r"\W", "_", f"controller_{name}", flags=re.ASCII),
        token=token_of(about.encode(), controller.library),
        description=f"Wheel-slide-protection controller {name}",
        version=controller.version,
        variables=variables,
    )
    return archive_of(
        model,
        version,
        compiler,
        sources=["controller.c"],
        generated={
            "model.h": model_header(model.token, memory, variables, _PLACES, can_save=False).encode(),
            "given.h": given.encode(),
            HEADER.name: HEADER.read_bytes(),
        },
        inputs=["-ldl"],
        beside={_LIBRARY: controller.library},
        others={"documentation/index.html": _page(model, controller)},
    )


_PLACES: Final = {
    "INPUTS_AT": "inputs",
    "OUTPUTS_AT": "outputs",
    "TIME_AT": "time",
    "CYCLE_TIME_AT": "cycle_time",
    "INITIAL_SPEED_AT": "initial_speed",
    "WHEEL_RADIUS_AT": "wheel_radius",
}
"""Name in C -> field of the memory of an instance."""


def _variables(controller: Exported, config: Config, paths: dict[str, str]) -> tuple[Variable, ...]:
    cycle_time = CONTROLLERS[DEFAULT].declared_parameters()["cycle_time"]
    speed = Parameter("initial_speed", config.initial_speed, "m/s", None, "Of the train at the brake command")
    radius = Parameter("wheel_radius", config.wheel_radius[0], "m", None, "That its speed is computed with")
    variables = (
        *VARIABLES,
        *(VARIABLES_2 if controller.contract > 1 else ()),
        speed.variable("initial_speed"),
        parameter_of("cycle_time", config.cycle_time, cycle_time).variable("cycle_time"),
        *of_wheelsets(radius.variable("wheel_radius")),
    )
    own = [each for each in controller.parameters if each.is_variable]
    for name in {each.name for each in own}.intersection(each.name for each in variables):
        raise NotExportableError(f"the parameter {name} has the name of a variable of the FMU: rename it")
    return (*variables, *(each.variable(paths[each.name]) for each in own))


def _given_header(controller: Exported, config: Config, memory: Any, paths: dict[str, str]) -> str:
    """Return `given.h`: the memory at the start, and what becomes of it in the controller's JSON."""
    start = np.zeros(1, memory)
    start["inputs"]["speed_valid"], start["outputs"]["reference_speed"] = 1, np.nan
    for name in ("cycle_time", "initial_speed", "wheel_radius"):
        start[name] = getattr(config, name)
    rows = []
    for each in controller.parameters:
        key = f"{json.dumps(each.name)}: "
        if each.is_variable:
            start[paths[each.name]] = each.value
            form = "TRUTH" if isinstance(each.value, bool) else "NUMBER"
            rows.append((form, key, place_of(memory, paths[each.name])[0]))
        else:
            rows.append(("FIXED", key + json.dumps(each.value), 0))
    lines = [
        f'#define LIBRARY "{_LIBRARY}"',
        f"#define LONGEST_JSON {sum(len(text) + _LONGEST_NUMBER for _, text, _ in rows) + len('{}') + 1}",
        *c_words("START", start),
        "#define GIVEN_ROWS \\",
        *(f"    {{{form}, {json.dumps(text)}, {offset}}}, \\" for form, text, offset in rows),
        '    {END, "", 0}',
    ]
    return "".join(f"{line}\n" for line in lines)


_LONGEST_NUMBER: Final = len(", -1.2345678901234567e-300")


def _page(model: Model, controller: Exported) -> bytes:
    digest = hashlib.sha256(controller.library).hexdigest()
    facts = (("version", controller.version), ("exported by", f"uictest {__version__}"), (_LIBRARY, digest))
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
