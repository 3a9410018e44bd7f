"""Records of many cases at once: only what depends on a case's values is computed for each case."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Config, Controller, ControllerProgram
from uictest.evaluation import JUDGED_KEYS
from uictest.rig import (
    ASSIGNMENTS,
    FRICTION_KEYS,
    WHEELSET_ASSIGNMENTS,
    Assignment,
    assemble,
    assigned,
    controller_config,
    controller_of,
    friction_laws,
)
from uictest.scenario import Case, Scenario
from uictest.scenario.yaml import dotted
from uictest.sweep.plan.controllers import CONTROLLER, programs_of
from uictest.sweep.plan.plan import ParameterValue, Plan
from uictest.sweep.plan.scenario_values import inconsistencies, with_values

_CACHE_SIZE: Final = 1_000
"""Results of one function that are cached from block to block: listed values recur, drawn ones do not."""
Settings = Mapping[str, Sequence[ParameterValue]]
"""The values of each case of a block, by key."""
FieldValues = Mapping[str, float | list[float]]
"""Fields of the parameters -> what they are set to, a list for a table."""


@dataclass(frozen=True)
class CachedFunction:
    """A function of a scenario that reads only what lies at, below or above some keys."""

    function: Callable[[Scenario], Any]
    keys: tuple[str, ...]
    """The swept keys that the result depends on."""
    cache: dict[tuple[str, ...], Any] = field(default_factory=dict)

    def per_case(self, variants: ScenarioVariants) -> list[Any]:
        """Return the function's result for each case."""
        if not self.keys:
            return [self.function(variants.base)] * variants.count
        texts = [[value.text for value in variants.settings[key]] for key in self.keys]
        return [self._result(variants, place, row) for place, row in enumerate(zip(*texts, strict=True))]

    def _result(self, variants: ScenarioVariants, place: int, texts: tuple[str, ...]) -> Any:
        if texts in self.cache:
            return self.cache[texts]
        result = self.function(variants.at(place))
        # Several threads come here; nothing is ever removed, so an entry that one thread saw stays.
        if len(self.cache) < _CACHE_SIZE:
            self.cache[texts] = result
        return result


class ScenarioVariants:
    """The scenarios of some cases, each built when it is first needed."""

    def __init__(self, base: Scenario, settings: Settings, count: int) -> None:
        self.base = base
        self.settings = settings
        self.count = count
        self._scenarios: dict[int, Scenario] = {}

    def at(self, place: int) -> Scenario:
        """Return the scenario of one case."""
        if place not in self._scenarios:
            contents = {key: values[place].content for key, values in self.settings.items()}
            self._scenarios[place] = with_values(self.base, contents)
        return self._scenarios[place]


@dataclass(frozen=True)
class CaseBlock:
    """Some cases of a sweep in numbers.

    `rejections` holds for each case why it cannot be simulated, empty where it can; `judged_as` is a scenario
    that is judged as the case's own would be. `programs` and `configs` are those of controllers from outside,
    None where the controller is built in.
    """

    indices: NDArray[np.int64]
    ids: list[str]
    settings: Settings
    parameters: NDArray[Any]
    wheelset_parameters: NDArray[Any]
    rail: NDArray[np.float64]
    controllers: list[Controller]
    programs: list[ControllerProgram | None]
    configs: list[Config | None]
    judged_as: list[Scenario]
    rejections: list[str]


class BlockAssembler:
    """Converts cases of a plan to records, with the same bits as :func:`uictest.rig.assemble`."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        inputs = assemble(plan.base)
        self._record, self._wheelset_records = inputs.parameters, inputs.wheelset_parameters
        self._parameters = _setters(plan.keys, ASSIGNMENTS)
        self._wheelset_parameters = [_setters(plan.keys, each) for each in WHEELSET_ASSIGNMENTS]
        self._controllers = CachedFunction(controller_of, _related_keys(plan.keys, ("controller.algorithm",)))
        self._programs = CachedFunction(_program_of, _program_keys(plan))
        self._rail = CachedFunction(friction_laws, _related_keys(plan.keys, FRICTION_KEYS))
        self._judged = CachedFunction(_scenario_itself, _related_keys(plan.keys, JUDGED_KEYS))
        self._rejection = CachedFunction(_rejection_of(plan.keys), plan.keys)

    def block(self, indices: NDArray[np.int64]) -> CaseBlock:
        """Return the records of the cases with the given indices."""
        settings, ids = self._plan.settings(indices), self._plan.ids(indices)
        return self.of_settings(indices, ids, settings)

    def of_settings(self, indices: NDArray[np.int64], ids: list[str], settings: Settings) -> CaseBlock:
        """Return the records of cases that are given by their ids and values."""
        variants = ScenarioVariants(self._plan.base.scenario, settings, indices.size)
        rejections: list[str] = self._rejection.per_case(variants)
        parameters = np.repeat(self._record[None], indices.size)
        for values in self._parameters:
            rejections = _fill(parameters, values.per_case(variants), rejections)
        wheelsets = np.repeat(self._wheelset_records[None], indices.size, axis=0)
        for place, setters in enumerate(self._wheelset_parameters):
            for values in setters:
                rejections = _fill(wheelsets[:, place], values.per_case(variants), rejections)
        parameters["case_key"] = [zlib.crc32(name.encode()) for name in ids]
        rail = _stacked(self._rail.per_case(variants))
        programs = self._programs.per_case(variants)
        return CaseBlock(
            *(indices, ids, settings, parameters, wheelsets, rail),
            *(self._controllers.per_case(variants), programs, _configs(programs, parameters, wheelsets)),
            *(self._judged.per_case(variants), rejections),
        )

    def case(self, block: CaseBlock, place: int) -> Case:
        """Return a case of a block, as far as judging it needs."""
        parameters = {key: values[place].text for key, values in block.settings.items()}
        base = self._plan.base
        return Case(block.ids[place], block.judged_as[place], base.path, parameters, {})


def _program_of(scenario: Scenario) -> ControllerProgram | None:
    return scenario.controller.program


def _program_keys(plan: Plan) -> tuple[str, ...]:
    """Return the swept keys that the program depends on: none where all controllers are built in."""
    return _related_keys(plan.keys, (CONTROLLER,)) if any(programs_of(plan)) else ()


def _configs(
    programs: Sequence[ControllerProgram | None], parameters: NDArray[Any], wheelsets: NDArray[Any]
) -> list[Config | None]:
    return [
        None if program is None else controller_config(parameters[place], wheelsets[place], program)
        for place, program in enumerate(programs)
    ]


def _related_keys(swept: Iterable[str], read: Iterable[str]) -> tuple[str, ...]:
    """Return the swept keys at, below or above one that is read."""
    return tuple(key for key in swept if any(_related(key, other) for other in read))


def _related(one: str, other: str) -> bool:
    return one == other or one.startswith(f"{other}.") or other.startswith(f"{one}.")


def _setters(swept: Iterable[str], assignments: Iterable[Assignment]) -> list[CachedFunction]:
    """Group assignments by the swept keys that they depend on, leaving out those that depend on none."""
    groups: dict[tuple[str, ...], list[Assignment]] = {}
    for assignment in assignments:
        if keys := _related_keys(swept, assignment.keys):
            groups.setdefault(keys, []).append(assignment)
    return [CachedFunction(_values_or_reason(group), keys) for keys, group in groups.items()]


def _values_or_reason(assignments: Sequence[Assignment]) -> Callable[[Scenario], FieldValues | str]:
    def fields_or_reason(scenario: Scenario) -> FieldValues | str:
        try:
            return {name: _numbers(value) for name, value in assigned(assignments, scenario).items()}
        except (ValueError, ArithmeticError) as error:
            return f"{type(error).__name__}: {error}"

    return fields_or_reason


def _numbers(value: float | list[float]) -> float | list[float]:
    return value if isinstance(value, list) else float(value)


def _rejection_of(keys: Iterable[str]) -> Callable[[Scenario], str]:
    swept = tuple(keys)

    def rejection(scenario: Scenario) -> str:
        first = next(inconsistencies(scenario, swept), None)
        return "" if first is None else f"{dotted(first.key)}: {first.message}"

    return rejection


def _scenario_itself(scenario: Scenario) -> Scenario:
    return scenario


def _fill(
    parameters: NDArray[Any], results: Sequence[FieldValues | str], rejections: Sequence[str]
) -> list[str]:
    """Write the fields of a group into the records, and return the rejections including its own."""
    reasons = [
        rejection or (result if isinstance(result, str) else "")
        for rejection, result in zip(rejections, results, strict=True)
    ]
    computed = [result for result in results if not isinstance(result, str)]
    places = [place for place, result in enumerate(results) if not isinstance(result, str)]
    for name in computed[0] if computed else ():
        parameters[name][places] = [result[name] for result in computed]
    return reasons


def _stacked(laws: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Return friction laws as one array; the record of a law has its length."""
    stacked = np.zeros((len(laws), 4, max(law.shape[1] for law in laws)))
    for place, law in enumerate(laws):
        stacked[place, :, : law.shape[1]] = law
    return stacked
