"""The plan of a sweep: the values of each case, as a function of the number of the case alone."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from uictest.plans.scenario import CAR, Case, Distribution, Method, Scenario, TrainPlace, wheelset_value
from uictest.plans.scenario.yaml import Quantity, parse_quantity
from uictest.plans.sweeps.base_case import SURVEY_STEP, TIME_STEP, value_at, with_values
from uictest.plans.sweeps.column import Column, ParameterValue, drawn_column, listed_column

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from uictest.controllers import ControllerProgram

    Numbers = NDArray[np.int64]

_OF_CAR: Final = re.compile(rf",{CAR}=\d+\]$")
"""Suffix that distinguishes the id of a car from that of its train."""


@dataclass(frozen=True)
class ListedGroup:
    """Listed rows of values of parameters that change together; usually of one parameter."""

    keys: tuple[str, ...]
    rows: tuple[tuple[ParameterValue, ...], ...]

    @property
    def size(self) -> int:
        """Number of rows."""
        return len(self.rows)

    @property
    def choices(self) -> tuple[tuple[ParameterValue, ...], ...]:
        """The values of each parameter in all rows."""
        return tuple(zip(*self.rows, strict=True))

    def at(self, numbers: Numbers) -> list[Column]:
        """Return the values of each parameter in the rows of the given numbers."""
        return [column.take(numbers) for column in self._columns]

    @cached_property
    def _columns(self) -> list[Column]:
        return [listed_column(choices) for choices in self.choices]

    def labels(self, numbers: Numbers, short: dict[str, str]) -> list[str]:
        """Return the part of a case id for the rows of the given numbers."""
        import numpy as np

        distinct, places = np.unique(numbers, return_inverse=True)
        labels = [
            ",".join(f"{short[key]}={value.label}" for key, value in zip(self.keys, row, strict=True))
            for row in (self.rows[k] for k in distinct.tolist())
        ]
        return [labels[place] for place in places.tolist()]


class ParameterDraw(NamedTuple):
    """The distribution of one parameter: of numbers with a unit, or a choice among values.

    `kind` is the kind of quantity, empty for plain numbers that no part of the rig reads.
    """

    distribution: Distribution
    unit: str = ""
    kind: str = ""
    choices: tuple[ParameterValue, ...] = ()

    def values(self, probabilities: NDArray[np.float64]) -> Column:
        """Return the quantiles for the given probabilities (0 up to 1)."""
        from uictest.plans.sweeps.sampling import quantile  # numpy, which checking a sweep does not need

        numbers = quantile(self.distribution)(probabilities)
        if self.choices:
            return listed_column(self.choices).take(numbers.astype(int))
        return drawn_column(numbers, self.unit, self.kind)


class SampledGroup(NamedTuple):
    """Parameters drawn together, point by point."""

    keys: tuple[str, ...]
    draws: tuple[ParameterDraw, ...]
    method: Method
    size: int
    points: int
    seed: int

    @property
    def choices(self) -> tuple[tuple[ParameterValue, ...], ...]:
        """The values that each parameter is chosen from, none where numbers are drawn."""
        return tuple(draw.choices for draw in self.draws)

    def at(self, numbers: Numbers) -> list[Column]:
        """Return the values of each parameter in the rows of the given numbers."""
        from uictest.plans.sweeps.sampling import points  # numpy, which checking a sweep does not need

        drawn = points(self.method, self.points, len(self.keys), self.seed, numbers)
        return [draw.values(drawn[:, place]) for place, draw in enumerate(self.draws)]

    def labels(self, numbers: Numbers, short: dict[str, str]) -> list[str]:
        """Return the part of a case id for the rows of the given numbers."""
        return [f"sample={k}" for k in numbers.tolist()]


Group = ListedGroup | SampledGroup


@dataclass(frozen=True)
class Plan:
    """All cases of a sweep: every combination of the rows of its groups, those of the first group slowest."""

    name: str
    title: str
    file: str
    """The sweep file, as shown to users."""
    base: Case
    """The case whose values are varied; of a train its first car."""
    groups: tuple[Group, ...]
    short: dict[str, str]
    """The name of each key in case ids."""
    inputs: dict[str, str] = field(default_factory=dict)
    """SHA-256 of every file read, by the name shown to users."""
    survey: bool = False
    """Whether its cases are simulated in survey steps, except where a verdict might hang on it."""
    cases_sha256: str = ""
    """SHA-256 of what the sweep file says of its cases."""
    own_keys: tuple[dict[str, str], ...] = ()
    """For each car of a train what its scenario calls the keys that reach it; the last group is the cars."""

    @property
    def size(self) -> int:
        """Number of cases."""
        return math.prod(group.size for group in self.groups)

    @cached_property
    def keys(self) -> tuple[str, ...]:
        """The dotted keys that vary."""
        return tuple(key for group in self.groups for key in group.keys)

    @cached_property
    def numeric_keys(self) -> tuple[str, ...]:
        """The keys whose values are all numbers, as drawn ones are, which are not listed."""
        choices = (values for group in self.groups for values in group.choices)
        return tuple(
            key
            for key, values in zip(self.keys, choices, strict=True)
            if all(isinstance(value.content, float | int) for value in values)
        )

    def rows(self, indices: Numbers) -> list[Numbers]:
        """Return for each group which of its rows the cases with the given indices have."""
        rows: list[Numbers] = []
        for group in reversed(self.groups):
            rows.append(indices % group.size)
            indices = indices // group.size
        return rows[::-1]

    def settings(self, indices: Numbers) -> dict[str, Column]:
        """Return the values of the cases with the given indices, by key."""
        columns: dict[str, Column] = {}
        for group, rows in zip(self.groups, self.rows(indices), strict=True):
            columns.update(zip(group.keys, group.at(rows), strict=True))
        return columns

    def ids(self, indices: Numbers) -> list[str]:
        """Return the ids of the cases with the given indices: unique, and the same in every run."""
        labels_by_group = [
            group.labels(rows, self.short)
            for group, rows in zip(self.groups, self.rows(indices), strict=True)
        ]
        return [f"{self.name}[{','.join(labels)}]" for labels in zip(*labels_by_group, strict=True)]

    def scenarios(self, contents: Mapping[str, Any]) -> tuple[Scenario, ...]:
        """Return the scenario with other values at dotted keys; of a train those of all cars.

        Nothing is validated, see :func:`~uictest.plans.sweeps.base_case.with_values`. Raises KeyError.
        """
        if self.base.train is None:
            return (with_values(self.base.scenario, contents),)
        # Equal cars share their scenario, so that the rig is assembled for them once.
        changed: dict[int, Scenario] = {}
        cars = self.base.train.scenarios
        for car, own in zip(cars, self.own_keys, strict=True):
            if id(car) not in changed:
                changed[id(car)] = with_values(
                    car, {own[key]: value for key, value in contents.items() if key in own}
                )
        return tuple(changed[id(car)] for car in cars)

    def cases(self, indices: Numbers) -> list[Case]:
        """Return cases with their whole scenarios; neighbours of one train share those of all cars."""
        settings = self.settings(indices)
        names = zip(indices.tolist(), self.ids(indices), strict=True)
        found: list[Case] = []
        train, scenarios = -1, tuple[Scenario, ...]()
        for place, (index, name) in enumerate(names):
            values = {key: column[place] for key, column in settings.items()}
            if train != (train := index // len(self.own_keys or (self.base,))):
                scenarios = self.scenarios({key: value.content for key, value in values.items()})
            car = index % len(scenarios)
            texts = {key: value.text for key, value in values.items()}
            in_train = TrainPlace(_OF_CAR.sub("]", name), car + 1, scenarios) if self.own_keys else None
            found.append(Case(name, scenarios[car], self.base.path, texts, {}, in_train))
        return found

    def listed(self) -> dict[str, tuple[ParameterValue, ...]]:
        """Return the values of every parameter that has a group of its own."""
        return {
            group.keys[0]: group.choices[0]
            for group in self.groups
            if isinstance(group, ListedGroup) and len(group.keys) == 1
        }


def saltelli_sample(plan: Plan) -> SampledGroup | None:
    """Return the sample of a plan that Sobol indices can be computed from, None where there is none."""
    last = plan.groups[-1]
    return last if isinstance(last, SampledGroup) and last.method == "saltelli" else None


def values_of(plan: Plan, key: str) -> tuple[ParameterValue, ...]:
    """Return the values that a plan lists for a key; none where they are drawn, or do not vary."""
    listed = (dict(zip(group.keys, group.choices, strict=True)) for group in plan.groups)
    return next((values[key] for values in listed if key in values), ())


def scenarios_with_each(plan: Plan, key: str) -> Iterator[Scenario]:
    """Yield the base's scenario with each value that sets what stands at `key`; itself where none does."""
    setting = [each for each in plan.keys if f"{key}.".startswith(f"{each}.")]
    for each in setting:
        for value in values_of(plan, each):
            yield with_values(plan.base.scenario, {each: value.content})
    if not setting:
        yield plan.base.scenario


def in_survey_step(case: Case) -> Case:
    """Return a case that is simulated in survey steps, whatever its time step is."""
    return replace(case, scenario=with_values(case.scenario, {TIME_STEP: SURVEY_STEP}))


_OF_WHEELSETS: Final = "vehicle.wheelsets."


class DrawnRange(NamedTuple):
    """The bounds of a distribution, as written, and the value of the scenario itself."""

    key: str
    low: Quantity
    high: Quantity
    nominal: Quantity

    @property
    def contains_nominal(self) -> bool:
        """Whether the scenario's own value can be drawn."""
        return self.low <= self.nominal <= self.high

    def __str__(self) -> str:
        """Return one sentence."""
        lies = "lies inside" if self.contains_nominal else "lies OUTSIDE"
        return (
            f"{self.key}: the scenario's own {self.nominal.text} {lies} the range"
            f" {_quantity_for_people(self.low)} .. {_quantity_for_people(self.high)}"
        )


def drawn_ranges(plan: Plan) -> Iterator[DrawnRange]:
    """Yield the ranges of a sample for sensitivities; a choice from a list has none."""
    sample = saltelli_sample(plan)
    for key, draw in zip(sample.keys, sample.draws, strict=True) if sample else ():
        nominal = _nominal_value(plan.base.scenario, key)
        if not draw.choices and isinstance(nominal, Quantity):
            low, high = (parse_quantity(str(bound), draw.kind) for bound in draw.distribution.bounds)
            yield DrawnRange(key, low, high, nominal)


def _nominal_value(scenario: Scenario, key: str) -> Any:
    value = value_at(scenario, key)
    if value is None and key.startswith(_OF_WHEELSETS):
        number, _, name = key.removeprefix(_OF_WHEELSETS).partition(".")
        return wheelset_value(scenario, int(number), name)
    return value


def _quantity_for_people(quantity: Quantity) -> str:
    number, _, unit = quantity.text.partition(" ")
    return f"{float(number):g} {unit}".rstrip()


def controllers_of(plan: Plan) -> Iterator[tuple[str, Any]]:
    """Yield for each car the key that varies its controller, empty for none, and that of its scenario."""
    train = plan.base.train
    scenarios = (plan.base.scenario,) if train is None else train.scenarios
    own_keys = plan.own_keys or [{key: key for key in plan.keys}] * len(scenarios)
    for scenario, own in zip(scenarios, own_keys, strict=True):
        keys = [key for key in plan.keys if own.get(key) == "controller"]
        yield keys[-1] if keys else "", scenario.controller


def each_controller(plan: Plan) -> Iterator[Any]:
    """Yield the controllers of all cars of all cases, some of them several times."""
    for key, own in controllers_of(plan):
        yield from (value.content for value in values_of(plan, key)) if key else (own,)


def programs_of(plan: Plan) -> Iterator[ControllerProgram]:
    """Yield the program of each controller from outside, with the parameters written with it."""
    for controller in each_controller(plan):
        if controller.program is not None:
            yield controller.program
