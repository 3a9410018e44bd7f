"""The case: one stop of a car on the rig, alone or coupled to others."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.yaml import suggestion

_Named = TypeVar("_Named")


@dataclass(frozen=True, slots=True)
class TrainPlace:
    """Where a car runs in its train."""

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
    """Where it runs in a train; None for a car alone."""
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
    return _chosen({case.id: case for case in cases}, case_id, "case")


def chosen_train(cases: Sequence[Case], train_id: str | None) -> tuple[Case, ...]:
    """Return the cars of the train of an id, or of the only one; a car alone is one. Raises ValueError."""
    trains: dict[str, list[Case]] = {}
    for case in cases:
        trains.setdefault(case.id if case.train is None else case.train.train, []).append(case)
    return tuple(_chosen(trains, train_id, "train"))


def _chosen(named: Mapping[str, _Named], name: str | None, kind: str) -> _Named:
    if name is None:
        if len(named) != 1:
            raise ValueError(f"the scenario has {len(named)} {kind}s: pass case= one of {', '.join(named)}")
        return next(iter(named.values()))
    if name not in named:
        raise ValueError(f"no {kind} {name!r}; {suggestion(name, named)}")
    return named[name]
