"""The case: one stop of a car on the rig, alone or coupled to others; and its id, safe for file names."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import Any, Final, TypeVar

from uictest.plans.scenario.expansion import Setting, Variant
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.programs import PROGRAM_FILES
from uictest.plans.scenario.resolution import PART_KEYS, Parts, is_path
from uictest.plans.scenario.yaml import (
    List,
    Map,
    Node,
    Scalar,
    ScenarioErrors,
    as_written,
    quoted,
    single_error,
    suggestion,
)

_Named = TypeVar("_Named")


@dataclass(frozen=True, slots=True)
class TrainPlace:
    """Position of a car in its train."""

    train: str
    """Id of the train: that of the case without the number of the car."""
    number: int
    """Of the car, from 1 for the leading one."""
    scenarios: tuple[Scenario, ...]
    """Of all cars of the train in their order."""

    @property
    def label(self) -> str:
        """The place in words: `car 2 of 4`."""
        return f"car {self.number} of {len(self.scenarios)}"


@dataclass(frozen=True, slots=True)
class Case:
    """One stop on the rig."""

    id: str
    """Unique among the cases loaded together; safe as a file name."""
    scenario: Scenario
    """Resolved: every reference to a part replaced by the part."""
    path: Path
    """The file it comes from, as shown to users."""
    parameters: dict[str, str]
    """Swept dotted keys and their values as written, in order; in a train the number of the car, too."""
    inputs: dict[str, str]
    """Every file read for it, by shown name, and its SHA-256."""
    train: TrainPlace | None = None
    """Position in the train; None for a car alone."""
    vehicle_stated: bool = True
    """Whether anyone said which vehicle it is; of a record that is judged without a scenario nobody may."""

    def with_values(self, **changes: Any) -> "Case":
        """The case with other values of what a train has once; so have the cars that it is coupled to."""
        return self.changed(lambda scenario: scenario.model_copy(update=changes))

    def changed(self, change: Callable[[Scenario], Scenario]) -> "Case":
        """The case with its scenario changed; so with the cars that it is coupled to."""
        scenario = change(self.scenario)
        if self.train is None:
            return replace(self, scenario=scenario)
        # Equal cars share their scenario, so that the rig is assembled for them once.
        changed = {id(each): change(each) for each in self.train.scenarios}
        scenarios = tuple(changed[id(each)] for each in self.train.scenarios)
        return replace(self, scenario=scenario, train=replace(self.train, scenarios=scenarios))

    @property
    def is_from_outside(self) -> bool:
        """Whether its controller, or that of another car of its train, comes from outside."""
        scenarios = () if self.train is None else self.train.scenarios
        return any(each.controller.program is not None for each in (self.scenario, *scenarios))

    @property
    def cars(self) -> "tuple[Case, ...]":
        """The cases of all cars of the train, each as if it ran alone; of a car alone, this case."""
        if self.train is None:
            return (self,)
        scenarios = list(self.train.scenarios)
        scenarios[self.train.number - 1] = self.scenario
        return tuple(replace(self, scenario=each, train=None) for each in scenarios)


def with_wsp_bypassed(scenario: Scenario) -> Scenario:
    """A scenario in which the controller does not act on the valves."""
    return scenario.model_copy(update={"rig": scenario.rig.model_copy(update={"wsp": "bypassed"})})


def with_another_controller(scenario: Scenario) -> Scenario:
    """A scenario with what of its expectation holds for another controller than its own.

    That is all of it where the WSP is bypassed: no controller acts.
    """
    if scenario.rig.wsp == "bypassed":
        return scenario
    return scenario.model_copy(update={"expect": scenario.expect.of_another_controller()})


def chosen_case(cases: Sequence[Case], case_id: str | None) -> Case:
    """Return the case of an id, or the only one. Raises ValueError."""
    return _only_or_named({case.id: case for case in cases}, case_id, "case")


def chosen_train(cases: Sequence[Case], train_id: str | None) -> tuple[Case, ...]:
    """Return the cars of the train of an id, or of the only one; a car alone is one. Raises ValueError."""
    trains: dict[str, list[Case]] = {}
    for case in cases:
        trains.setdefault(case.id if case.train is None else case.train.train, []).append(case)
    return tuple(_only_or_named(trains, train_id, "train"))


def _only_or_named(named: Mapping[str, _Named], name: str | None, kind: str) -> _Named:
    if name is None:
        if len(named) != 1:
            raise ValueError(f"the scenario has {len(named)} {kind}s: pass case= one of {', '.join(named)}")
        return next(iter(named.values()))
    if name not in named:
        raise ValueError(f"no {kind} {name!r}; {suggestion(name, named)}")
    return named[name]


LONGEST: Final = 200
"""Longest id: with an extension it must still be a file name everywhere."""
FAULTS: Final = "faults"
"""Key of the faults of a scenario."""
CONTROLLER: Final = "controller"
"""Key of the controller of a scenario."""
EXPECT: Final = "expect"
"""Key of the expected outcome of a case, which is not part of its id."""
CAR: Final = "car"
"""Key that distinguishes the cases of the cars of a train."""
Labels = Mapping[int, str]
"""Identity of the node of a controller -> its label in ids."""
NO_LABELS: Final[Labels] = MappingProxyType({})
_DIGITS: Final = 8
"""Of a SHA-256 that tells two programs apart."""
_ENTRY = re.compile(r"train\.\d+\.")
_UNSAFE = re.compile(r"[^A-Za-z0-9.+_-]")


def case_id(
    name: str, variant: Variant, short: dict[str, str], labels: Labels = NO_LABELS, car: int = 0
) -> str:
    """``name`` or ``name[friction=0.10,command=90]``; ``short`` maps swept keys to their short names.

    A case that is one car of a train has its number from 1, too.
    """
    texts = [f"{short[setting.key]}={value_label(setting, labels)}" for setting in variant]
    if car:
        texts.append(f"{CAR}={car}")
    return f"{name}[{','.join(texts)}]" if texts else name


def controller_labels(settings: Iterable[Setting], parts: Parts) -> Labels:
    """Return the labels of the controllers among the values of one file, as used in ids.

    A label is the name of the part. Several programs of one name are `name@version`, or, where a version is
    unknown or that of another one, `name@` and the first digits of the SHA-256. A controller that cannot be
    resolved has no label: its error is reported where its case is.
    """
    programs: dict[int, tuple[str, str, str]] = {}
    for setting in settings:
        node = setting.value.node
        if setting.key == CONTROLLER and id(node) not in programs:
            with suppress(ScenarioErrors):
                part = parts.part(node, PART_KEYS[CONTROLLER,].model, (CONTROLLER,)).part
                name = part.name if "name" in part.model_fields_set else _name_of_setting(setting)
                version, program = getattr(part, "version", None) or "", part.program
                digits = (
                    "" if program is None else program.sha256[:_DIGITS]
                )  # a built-in one has a name alone
                programs[id(node)] = (
                    _without_unsafe_characters(name),
                    _without_unsafe_characters(version),
                    digits,
                )
    return {key: _told_apart(program, {*programs.values()}) for key, program in programs.items()}


def _told_apart(program: tuple[str, str, str], programs: set[tuple[str, str, str]]) -> str:
    name, version, digits = program
    versions = [other_version for other, other_version, _ in programs if other == name]
    if len(versions) == 1:
        return name
    distinct = all(versions) and len(set(versions)) == len(versions)
    return "@".join(filter(None, (name, version if distinct else digits)))


def sets_controller(keys: Iterable[str]) -> bool:
    """Return whether one of some dotted keys is that of a controller, of a car or of all, or below it."""
    return any(CONTROLLER in key.split(".") for key in keys)


def short_keys(keys: list[str]) -> dict[str, str]:
    """The last part of every dotted key, or the shortest tail that is unique.

    That of one entry of `train` begins with the entry: the ids of all cars have it.
    """
    entries = {key: found.group() if (found := _ENTRY.match(key)) else "" for key in keys}
    return {
        key: entry
        + _shortest_tail(
            key.removeprefix(entry),
            [
                other.removeprefix(entry)
                for other, of_other in entries.items()
                if other != key and of_other == entry
            ],
        )
        for key, entry in entries.items()
    }


def _shortest_tail(key: str, others: list[str]) -> str:
    parts = key.split(".")
    for count in range(1, len(parts)):
        tail = ".".join(parts[-count:])
        if not any(other == tail or other.endswith("." + tail) for other in others):
            return tail
    return key


def value_label(setting: Setting, labels: Labels = NO_LABELS) -> str:
    """The value as written in the characters of file names; of a controller, its label."""
    label = labels.get(id(setting.value.node)) or _without_unsafe_characters(_name_of_setting(setting))
    return label or f"value{setting.number}"


def _without_unsafe_characters(text: str) -> str:
    return _UNSAFE.sub("", text)


def _name_of_setting(setting: Setting) -> str:
    node = setting.value.node
    if setting.key == FAULTS and isinstance(node, List):
        return "+".join(map(_name_of_fault, node.items)) or "none"
    if isinstance(node, Map):
        program = next((node.get(key) for key in PROGRAM_FILES if key in node.entries), None)
        if isinstance(program, Scalar):
            return PurePosixPath(program.text).stem
        node = node.get("name") or node.get("extends") or node
    if not isinstance(node, Scalar):
        return f"value{setting.number}"
    return PurePosixPath(node.text).stem if is_path(node.text) else node.text


_NAMED_BY: Final = ("part", "kind", "value", "wheelset", "at", "until")


def _name_of_fault(node: Node) -> str:
    named = (node.get(key) for key in _NAMED_BY) if isinstance(node, Map) else ()
    return "-".join(each.text for each in named if isinstance(each, Scalar))


def duplicate_id(identifier: str, variant: Variant, first: Variant) -> ScenarioErrors:
    """The error of a second case with the same id: at the value that a list repeats, else at the case."""
    of_first = {setting.key: setting for setting in first}
    pairs = [(setting, of_first[setting.key]) for setting in variant if setting.key in of_first]
    others = [(one, other) for one, other in pairs if one.value.node is not other.value.node]
    setting, twin = others[0]
    message, key = f"a second case {quoted(identifier)}", ""
    if len(others) == 1 and setting.value.key == twin.value.key:  # both stand in the list of one key
        one, other = quoted(as_written(setting.value.node)), quoted(as_written(twin.value.node))
        message = f"{one} appears twice" if one == other else f"{one} and {other} make the same case id"
        key = setting.key
    hint = f"remove one; the first is in line {twin.value.node.location.line}"
    if key == CONTROLLER:
        hint += "; or give each a `name` or a `version` of its own"
    return single_error(setting.value.node.location, message, key, hint)
