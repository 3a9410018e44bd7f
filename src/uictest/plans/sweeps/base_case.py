"""The case that a sweep varies, and the survey step that it may be simulated in."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from uictest.plans.scenario import PART_KEYS, SURVEY, Case, Parts, Scenario, changed_alone, resolve
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Document,
    Entry,
    Map,
    Node,
    Override,
    Place,
    Quantity,
    Scalar,
    Sequence as List,
    default,
    dotted,
    parse_quantity,
    quoted,
    single_error,
    with_value,
)
from uictest.plans.sweeps.plan import Plan
from uictest.plans.sweeps.scenario_values import outermost_first, with_values

DOTTED_PART_KEYS: Final = frozenset(map(dotted, PART_KEYS))

REPEAT_KEYS: Final = ("repeat", "outcome_of_repeats")
SEEDS_IN_SWEEPS: Final = "list or sample `seed`, as in `matrix: {seed: [0, 1, 2]}`"


@dataclass(frozen=True)
class BaseCase:
    """A case and the YAML tree that it comes from."""

    case: Case
    tree: Map
    parts: Parts

    def scenario_with(self, settings: Mapping[str, Entry]) -> tuple[Scenario, tuple[Document, ...]]:
        """Return the scenario in which the dotted keys have other values, and the documents read for it.

        Raises ScenarioErrors as if the scenario's file had said so.
        """
        return resolve(self._tree_with(settings), self.parts)

    def changed_alone(self, settings: Mapping[str, Entry]) -> Iterator[Diagnostic]:
        """Yield a change of the rail condition that leaves the friction. Raises ScenarioErrors."""
        return changed_alone(self.tree, self._tree_with(settings))

    def _tree_with(self, settings: Mapping[str, Entry]) -> Map:
        tree = self.tree
        for key in outermost_first(settings):
            tree = with_value(tree, key, settings[key], DOTTED_PART_KEYS)
        return tree


TIME_STEP: Final = "simulation.time_step"
SURVEY_STEP: Final[Quantity] = parse_quantity("1 ms", "time")
REGULAR_STEP: Final[Quantity] = default("0.5 ms", "time")
"""The step that the bias of the survey step refers to."""


def survey_on_command_line(overrides: Sequence[Override]) -> Place | None:
    """Return where the command line asks for the survey step: by the last value of the time step there."""
    given = [override for override in overrides if override.key == TIME_STEP]
    return _place_of_survey(given[-1].values) if given else None


def survey_in_lists(lists: Node | None) -> Place | None:
    """Return where the lists of a sweep ask for the survey step: by it alone as the time step."""
    values = lists.get(TIME_STEP) if isinstance(lists, Map) else None
    return _place_of_survey(values.items) if isinstance(values, List) else None


def _place_of_survey(values: Sequence[Node]) -> Place | None:
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


def reject_other_steps(keys: Iterable[str], place: Place) -> None:
    """Raise ScenarioErrors where a sweep in survey steps varies the step, too."""
    for key in keys:
        if f"{TIME_STEP}.".startswith(f"{key}."):
            message = f"{quoted(key)} cannot vary: the survey step is that of all cases"
            raise single_error(place, message, key, "vary the other keys of `simulation` one by one")


def in_survey_steps(plan: Plan) -> Plan:
    """Return the plan whose cases are simulated in survey steps, whatever their time step is."""
    scenario: Scenario = with_values(plan.base.scenario, {TIME_STEP: SURVEY_STEP})
    return replace(plan, base=replace(plan.base, scenario=scenario))
