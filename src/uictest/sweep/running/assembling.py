"""Records of many cases at once: only what their values touch is worked out anew."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.evaluation import JUDGED_KEYS
from uictest.rig import FRICTION_KEYS, SECTIONS, assemble, friction_laws
from uictest.scenario import Case, Scenario
from uictest.scenario.yaml import dotted
from uictest.sweep.plan.plan import Plan, Value
from uictest.sweep.plan.variation import refusals, varied

_MOST_KEPT: Final = 1_000
"""Results of one facet that are kept from block to block: listed values come again, drawn ones do not."""
Settings = Mapping[str, Sequence[Value]]


@dataclass(frozen=True)
class Facet:
    """A function of a scenario that reads nothing but what lies at, below or above some keys."""

    function: Callable[[Scenario], Any]
    keys: tuple[str, ...]
    """Those of a plan that it depends on."""
    kept: dict[tuple[str, ...], Any] = field(default_factory=dict)

    def of_each(self, variants: Variants) -> list[Any]:
        """Return the function's result for each case."""
        if not self.keys:
            return [self.function(variants.base)] * variants.count
        texts = [[value.text for value in variants.settings[key]] for key in self.keys]
        return [self._result(variants, place, row) for place, row in enumerate(zip(*texts, strict=True))]

    def _result(self, variants: Variants, place: int, texts: tuple[str, ...]) -> Any:
        if texts in self.kept:
            return self.kept[texts]
        result = self.function(variants.at(place))
        # Several threads come here; nothing is ever taken out, so what one has seen stays.
        if len(self.kept) < _MOST_KEPT:
            self.kept[texts] = result
        return result


class Variants:
    """The scenarios of some cases, each made when it is first asked for."""

    def __init__(self, base: Scenario, settings: Settings, count: int) -> None:
        self.base = base
        self.settings = settings
        self.count = count
        self._made: dict[int, Scenario] = {}

    def at(self, place: int) -> Scenario:
        """Return the scenario of one case."""
        if place not in self._made:
            contents = {key: values[place].content for key, values in self.settings.items()}
            self._made[place] = varied(self.base, contents)
        return self._made[place]


@dataclass(frozen=True)
class Block:
    """Some cases of a sweep in numbers.

    `refused` says of each case why it cannot be simulated, empty where it can; `judged_as` is a scenario that
    is judged as the case's own would be.
    """

    indices: NDArray[np.int64]
    ids: list[str]
    settings: Settings
    parameters: NDArray[Any]
    rail: NDArray[np.float64]
    judged_as: list[Scenario]
    refused: list[str]


class Assembler:
    """Turns cases of a plan into records, the same bits as :func:`uictest.rig.assembly.assemble`."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._record = assemble(plan.base)[0]
        touched = [(section, _touching(plan.keys, keys)) for section, keys in SECTIONS.items()]
        self._sections = [Facet(_section_or_reason(each), keys) for each, keys in touched if keys]
        self._rail = Facet(friction_laws, _touching(plan.keys, FRICTION_KEYS))
        self._judged = Facet(_itself, _touching(plan.keys, JUDGED_KEYS))
        self._possible = Facet(_reason_against(plan.keys), plan.keys)

    def block(self, indices: NDArray[np.int64]) -> Block:
        """Return the records of the cases with the given indices."""
        settings, ids = self._plan.settings(indices), self._plan.ids(indices)
        return self.of_settings(indices, ids, settings)

    def of_settings(self, indices: NDArray[np.int64], ids: list[str], settings: Settings) -> Block:
        """Return the records of cases that are given by their ids and values."""
        variants = Variants(self._plan.base.scenario, settings, indices.size)
        refused: list[str] = self._possible.of_each(variants)
        parameters = np.repeat(self._record[None], indices.size)
        for facet in self._sections:
            refused = _filled(parameters, facet.of_each(variants), refused)
        parameters["case_key"] = [zlib.crc32(name.encode()) for name in ids]
        rail = _stacked(self._rail.of_each(variants))
        judged_as = self._judged.of_each(variants)
        return Block(indices, ids, settings, parameters, rail, judged_as, refused)

    def case(self, block: Block, place: int) -> Case:
        """Return a case of a block, as far as judging it needs."""
        parameters = {key: values[place].text for key, values in block.settings.items()}
        base = self._plan.base
        return Case(block.ids[place], block.judged_as[place], base.path, parameters, {})


def _touching(varying: Iterable[str], read: Iterable[str]) -> tuple[str, ...]:
    """The varying keys at, below or above one that is read."""
    return tuple(key for key in varying if any(_related(key, other) for other in read))


def _related(one: str, other: str) -> bool:
    return one == other or one.startswith(f"{other}.") or other.startswith(f"{one}.")


def _section_or_reason(section: Callable[[Scenario], Any]) -> Callable[[Scenario], dict[str, float] | str]:
    def worked_out(scenario: Scenario) -> dict[str, float] | str:
        try:
            return {name: float(value) for name, value in section(scenario)}
        except (ValueError, ArithmeticError) as error:
            return f"{type(error).__name__}: {error}"

    return worked_out


def _reason_against(keys: Iterable[str]) -> Callable[[Scenario], str]:
    listed = tuple(keys)

    def reason(scenario: Scenario) -> str:
        found = next(refusals(scenario, listed), None)
        return "" if found is None else f"{dotted(found.key)}: {found.message}"

    return reason


def _itself(scenario: Scenario) -> Scenario:
    return scenario


def _filled(
    parameters: NDArray[Any], results: Sequence[dict[str, float] | str], refused: Sequence[str]
) -> list[str]:
    """Write results into the records, and return the reasons with those of this section added."""
    reasons = [
        before or (result if isinstance(result, str) else "")
        for before, result in zip(refused, results, strict=True)
    ]
    good = [result for result in results if not isinstance(result, str)]
    places = [place for place, result in enumerate(results) if not isinstance(result, str)]
    for name in good[0] if good else ():
        parameters[name][places] = [result[name] for result in good]
    return reasons


def _stacked(laws: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Friction laws as one array; a law ends where its record says, whatever is behind."""
    stacked = np.zeros((len(laws), 4, max(law.shape[1] for law in laws)))
    for place, law in enumerate(laws):
        stacked[place, :, : law.shape[1]] = law
    return stacked
