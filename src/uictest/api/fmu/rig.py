"""The rig of one case as an FMU: its variables, what its library reads, and what the FMU says of it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from uictest import __version__, rig
from uictest.api.fmu.building import archive_of
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
from uictest.controllers import OUTPUTS, UNTOUCHED
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import STEP, StopInputs, bench

INSTANCE_MEMORY: Final[Any] = np.dtype(
    [("stop", rig.train_memory(1)), ("time", "f8"), ("ended", "i8"), ("commands", OUTPUTS)]
)
"""A stop, the time of the simulation, whether the stop has ended, and the commands as last set."""


def _command_variable(name: str, description: str, kind: Literal["real", "boolean"] = "boolean") -> Variable:
    start = "false" if kind == "boolean" else "0.0"
    return Variable(name, f"commands.{name}", description, "", kind, "input", start=start)


def _sensor_variable(
    name: str, description: str, unit: str = "", kind: Literal["real", "boolean"] = "real", field: str = ""
) -> Variable:
    """Return the variable of a sensor; `field`: its field in the exchange, where that has another name."""
    return Variable(name, f"stop.exchange.{field or name}", description, unit, kind)


def _true_value_variable(name: str, description: str, unit: str = "") -> Variable:
    return Variable(name, f"stop.modules.{name.removeprefix('true_')}", description, unit)


VARIABLES: Final = (
    Variable("time", "time", "Time of the simulation", "s", causality="independent"),
    *of_wheelsets(
        _command_variable("hold", "Holding magnet energised"),
        _command_variable("vent", "Venting magnet energised; forbidden without the holding magnet"),
        _sensor_variable("wheel_speed", "Circumferential, as its sensor shows it", "m/s"),
        _sensor_variable("speed_valid", "False where the speed sensor reports a fault", kind="boolean"),
        _sensor_variable(
            "cylinder_pressure", "Brake cylinder pressure above atmospheric, as its sensor shows it", "Pa"
        ),
    ),
    _sensor_variable("brake_demand", "Share of full service; a brake is demanded above 0"),
    Variable("train_speed", "stop.train.speed", "True speed of the train", "m/s"),
    Variable("distance", "stop.train.distance", "Distance since the brake command", "m"),
    Variable("brake_line_pressure", "stop.train.brake_line_pressure", "Above atmospheric", "Pa"),
    Variable("reservoir_pressure", "stop.train.reservoir_pressure", "Above atmospheric", "Pa"),
    Variable("stopped", "stop.car.stopped", "The train stands, or is at `until`", kind="boolean"),
    Variable(
        *("ended", "ended", "The train stands or the longest duration has passed; outputs stay"),
        kind="boolean",
    ),
    Variable("braking_distance", "stop.car.stop_position", "0 until the train stands, or is at `until`", "m"),
    Variable("braking_time", "stop.car.stop_time", "0 until the train stands, or is at `until`", "s"),
    *of_wheelsets(
        _true_value_variable("true_wheel_speed", "True circumferential speed", "m/s"),
        _true_value_variable("slide", "1 - true wheel speed / train speed; 0 below 1 m/s"),
        _true_value_variable("friction", "Friction coefficient of the rail under the wheelset"),
        _true_value_variable("adhesion", "Adhesion in use"),
        _true_value_variable("wheel_load", "Load of one wheel", "N"),
        _true_value_variable("tank_pressure", "True pressure above atmospheric", "Pa"),
        _true_value_variable("clamping_force", "Clamping force of one caliper", "N"),
        _true_value_variable("brake_torque", "Brake torque of the wheelset", "N.m"),
    ),
    Variable("seed", "stop.parameters.seed", "Seed of noise and random rails", "", "integer", "parameter"),
)
"""In the order of their value references, from 0."""
VARIABLES_2: Final = (
    *of_wheelsets(
        _command_variable("dynamic_reduction", "Share that is taken off the dynamic brake, 0 to 1", "real"),
        _command_variable("sand_request", "Asks for sand; obeyed by sanders with `when: requested`"),
        _sensor_variable(
            "dynamic_brake", "What the motor gives of what it could at its speed; 0 without a motor"
        ),
    ),
    _command_variable("track_brake_request", "Asks for the track brake; obeyed with `when: requested`"),
    _sensor_variable("axle_load", "Of one axle at rest", "N"),
    _sensor_variable("brake_command", "Share of full service, before the delays of the brake"),
    _sensor_variable(
        "measured_train_speed",
        "From outside the wheelsets: the controller's train_speed; 0 where it is not valid",
        "m/s",
        field="train_speed",
    ),
    _sensor_variable(
        "train_speed_valid", "False without such a source, and while it is lost", kind="boolean"
    ),
    _sensor_variable(
        "acceleration", "As an accelerometer on the car shows it; 0 where it is not valid", "m/s2"
    ),
    _sensor_variable("acceleration_valid", "False without an accelerometer", kind="boolean"),
)
"""Further ones of a rig whose commands keep version 2 of the contract of controllers."""

_PLACES: Final = {
    "time": "time",
    "cycle_time": "stop.parameters.cycle_time",
    "exchange": "stop.exchange",
    "kept": "stop.parameters",
    "closed": "stop.car.closed",
    "commands": "commands",
    "ended": "ended",
}
_LARGEST_SEED: Final = {2: 2**31 - 1, 3: 2**32 - 1}
"""FMI version -> largest whole number that a seed can be."""


def build_fmu(case: scenario.Case, version: FmiVersion, contract: int = 1) -> bytes:
    """Return the FMU of a case as the bytes of its file.

    Args:
        case: the case; its controller plays no part, but its cycle time holds.
        version: of FMI.
        contract: version of the contract of controllers that the commands keep, as for :class:`uictest.Rig`.

    Raises:
        ValueError: the seed of the case is too large for the version.
        CannotBuildError: this package has no library of FMUs.
    """
    case = bench.identified(case)
    inputs = rig.assemble(case)
    inputs.parameters["controller_contract"] = contract
    seed = _seed_variable(int(inputs.parameters["seed"]), version)
    variables = (*VARIABLES[:-1], seed, *(VARIABLES_2 if contract > 1 else ()))
    cycle_time = float(inputs.parameters["cycle_time"])
    model = Model(
        name=f"rig {case.id}",
        identifier=re.sub(r"\W", "_", f"rig_{case.scenario.name}"),
        description=case.scenario.title or f"Brake rig, case {case.id}",
        version=__version__,
        variables=variables,
        cycle_time=cycle_time,
        longest=cycle_time * int(inputs.parameters["cycles"]),
        can_save=True,
    )
    parts = _parts_inside(case)
    return archive_of(
        model,
        version,
        _model_content(inputs, contract),
        {
            "documentation/index.html": page(f"Brake rig: {case.id}", *_page(case, parts, variables)),
            "resources/case.json": _provenance(case, parts),
        },
    )


def _seed_variable(start: int, version: FmiVersion) -> Variable:
    largest = _LARGEST_SEED[version]
    if start > largest:
        raise ValueError(
            f"seed {start} is above {largest}, the largest whole number of"
            f" FMI {version}.0: choose another with --set seed="
        )
    return replace(VARIABLES[-1], start=str(start), range=(0, largest))


def _parts_inside(case: scenario.Case) -> dict[str, evaluation.EffectivePart]:
    parts = evaluation.effective_parts(case.scenario)
    outside = ("controller", "criteria", "measures")
    return {role: part for role, part in parts.items() if role.partition(".")[0] not in outside}


def _model_content(inputs: StopInputs, contract: int) -> Content:
    """Return the contents of the model file: memory and constants of the case, arguments of the code."""
    case = rig.alone(inputs)
    start = np.zeros(1, INSTANCE_MEMORY)
    stop, commands = start[0]["stop"], start[0]["commands"]
    stop["parameters"] = case.parameters
    # As before a controller is asked: it may answer nothing, and one of version 1 nothing beyond its outputs.
    commands["reference_speed"], commands["dynamic_reduction"] = np.nan, 0.0 if contract > 1 else UNTOUCHED
    fixed = {
        "wheelset_parameters": case.wheelset_parameters[0],
        "distances": case.distances,
        "rail": case.rail,
    }
    constants = np.zeros(1, [(name, values.dtype, values.shape) for name, values in fixed.items()])
    for name, values in fixed.items():
        constants[name] = values
    train = rig.TrainRecords(
        *(stop["car"], stop["bogies"], stop["wheelsets"], stop["parameters"]),
        *(constants[0]["wheelset_parameters"], stop["rail_memory"]),
        *(stop["measures"], stop["wheelset_measures"]),
        *(constants[0]["distances"], stop["couplers"], constants[0]["rail"]),
    )
    present = rig.Trace(stop["train"].reshape(1, 1), stop["modules"].reshape(1, 1, 4))
    given = train, stop["exchange"], present, rig.empty_trace(1, 0), 0, 0
    return Content(
        "rig", start, _PLACES, [*rig.placed(STEP.arguments, given, start, constants)], constants, begun="stop"
    )


def _provenance(case: scenario.Case, parts: dict[str, evaluation.EffectivePart]) -> bytes:
    """Return `resources/case.json`: what the page says, for programs."""
    content = {
        "uictest": __version__,
        "case": case.id,
        "cycle_time": float(case.scenario.controller.cycle_time),
        "scenario": case.path.name,
        "parameters": dict(case.parameters),
        "inputs": dict(_files_with_digests(case)),
        "parts": evaluation.parts_document([parts]),
    }
    return json.dumps(content, indent=1, ensure_ascii=False).encode() + b"\n"


def _page(
    case: scenario.Case, parts: dict[str, evaluation.EffectivePart], variables: Sequence[Variable]
) -> Iterator[str]:
    yield f"<p>{escape(case.scenario.title)}</p>"
    cycle = case.scenario.controller.cycle_time.text
    yield (
        f"<p>One stop from {escape(case.scenario.initial_speed.text)}, which begins at the brake command. The"
        f" communication step is the controller cycle, {escape(cycle)}; any other is an error. Outputs do not"
        " depend on inputs of the same instant. After the end of the stop the outputs stay.</p>"
    )
    yield from table_of_variables(variables)
    yield "<h2>Versions</h2>"
    yield from table(("program", "version"), [("uictest", __version__)])
    yield "<h2>Files</h2>"
    yield from table(("file", "SHA-256"), _files_with_digests(case))
    for role, part in parts.items():
        yield f"<h2>{escape(role)}: {escape(part.name)}</h2>"
        yield from table(("key", "value", "mark"), ((p.key, p.written, p.mark) for p in part.parameters))


def _files_with_digests(case: scenario.Case) -> Iterator[tuple[str, str]]:
    """Yield the files of a case with their SHA-256; a folder of this machine is nobody else's business."""
    for name, digest in case.inputs.items():
        yield (Path(name).name if Path(name).is_absolute() else name), digest
