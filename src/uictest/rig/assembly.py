"""From a case, as a user wrote it, to the numbers that the rig steps."""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import CONTROLLERS, Config, ControllerProgram
from uictest.core.record import ScenarioValue, scenario_values
from uictest.plans.scenario import Case, Scenario
from uictest.rig.derived_parameters import DERIVED, Assignment
from uictest.rig.derived_wheelset_parameters import WHEELSET_ASSIGNMENTS
from uictest.rig.disc_parameters import DISC_BRAKE, FAULTS
from uictest.rig.dynamic_brake_parameters import DYNAMIC_BRAKE
from uictest.rig.model.controller import CHOICES, EXTERNAL
from uictest.rig.model.parameters import PARAMETERS, Parameters
from uictest.rig.model.rail import FACTORS, FRICTIONS, PLACES, ROWS, TIMES
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
from uictest.rig.rail_friction import RAIL, friction_along_track, friction_factor_over_time
from uictest.rig.sand_parameters import SANDERS
from uictest.rig.single_stop import StopInputs, noise_keys
from uictest.rig.track_brake_parameters import TRACK_BRAKE


def assemble(case: Case) -> StopInputs:
    """Return what the rig is given for the stop of a case.

    Raises ValueError where its compensation is still to be identified, see `uictest.rig.bench.identified`,
    and for a car of a train, which does not run alone.
    """
    if case.train is not None:
        raise ValueError(
            f"{case.id} is {case.train.label}: here a car runs alone; `uictest run` and `sweep` take trains"
        )
    rig = case.scenario.rig
    if rig.compensation_model.to_identify and rig.topology == "one-caliper":
        raise ValueError("rig.compensation_model is to be identified first: uictest.rig.bench.identified")
    record, wheelsets = np.zeros(1, PARAMETERS), np.zeros(4, WHEELSET_PARAMETERS)
    values = assigned(ASSIGNMENTS, case.scenario)
    values["noise_key"] = 0  # follows from the other values
    _fill(record[0], values)
    for place, assignments in enumerate(WHEELSET_ASSIGNMENTS):
        _fill(wheelsets[place], assigned(assignments, case.scenario))
    rail = friction_laws(case.scenario)
    record["noise_key"] = noise_keys(record, wheelsets[None], rail[None])
    inputs = record[0], wheelsets, rail
    program = case.scenario.controller.program
    if program is None:
        return StopInputs(*inputs)
    config = controller_config(record[0], wheelsets, program)
    return StopInputs(*inputs, program, replace(config, case_sha256=case_sha256(*inputs, program)))


def case_sha256(
    parameters: Any, wheelset_parameters: Any, rail: NDArray[np.float64], program: ControllerProgram
) -> str:
    """Return the SHA-256 that names a stop: of the bytes of the three records that the rig is given, then of
    the controller's parameters as JSON in UTF-8.

    Stops with the same one are the same stop for a controller, in one version of the package: criteria,
    texts of the scenario and the id of the case have no part in it.
    """
    records = parameters.tobytes(), wheelset_parameters.tobytes(), np.ascontiguousarray(rail).tobytes()
    return hashlib.sha256(b"".join(records) + program.parameters.encode()).hexdigest()


def controller_config(parameters: Any, wheelset_parameters: Any, program: ControllerProgram) -> Config:
    """Return what a controller from outside is given before a stop with these records."""
    radii = wheelset_parameters["configured_radius"].tolist()
    cycle_time, initial_speed = float(parameters["cycle_time"]), float(parameters["initial_speed"])
    return Config(len(radii), cycle_time, initial_speed, tuple(radii), json.loads(program.parameters))


def _fill(record: Any, values: Mapping[str, float]) -> None:
    """Set every field of a record."""
    missing = set(record.dtype.names) ^ set(values)
    if missing:
        raise AssertionError(f"parameters without a value, or unknown: {', '.join(sorted(missing))}")
    for name, value in values.items():
        record[name] = value


def assigned(assignments: Iterable[Assignment], scenario: Scenario) -> dict[str, Any]:
    """Return the parameters that assignments set for a scenario: some of :data:`ASSIGNMENTS` or of those for
    one wheelset, :data:`~uictest.rig.derived_wheelset_parameters.WHEELSET_ASSIGNMENTS`.
    """
    parameters = Parameters()
    for assignment in assignments:
        assignment.apply(parameters, scenario)
    return vars(parameters)


def friction_laws(scenario: Scenario) -> NDArray[np.float64]:
    """Return friction along the track and its factor over time, in rows of equal length.

    Where the friction is that of n cases (:mod:`uictest.core.ensemble`), so are the laws: shape (n, 4,
    points).
    """
    along, over_time = friction_along_track(scenario), friction_factor_over_time(scenario)
    places, frictions = zip(*along, strict=True)
    laws = np.zeros((*np.shape(frictions[0]), ROWS, max(len(along), len(over_time))))
    laws[..., PLACES, : len(along)] = places
    laws[..., FRICTIONS, : len(along)] = np.moveaxis(np.array(frictions), 0, -1)
    laws[..., TIMES, : len(over_time)], laws[..., FACTORS, : len(over_time)] = np.array(over_time).T
    return laws


def _copying(field: str, source: ScenarioValue) -> Assignment:
    """Set one field to the value at one key."""
    value_at, convert = attrgetter(source.key), source.convert

    def copy(parameters: Parameters, scenario: Scenario) -> None:
        value = value_at(scenario)
        setattr(parameters, field, value if convert is None else convert(value))

    return Assignment(copy, (source.key,))


def _set_controller(parameters: Parameters, scenario: Scenario) -> None:
    """Set the controller in use and its parameters; those of the others are zero and never read."""
    section = scenario.controller
    chosen = EXTERNAL if section.program is not None else CONTROLLERS[section.algorithm]
    parameters.controller = CHOICES.index(chosen)
    parameters.controller_contract = chosen.contract
    own = chosen.declared_parameters()
    for controller in CONTROLLERS.values():
        for field in controller.declared_parameters():
            setattr(parameters, field, getattr(section, field) if field in own else 0.0)


ASSIGNMENTS: tuple[Assignment, ...] = (
    *(_copying(field, source) for field, source in scenario_values(Parameters).items()),
    *DERIVED,
    *DISC_BRAKE,
    *FAULTS,
    *RAIL,
    *DYNAMIC_BRAKE,
    *TRACK_BRAKE,
    *SANDERS,
    Assignment(_set_controller, ("controller",)),
)
"""What sets all parameters but `noise_key`."""
FRICTION_KEYS = ("rail",)
"""The keys of a scenario at or below which :func:`friction_laws` reads."""
