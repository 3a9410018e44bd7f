"""One value of a resolved scenario changed, without reading the scenario again."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from uictest.scenario import Scenario
from uictest.scenario.yaml import Inconsistency, Model


def varied(scenario: Scenario, settings: Mapping[str, Any]) -> Scenario:
    """Return the scenario with the values at the dotted keys of `settings` changed, from the outside in.

    Nothing is validated: the values must have been, and their combination is the matter of :func:`refusals`.
    """
    for key in outside_in(settings):
        scenario = _changed(scenario, key.split("."), settings[key])
    return scenario


def outside_in(keys: Iterable[str]) -> list[str]:
    """Return keys in an order in which a part comes before what lies inside it."""
    return sorted(keys, key=lambda key: key.count("."))


def value_at(scenario: Scenario, key: str) -> Any:
    """Return what stands at a dotted key. Raises KeyError where there is no such place."""
    value: Any = scenario
    for element in key.split("."):
        value = _inner(value, element)
    return value


def refusals(scenario: Scenario, keys: Iterable[str]) -> Iterator[Inconsistency]:
    """Yield what is impossible about the values of the models on the way to `keys`, the scenario included."""
    seen: set[tuple[str, ...]] = set()
    for key in keys:
        elements = tuple(key.split("."))
        for depth in range(len(elements)):
            if elements[:depth] not in seen:
                seen.add(elements[:depth])
                yield from _contradictions(scenario, elements[:depth])


def _contradictions(scenario: Scenario, above: tuple[str, ...]) -> Iterator[Inconsistency]:
    model = value_at(scenario, ".".join(above)) if above else scenario
    if isinstance(model, Model):
        for found in model.inconsistencies():
            yield found._replace(key=(*above, *found.key))


def _changed(model: Any, elements: list[str], value: Any) -> Any:
    first, rest = elements[0], elements[1:]
    inner = _changed(_inner(model, first), rest, value) if rest else value
    return {**model, first: inner} if isinstance(model, dict) else model.model_copy(update={first: inner})


def _inner(value: Any, element: str) -> Any:
    if isinstance(value, dict):
        return value[element]
    if isinstance(value, Model) and element in type(value).model_fields:
        return getattr(value, element)
    raise KeyError(element)
