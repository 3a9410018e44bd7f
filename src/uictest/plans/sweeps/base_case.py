"""The case that a sweep varies, how its values are changed, and the survey step it may be simulated in."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple, TypeVar

from uictest.plans.scenario import (
    CONDITION,
    SURVEY,
    Case,
    Override,
    Parts,
    Scenario,
    changed_alone,
    coupling_problem,
    own_keys,
    resolve,
    resolved_cars,
    with_value,
)
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Document,
    Entry,
    Inconsistency,
    List,
    Location,
    Map,
    Model,
    Node,
    Quantity,
    Scalar,
    default,
    dotted,
    parse_quantity,
    plain,
    quoted,
    single_error,
)


def with_values(scenario: Scenario, settings: Mapping[str, Any]) -> Scenario:
    """Return the scenario with other values at the dotted keys of `settings`.

    Nothing is validated: the values must be valid, and `inconsistencies` checks their combination.
    """
    changed: Scenario = _with_changes(scenario, _Change.of(settings).inner)
    return changed


def value_at(scenario: Scenario, key: str) -> Any:
    """Return the value at a dotted key. Raises KeyError for an unknown key."""
    value: Any = scenario
    for element in key.split("."):
        value = _value_of_element(value, element)
    return value


def is_free(scenario: Scenario, key: str) -> bool:
    """Return whether nothing but a controller from outside knows what the value at a dotted key means."""
    above, _, _ = key.rpartition(".")
    try:
        return bool(above) and isinstance(value_at(scenario, above), dict)
    except KeyError:
        return False


def inconsistencies(scenario: Scenario, keys: Iterable[str]) -> Iterator[Inconsistency]:
    """Yield the inconsistencies of the scenario and of its models on the way to `keys`."""
    paths = [tuple(key.split(".")) for key in keys]
    for path in dict.fromkeys(elements[:depth] for elements in paths for depth in range(len(elements))):
        model = value_at(scenario, ".".join(path)) if path else scenario
        if isinstance(model, Model):
            for inconsistency in model.inconsistencies():
                yield inconsistency._replace(key=(*path, *inconsistency.key))


def train_problem(cars: Sequence[Scenario], keys: Iterable[Iterable[str]]) -> str:
    """Return the reason why a train cannot run; empty where it can.

    Args:
        cars: its scenarios.
        keys: of the changed values of each car.
    """
    for car, changed_keys in zip(cars, keys, strict=True):
        for problem in inconsistencies(car, changed_keys):
            return f"{dotted(problem.key)}: {problem.message}"
    return coupling_problem(cars)


_UNCHANGED: Final = object()


@dataclass(slots=True)
class _Change:
    """A new value of a part of a scenario, or none, and the changes within it."""

    value: Any = _UNCHANGED
    inner: dict[str, _Change] = field(default_factory=dict)

    @classmethod
    def of(cls, settings: Mapping[str, Any]) -> _Change:
        whole = cls()
        for key, value in settings.items():
            change = whole
            for element in key.split("."):
                change = change.inner.setdefault(element, cls())
            change.value = value
        return whole


def _with_changes(model: Any, changes: Mapping[str, _Change]) -> Any:
    """Return a model with changes; each model on the way is copied once, whatever number of values change."""
    if not changes:
        return model
    if isinstance(model, tuple) and (named := {k: v for k, v in changes.items() if not k.isdecimal()}):
        model = (_with_changes(model[0], named),)  # the one entry, written without a list
        changes = {k: v for k, v in changes.items() if k not in named}
    inner = {
        element: _with_changes(
            _value_of_element(model, element) if change.value is _UNCHANGED else change.value, change.inner
        )
        for element, change in changes.items()
    }
    if isinstance(model, tuple):
        changed_items = {int(element): value for element, value in inner.items()}
        return tuple(changed_items.get(index, item) for index, item in enumerate(model))
    return {**model, **inner} if isinstance(model, dict) else model.model_copy(update=inner)


def _value_of_element(value: Any, element: str) -> Any:
    if isinstance(value, dict):
        return value[element]
    if isinstance(value, tuple) and element.isdecimal() and int(element) < len(value):
        return value[int(element)]
    if isinstance(value, tuple) and not element.isdecimal() and len(value) == 1:
        return _value_of_element(value[0], element)  # one entry may be written without a list
    if isinstance(value, Model) and element in type(value).model_fields:
        return getattr(value, element)
    raise KeyError(element)


_OfCar = TypeVar("_OfCar")

REPEAT_KEYS: Final = ("repeat", "outcome_of_repeats")
SEEDS_IN_SWEEPS: Final = "list or sample `seed`, as in `matrix: {seed: [0, 1, 2]}`"


class BaseCase(NamedTuple):
    """A case and the YAML tree that it comes from."""

    case: Case
    tree: Map
    parts: Parts

    def contents(self, settings: Mapping[str, Entry]) -> tuple[dict[str, Any], tuple[Document, ...]]:
        """Return the values at dotted keys once `settings` are applied, and the documents read for them.

        Raises ScenarioErrors as if the scenario's file had said so, and where a key of a train does not give
        all cars that it reaches the same.
        """
        tree = self._tree_with(settings)
        if self.case.train is None:
            scenario, documents = resolve(tree, self.parts)
            return {key: value_at(scenario, key) for key in settings}, documents
        cars = [car for car, _ in resolved_cars(self.case.path, tree, self.parts)]
        contents: dict[str, Any] = {}
        for key, entry in settings.items():
            reached = [value_at(car, own[key]) for (car, _), own in self._reached_by(cars, key)]
            if not reached:
                hint = f"write `train.0.{key}` for one car"
                raise single_error(entry.key, "every car has one of its own", key, hint)
            if any(each != reached[0] for each in reached):
                hint = f"vary a number below it, or `train.0.{key}` of one car"
                raise single_error(entry.key, "it would not be the same in all cars", key, hint)
            contents[key] = reached[0]
        return contents, tuple(document for _, documents in cars for document in documents)

    def place_of(self, key: str) -> tuple[Scenario, str]:
        """Return the scenario that has a key, of a train that of the first car, and what the key is there."""
        if self.case.train is None:
            return self.case.scenario, key
        reached = self._reached_by(self.case.train.scenarios, key)
        return next(((scenario, own[key]) for scenario, own in reached), (self.case.scenario, key))

    def own_keys(self, keys: Iterable[str]) -> tuple[dict[str, str], ...]:
        """Return for each car of a train what its scenario calls those of the keys that reach it."""
        if self.case.train is None:
            return ()
        of_entries = own_keys(self.tree, keys)
        node = self.tree.entries["train"].node
        counts = [plain(item).get("count", 1) for item in items_of(node)]
        return tuple(own for own, count in zip(of_entries, counts, strict=True) for _ in range(count))

    def _reached_by(self, cars: Sequence[_OfCar], key: str) -> Iterator[tuple[_OfCar, dict[str, str]]]:
        return (each for each in zip(cars, self.own_keys([key]), strict=True) if key in each[1])

    def conditions_alone(self, entries: Mapping[str, Entry]) -> Iterator[Diagnostic]:
        """Yield rail conditions that change without the friction of the scenario. Raises ScenarioErrors."""
        for key, entry in entries.items():
            if key.startswith(CONDITION):
                choice = entry.node.get("choice") if isinstance(entry.node, Map) else None
                for node in items_of(choice or entry.node):
                    yield from changed_alone(self.tree, self._tree_with({key: Entry(entry.key, node)}))

    def _tree_with(self, settings: Mapping[str, Entry]) -> Map:
        tree = self.tree
        for key in sorted(settings, key=lambda key: key.count(".")):  # a part before its parameters
            tree = with_value(tree, key, settings[key])
        return tree


def items_of(node: Node) -> Sequence[Node]:
    """Return the entries of a list, or the one value that stands without a list."""
    return node.items if isinstance(node, List) else (node,)


TIME_STEP: Final = "simulation.time_step"
SURVEY_STEP: Final[Quantity] = parse_quantity("1 ms", "time")
REGULAR_STEP: Final[Quantity] = default("0.5 ms", "time")
"""The step that the bias of the survey step refers to."""


def survey_on_command_line(overrides: Sequence[Override]) -> Location | None:
    """Return the location of the survey step on the command line; None unless the last time step is that."""
    time_steps = [override for override in overrides if override.key == TIME_STEP]
    return _location_of_survey(time_steps[-1].values) if time_steps else None


def survey_in_lists(lists: Node | None) -> Location | None:
    """Return the location of the survey step in the lists of a sweep; None unless it is the one time step."""
    values = lists.get(TIME_STEP) if isinstance(lists, Map) else None
    return _location_of_survey(values.items) if isinstance(values, List) else None


def _location_of_survey(values: Sequence[Node]) -> Location | None:
    match values:
        case [Scalar() as value] if value.text == SURVEY:
            return value.location
    return None


def require_regular_step(base: BaseCase, location: Location) -> None:
    """Raise ScenarioErrors where the survey step would replace another step than it was compared with."""
    step = base.case.scenario.simulation.time_step
    if step != REGULAR_STEP:
        message = f"the survey step is known beside {REGULAR_STEP.text}; the scenario is run in {step.text}"
        raise single_error(location, message, TIME_STEP, f"remove {TIME_STEP} from the scenario")


def reject_other_steps(keys: Iterable[str], location: Location) -> None:
    """Raise ScenarioErrors where a sweep in survey steps varies the step, too."""
    for key in keys:
        if f"{TIME_STEP}.".startswith(f"{key}."):
            message = f"{quoted(key)} cannot vary: the survey step is that of all cases"
            raise single_error(location, message, key, "vary the other keys of `simulation` one by one")
