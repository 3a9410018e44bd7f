"""From a case, as a user wrote it, to the numbers that the rig steps."""

import zlib
from collections.abc import Iterable, Mapping
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import CONTROLLERS, Controller
from uictest.record import ScenarioValue, scenario_values
from uictest.rig.derived_parameters import (
    DERIVED,
    Assignment,
    friction_along_track,
    friction_factor_over_time,
)
from uictest.rig.derived_wheelset_parameters import WHEELSET_ASSIGNMENTS
from uictest.rig.disc_parameters import DISC_BRAKE
from uictest.rig.model.friction_law import FACTORS, FRICTIONS, PLACES, ROWS, TIMES
from uictest.rig.model.parameters import PARAMETERS, Parameters
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
from uictest.scenario import Case, Scenario


class StopInputs(NamedTuple):
    """What the rig is given for one stop.

    Attributes:
        parameters: record of :data:`~uictest.rig.model.parameters.PARAMETERS`.
        wheelset_parameters: four records of
            :data:`~uictest.rig.model.wheelset_parameters.WHEELSET_PARAMETERS`.
        rail: friction of the rail, the rows of :mod:`~uictest.rig.model.friction_law`, shape (4, n).
        controller: the WSP controller.
    """

    parameters: Any
    wheelset_parameters: Any
    rail: NDArray[np.float64]
    controller: Controller


def assemble(case: Case) -> StopInputs:
    """Return what the rig is given for the stop of a case."""
    record, wheelsets = np.zeros(1, PARAMETERS), np.zeros(4, WHEELSET_PARAMETERS)
    values = assigned(ASSIGNMENTS, case.scenario)
    values["case_key"] = zlib.crc32(case.id.encode())
    _fill(record[0], values)
    for place, assignments in enumerate(WHEELSET_ASSIGNMENTS):
        _fill(wheelsets[place], assigned(assignments, case.scenario))
    return StopInputs(record[0], wheelsets, friction_laws(case.scenario), controller_of(case.scenario))


def _fill(record: Any, values: Mapping[str, float]) -> None:
    """Set every field of a record."""
    missing = set(record.dtype.names) ^ set(values)
    if missing:
        raise AssertionError(f"parameters without a value, or unknown: {', '.join(sorted(missing))}")
    for name, value in values.items():
        record[name] = value


def controller_of(scenario: Scenario) -> Controller:
    """Return the controller of a scenario."""
    return CONTROLLERS[scenario.controller.algorithm]


def assigned(assignments: Iterable[Assignment], scenario: Scenario) -> dict[str, Any]:
    """Return the parameters that assignments set for a scenario: some of :data:`ASSIGNMENTS` or of those for
    one wheelset, :data:`~uictest.rig.derived_wheelset_parameters.WHEELSET_ASSIGNMENTS`.
    """
    parameters = Parameters()
    for assignment in assignments:
        assignment.apply(parameters, scenario)
    return vars(parameters)


def friction_laws(scenario: Scenario) -> NDArray[np.float64]:
    """Return friction along the track and its factor over time, in rows of equal length."""
    along, over_time = friction_along_track(scenario), friction_factor_over_time(scenario)
    laws = np.zeros((ROWS, max(len(along), len(over_time))))
    laws[PLACES, : len(along)], laws[FRICTIONS, : len(along)] = np.array(along).T
    laws[TIMES, : len(over_time)], laws[FACTORS, : len(over_time)] = np.array(over_time).T
    return laws


def _copying(field: str, source: ScenarioValue) -> Assignment:
    """Set one field to the value at one key."""
    value_at, convert = attrgetter(source.key), source.convert

    def copy(parameters: Parameters, scenario: Scenario) -> None:
        value = value_at(scenario)
        setattr(parameters, field, value if convert is None else convert(value))

    return Assignment(copy, (source.key,))


def _set_controller(parameters: Parameters, scenario: Scenario) -> None:
    """Set the parameters of the controller in use; those of the others are zero and never read."""
    own = controller_of(scenario).declared_parameters()
    for controller in CONTROLLERS.values():
        for field in controller.declared_parameters():
            setattr(parameters, field, getattr(scenario.controller, field) if field in own else 0.0)


ASSIGNMENTS: tuple[Assignment, ...] = (
    *(_copying(field, source) for field, source in scenario_values(Parameters).items()),
    *DERIVED,
    *DISC_BRAKE,
    Assignment(_set_controller, ("controller",)),
)
"""What sets all parameters but `case_key`."""
FRICTION_KEYS = ("rail",)
"""The keys of a scenario at or below which :func:`friction_laws` reads."""
