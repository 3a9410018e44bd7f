"""The case that a sweep varies, and the survey step that it may be simulated in."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from uictest.plans.scenario import (
    EXPANSION_KEYS,
    PART_KEYS,
    SURVEY,
    SWEEP_SUFFIXES,
    Case,
    Files,
    Parts,
    Roots,
    Scenario,
    Variant,
    changed_alone,
    distinct,
    expand,
    load,
    resolve,
    with_default_parts,
)
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Document,
    Entry,
    Map,
    Override,
    Place,
    Quantity,
    Scalar,
    Sequence as List,
    apply_overrides,
    default,
    dotted,
    inherit,
    parse_quantity,
    quoted,
    single_error,
    suggestion,
    with_value,
)
from uictest.plans.sweeps.plan import Plan
from uictest.plans.sweeps.scenario_values import outermost_first, with_values

DOTTED_PART_KEYS: Final = frozenset(map(dotted, PART_KEYS))

REPEAT_KEYS: Final = ("repeat", "outcome_of_repeats")
SEEDS_IN_SWEEPS: Final = "list or sample `seed`, as in `grid: {seed: [0, 1, 2]}`"


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


def read_base_case(
    reference: Scalar, case_id: Scalar | None, overrides: Sequence[Override], roots: Roots
) -> BaseCase:
    """Return the case of the scenario file that `reference` names.

    Args:
        reference: the key `scenario` of the sweep file.
        case_id: which case, where the scenario has several.
        overrides: with one value each.
        roots: folders that references may lead into.

    Raises:
        ScenarioErrors: with all errors of the scenario.

    """
    files = Files(roots)
    if reference.text.endswith(SWEEP_SUFFIXES):
        raise single_error(
            reference.place, f"{quoted(reference.text)} is a sweep, not a scenario", "scenario"
        )
    own = files.beside(reference, "scenario")
    cases = _load_cases(reference, overrides, roots)
    place = _place_of(case_id, cases, reference)
    _reject_repeats(cases[place], reference)
    merged, _ = inherit(own, lambda parent: files.beside(parent, "extends"))
    merged = merged.with_entry("name", own.entries["name"])
    tree = apply_overrides(with_default_parts(merged), overrides, DOTTED_PART_KEYS)
    variants = distinct(expand(tree)) if overrides else expand(tree)
    return BaseCase(cases[place], _fixed(tree.without(*EXPANSION_KEYS), variants[place]), Parts(files))


def _reject_repeats(case: Case, reference: Scalar) -> None:
    if case.scenario.repeat > 1:
        message = f"{quoted(reference.text)} repeats its stop {case.scenario.repeat} times"
        hint = f"a sweep runs one stop per case: {SEEDS_IN_SWEEPS}; --set repeat=1 runs the first stop alone"
        raise single_error(reference.place, message, "scenario", hint)


def _fixed(tree: Map, variant: Variant) -> Map:
    for setting in sorted(variant, key=lambda setting: setting.key.count(".")):
        tree = with_value(tree, setting.key, setting.value, DOTTED_PART_KEYS)
    return tree


def _load_cases(reference: Scalar, overrides: Sequence[Override], roots: Roots) -> list[Case]:
    texts = [each.place.document.text for each in overrides if each.place.document.display == "--set"]
    seed_node = next((each.values[0] for each in overrides if each.place.document.display == "--seed"), None)
    seed = int(seed_node.text) if isinstance(seed_node, Scalar) else None
    return load([reference.place.document.folder / reference.text], texts, seed, roots.folders)


def _place_of(case_id: Scalar | None, cases: Sequence[Case], reference: Scalar) -> int:
    ids = [case.id for case in cases]
    if case_id is None and len(ids) == 1:
        return 0
    if case_id is None:
        hint = f"add one of them as `case`: {', '.join(ids[:8])}{', ...' if len(ids) > 8 else ''}"
        message = f"{quoted(reference.text)} has {len(ids)} cases, a sweep starts from one"
        raise single_error(reference.place, message, "scenario", hint)
    if case_id.text not in ids:
        raise single_error(
            case_id.place, f"no case {quoted(case_id.text)} there", "case", suggestion(case_id.text, ids)
        )
    return ids.index(case_id.text)


TIME_STEP: Final = "simulation.time_step"
SURVEY_STEP: Final[Quantity] = parse_quantity("1 ms", "time")
REGULAR_STEP: Final[Quantity] = default("0.5 ms", "time")
"""The step that the bias of the survey step refers to."""


def requested_survey(tree: Map, overrides: Sequence[Override]) -> Place | None:
    """Return where the survey step is asked for, None where it is not.

    That is the only value of the time step on the command line, the last one there, or else in the grid of
    the sweep file.
    """
    given = [override for override in overrides if override.key == TIME_STEP]
    if given:
        return _place_of_survey(given[-1].values)
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
