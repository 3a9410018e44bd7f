"""Change values of a resolved scenario, without reading the scenario again."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from uictest.plans.scenario import Scenario
from uictest.plans.scenario.yaml import Inconsistency, Model


def with_values(scenario: Scenario, settings: Mapping[str, Any]) -> Scenario:
    """Return the scenario with other values at the dotted keys of `settings`.

    Nothing is validated: the values must be valid, and `inconsistencies` checks their combination.
    """
    for key in outermost_first(settings):
        scenario = _changed(scenario, key.split("."), settings[key])
    return scenario


def outermost_first(keys: Iterable[str]) -> list[str]:
    """Return keys in an order in which a part comes before its parameters."""
    return sorted(keys, key=lambda key: key.count("."))


def value_at(scenario: Scenario, key: str) -> Any:
    """Return the value at a dotted key. Raises KeyError for an unknown key."""
    value: Any = scenario
    for element in key.split("."):
        value = _inner(value, element)
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
    seen: set[tuple[str, ...]] = set()
    for key in keys:
        elements = tuple(key.split("."))
        for depth in range(len(elements)):
            if elements[:depth] not in seen:
                seen.add(elements[:depth])
                yield from _inconsistencies_of(scenario, elements[:depth])


def _inconsistencies_of(scenario: Scenario, path: tuple[str, ...]) -> Iterator[Inconsistency]:
    model = value_at(scenario, ".".join(path)) if path else scenario
    if isinstance(model, Model):
        for inconsistency in model.inconsistencies():
            yield inconsistency._replace(key=(*path, *inconsistency.key))


def _changed(model: Any, elements: list[str], value: Any) -> Any:
    first, rest = elements[0], elements[1:]
    inner = _changed(_inner(model, first), rest, value) if rest else value
    if isinstance(model, tuple):
        if not first.isdecimal():  # the one entry, written without a list
            return (_changed(model[0], elements, value),)
        place = int(first)
        return (*model[:place], inner, *model[place + 1 :])
    return {**model, first: inner} if isinstance(model, dict) else model.model_copy(update={first: inner})


def _inner(value: Any, element: str) -> Any:
    if isinstance(value, dict):
        return value[element]
    if isinstance(value, tuple) and element.isdecimal() and int(element) < len(value):
        return value[int(element)]
    if isinstance(value, tuple) and not element.isdecimal() and len(value) == 1:
        return _inner(value[0], element)  # one entry may be written without a list
    if isinstance(value, Model) and element in type(value).model_fields:
        return getattr(value, element)
    raise KeyError(element)
