"""Records of many cases at once: only what depends on a case's values is computed for each case."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Config, ControllerProgram
from uictest.core.ensemble import Places
from uictest.judging.evaluation import JUDGED_KEYS
from uictest.plans.scenario import Case, Scenario
from uictest.plans.scenario.yaml import dotted
from uictest.plans.sweeps import CONTROLLER, Plan, inconsistencies, programs_of
from uictest.rig import (
    ASSIGNMENTS,
    FRICTION_KEYS,
    WHEELSET_ASSIGNMENTS,
    Assignment,
    assemble,
    assigned,
    bench,
    controller_config,
    friction_laws,
    noise_keys,
)
from uictest.rig.identification import UnsuitableRecordError
from uictest.running.chunked.scenario_function import (
    Rejected,
    ScenarioFunction,
    ScenarioVariants,
    Settings,
    related_keys,
)

FieldValues = Mapping[str, Any]
"""Fields of the parameters -> what they are set to: a number or a table, for each case or for all."""


@dataclass(frozen=True)
class CaseValues:
    """Some cases of a sweep: their indices, ids and values."""

    indices: NDArray[np.int64]
    ids: list[str]
    settings: Settings


@dataclass(frozen=True)
class CaseBlock(CaseValues):
    """Some cases of a sweep in numbers.

    `rejections` holds for each case why it cannot be simulated, empty where it can; `judged_as` are scenarios
    that are judged as those of the cases would be. `programs` and `configs` are those of controllers from
    outside, None where the controller is built in.
    """

    parameters: NDArray[Any]
    wheelset_parameters: NDArray[Any]
    rail: NDArray[np.float64]
    programs: list[ControllerProgram | None]
    configs: list[Config | None]
    judged_as: ScenarioVariants
    rejections: list[str]

    def take(self, places: Places) -> CaseBlock:
        """Return the cases at some places."""
        numbers = places.tolist()
        return CaseBlock(
            self.indices[places],
            [self.ids[place] for place in numbers],
            {key: column.take(places) for key, column in self.settings.items()},
            self.parameters[places],
            self.wheelset_parameters[places],
            self.rail[places],
            [self.programs[place] for place in numbers],
            [self.configs[place] for place in numbers],
            self.judged_as.take(places),
            [self.rejections[place] for place in numbers],
        )


class BlockAssembler:
    """Converts cases of a plan to records, with the same bits as :func:`uictest.rig.assemble`."""

    def __init__(self, plan: Plan, *, as_base: bool = False) -> None:
        """Take a plan, and whether its cases all meet the noise of the base case and are judged as it is.

        Numbers of parts are read for the words of a reason alone.
        """
        self._plan = plan
        self._noise_of_base = as_base
        base = bench.identified(plan.base)
        self._identifies = bool(related_keys(plan.keys, bench.IDENTIFIED_KEYS)) and (
            base is not plan.base or "rig.compensation_model" in plan.keys
        )
        self._base = plan.base if self._identifies else base
        inputs = assemble(base)
        self._record, self._wheelset_records = inputs.parameters, inputs.wheelset_parameters
        self._parameters = _setters(plan.keys, ASSIGNMENTS)
        self._wheelset_parameters = [_setters(plan.keys, each) for each in WHEELSET_ASSIGNMENTS]
        self._programs = ScenarioFunction(_program_of, _program_keys(plan), by_numbers=True)
        self._rail = ScenarioFunction(friction_laws, related_keys(plan.keys, FRICTION_KEYS))
        self._judged_keys = () if as_base else related_keys(plan.keys, JUDGED_KEYS)
        self._rejection = ScenarioFunction(_rejection_of(plan.keys), plan.keys)

    def block(self, indices: NDArray[np.int64]) -> CaseBlock:
        """Return the records of the cases with the given indices."""
        settings, ids = self._plan.settings(indices), self._plan.ids(indices)
        return self.of_settings(indices, ids, settings)

    def again(self, block: CaseBlock, places: Places) -> CaseBlock:
        """Return the records of the cases at some places of a block that another assembler made."""
        ids = [block.ids[place] for place in places.tolist()]
        settings = {key: column.take(places) for key, column in block.settings.items()}
        return self.of_settings(block.indices[places], ids, settings)

    def of_settings(self, indices: NDArray[np.int64], ids: list[str], settings: Settings) -> CaseBlock:
        """Return the records of cases that are given by their ids and values."""
        variants = ScenarioVariants(self._base.scenario, settings, indices.size)
        rejections = self._rejections(variants)
        parameters = np.repeat(self._record[None], indices.size)
        for setter in self._parameters:
            _fill(parameters, setter.results(variants), rejections)
        wheelsets = np.repeat(self._wheelset_records[None], indices.size, axis=0)
        for place, setters in enumerate(self._wheelset_parameters):
            for setter in setters:
                _fill(wheelsets[:, place], setter.results(variants), rejections)
        if self._identifies:
            self._identify(variants, parameters, rejections)
        rail = _stacked(list(self._rail.results(variants)), indices.size, rejections)
        if not self._noise_of_base:  # else it is that of the base's record
            parameters["noise_key"] = noise_keys(parameters, wheelsets, rail)
        programs = self._programs.per_case(variants)
        return CaseBlock(
            *(indices, ids, settings, parameters, wheelsets, rail),
            *(programs, _configs(programs, parameters, wheelsets)),
            *(self._judged_as(variants), rejections),
        )

    def _identify(self, variants: ScenarioVariants, parameters: NDArray[Any], rejections: list[str]) -> None:
        """Assemble the cases whose compensation is to be identified for a rig that varies, one by one."""
        for place in range(variants.count):
            scenario = variants.at(place)
            if rejections[place] or not scenario.rig.compensation_model.to_identify:
                continue
            try:
                case = bench.identified(replace(self._base, scenario=scenario))
            except UnsuitableRecordError as error:
                rejections[place] = f"rig.compensation_model: {error}"
            else:
                parameters[place] = assemble(case).parameters

    def _rejections(self, variants: ScenarioVariants) -> list[str]:
        rejections = [""] * variants.count
        for places, result in self._rejection.results(variants):
            if result is not None:
                _reject(places, result, rejections)
        return rejections

    def _judged_as(self, variants: ScenarioVariants) -> ScenarioVariants:
        """Return the scenarios as far as they are judged."""
        return ScenarioVariants(
            variants.base, {key: variants.settings[key] for key in self._judged_keys}, variants.count
        )

    def case(self, block: CaseBlock, place: int) -> Case:
        """Return a case of a block, as far as judging it needs."""
        try:
            judged_as = block.judged_as.build(place)
        except KeyError:  # a case that was rejected: one of its values has no place
            judged_as = block.judged_as.base
        return Case(block.ids[place], judged_as, self._plan.base.path, {}, {})


def _program_of(scenario: Scenario) -> ControllerProgram | None:
    return scenario.controller.program


def _program_keys(plan: Plan) -> tuple[str, ...]:
    """Return the swept keys that the program depends on: none where all controllers are built in."""
    return related_keys(plan.keys, (CONTROLLER,)) if any(programs_of(plan)) else ()


def _configs(
    programs: Sequence[ControllerProgram | None], parameters: NDArray[Any], wheelsets: NDArray[Any]
) -> list[Config | None]:
    return [
        None if program is None else controller_config(parameters[place], wheelsets[place], program)
        for place, program in enumerate(programs)
    ]


def _setters(swept: Iterable[str], assignments: Iterable[Assignment]) -> list[ScenarioFunction]:
    """Group assignments by the swept keys that they depend on, leaving out those that depend on none."""
    groups: dict[tuple[str, ...], list[Assignment]] = {}
    for assignment in assignments:
        if keys := related_keys(swept, assignment.keys):
            groups.setdefault(keys, []).append(assignment)
    return [ScenarioFunction(partial(_field_values, group), keys) for keys, group in groups.items()]


def _field_values(assignments: Sequence[Assignment], scenario: Scenario) -> FieldValues:
    return {name: _values(value) for name, value in assigned(assignments, scenario).items()}


def _values(value: float | list[float]) -> Any:
    """Return a number, or the numbers of several cases; of a table with the table along the last axis."""
    return np.stack(np.broadcast_arrays(*value), axis=-1) if isinstance(value, list) else np.asarray(value)


def _rejection_of(keys: Iterable[str]) -> Callable[[Scenario], Rejected | None]:
    swept = tuple(keys)

    def rejection(scenario: Scenario) -> Rejected | None:
        first = next(inconsistencies(scenario, swept), None)
        return None if first is None else Rejected(f"{dotted(first.key)}: {first.message}")

    return rejection


def _fill(
    parameters: NDArray[Any],
    results: Iterable[tuple[Places, FieldValues | Rejected]],
    rejections: list[str],
) -> None:
    """Write the fields of a group into the records, and its rejections where there is none yet."""
    for places, result in results:
        if isinstance(result, Rejected):
            _reject(places, result, rejections)
            continue
        for name, value in result.items():
            parameters[name][places] = value


def _stacked(
    results: Sequence[tuple[Places, NDArray[np.float64] | Rejected]], count: int, rejections: list[str]
) -> NDArray[np.float64]:
    """Return friction laws as one array; the record of a law has its length."""
    longest = max((law.shape[-1] for _, law in results if not isinstance(law, Rejected)), default=1)
    stacked = np.zeros((count, 4, longest))
    for places, law in results:
        if isinstance(law, Rejected):
            _reject(places, law, rejections)
        else:
            stacked[places, :, : law.shape[-1]] = law
    return stacked


def _reject(places: Places, rejected: Rejected, rejections: list[str]) -> None:
    for place in places.tolist():
        rejections[place] = rejections[place] or rejected.reason
