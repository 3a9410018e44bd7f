"""The survey step: sweeps in steps of 1 ms, whose bias is known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from uictest.plans.scenario import SURVEY, Scenario
from uictest.plans.scenario.yaml import (
    Map,
    Override,
    Place,
    Quantity,
    Scalar,
    Sequence as List,
    default,
    single_error,
)
from uictest.plans.sweeps.base_case import BaseCase
from uictest.plans.sweeps.plan import Plan
from uictest.plans.sweeps.scenario_values import with_values

TIME_STEP: Final = "simulation.time_step"
SURVEY_STEP: Final[Quantity] = default("1 ms", "time")
REGULAR_STEP: Final[Quantity] = default("0.5 ms", "time")
"""The step that the bias of the survey step refers to."""


def requested_survey(tree: Map, overrides: Sequence[Override]) -> Place | None:
    """Return where the survey step is asked for, None where it is not.

    That is the only value of the time step on the command line, or else in the grid of the sweep file.
    """
    for override in overrides:
        if override.key == TIME_STEP:
            return _place_of_survey(override.values)
    grid = tree.get("grid")
    values = grid.get(TIME_STEP) if isinstance(grid, Map) else None
    return _place_of_survey(values.items) if isinstance(values, List) else None


def _place_of_survey(values: Sequence[object]) -> Place | None:
    match values:
        case [Scalar() as value] if value.text == SURVEY:
            return value.place
    return None


def require_regular_step(base: BaseCase, place: Place) -> None:
    """Raise ScenarioErrors where the survey step would replace another step than it was compared with."""
    step = base.case.scenario.simulation.time_step
    if step != REGULAR_STEP:
        message = f"the survey step is known beside {REGULAR_STEP.text}; the scenario is run in {step.text}"
        raise single_error(place, message, TIME_STEP, f"remove {TIME_STEP} from the scenario")


def in_survey_steps(plan: Plan) -> Plan:
    """Return the plan whose cases are simulated in survey steps, whatever their time step is."""
    scenario: Scenario = with_values(plan.base.scenario, {TIME_STEP: SURVEY_STEP})
    return replace(plan, base=replace(plan.base, scenario=scenario))
