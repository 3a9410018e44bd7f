"""The values of a scenario: those that hold for one wheelset, and those of a part."""

from collections.abc import Iterator, Mapping
from operator import attrgetter
from typing import Any, Final

from pydantic import BaseModel

from uictest.plans.scenario.parts.program_file import ProgramFile
from uictest.plans.scenario.parts.wheelsets import NUMBERS, REGULAR
from uictest.plans.scenario.yaml import (
    DEFAULT_SOURCE,
    SCENARIO_SOURCE,
    Key,
    Model,
    Part,
    Quantity,
    Source,
    default,
)

WHEELSET_NUMBERS: Final = tuple(map(int, NUMBERS))
"""Numbers of the wheelsets from the leading end."""
_WHEELSETS: Final = attrgetter("vehicle.wheelsets")
_WHOLE: Final = default("100 %", "share")


def wheelset_value(scenario: Model, number: int, name: str) -> Any:
    """Return a quantity or setting of wheelset ``number`` (1 to 4) by its name below ``vehicle.wheelsets.N``.

    Names are those of :class:`~uictest.plans.scenario.parts.wheelsets.OwnValues`, e.g.
    ``caliper.load_friction``.
    """
    own = attrgetter(name)(_WHEELSETS(scenario)[str(number)])
    return _regular(scenario, name) if own is None else own


def wheelset_keys(number: int, name: str) -> tuple[str, ...]:
    """Return the keys of a scenario that decide a value of a wheelset."""
    own = f"vehicle.wheelsets.{number}.{name}"
    return (own, REGULAR[name]) if name in REGULAR else (own,)


def deciding_key(scenario: Model, number: int, *names: str) -> Key:
    """Return the key of the first value that the wheelset has of its own, else of the first, regular."""
    for name in names:
        if attrgetter(name)(_WHEELSETS(scenario)[str(number)]) is not None:
            return tuple(wheelset_keys(number, name)[0].split("."))
    return tuple(REGULAR[names[0]].split("."))


def distinct_values(scenario: Model, name: str) -> Iterator[tuple[Key, Quantity]]:
    """Yield the values that wheelsets have under a name of `REGULAR` and their keys, the regular one once."""
    written: dict[Key, Quantity] = {}
    for number in WHEELSET_NUMBERS:
        value = wheelset_value(scenario, number, name)
        own, regular = wheelset_keys(number, name)
        written[tuple((regular if value is _regular(scenario, name) else own).split("."))] = value
    yield from written.items()


def _regular(scenario: Model, name: str) -> Any:
    return attrgetter(REGULAR[name])(scenario) if name in REGULAR else _WHOLE


Value = Quantity | str | int | float

DESCRIPTIVE: Final = frozenset(
    {
        *("schema_id", "id", "name", "title", "description", "tags", "extends"),
        *("sources", "source", "clause", "scope", "provenance"),
        *("requirements", "test_case", "validated", "declared_parameters", "free_parameters"),
        *("matrix", "zip", "include", "exclude", "expect", "repeat", "outcome_of_repeats"),
    }
)
"""Fields that a stop cannot depend on: names, sources, expectations, repeats and references to results.

Declarations of a controller's parameters are among them: their defaults stand in `parameters`.
"""


def values_in(value: object, key: Key = ()) -> Iterator[tuple[Key, Value]]:
    """Yield every number and setting inside a model, tuple or mapping with its key.

    A criterion is named by its id. Parts inside are skipped, and so are values that are not set. Beside the
    path of a program stands the SHA-256 of its file.
    """
    if isinstance(value, str | int | float):
        yield key, value
        if isinstance(value, ProgramFile):
            yield (*key[:-1], "sha256"), value.sha256
    elif isinstance(value, BaseModel):
        if key and isinstance(value, Part):
            return
        for name, inner in value:
            if name not in DESCRIPTIVE:
                yield from values_in(inner, (*key, type(value).model_fields[name].alias or name))
    elif isinstance(value, dict):
        for name, inner in value.items():
            yield from values_in(inner, (*key, name))
    elif isinstance(value, tuple):
        for index, inner in enumerate(value):
            yield from values_in(inner, (*key, getattr(inner, "id", index)))


def mark_of(quantity: Quantity, sources: Mapping[str, Source]) -> str:
    """The mark of the source; `user` for a number without one, `default` for a number that the file omits."""
    if quantity.source in sources:
        return sources[quantity.source].mark
    return {SCENARIO_SOURCE: "user", DEFAULT_SOURCE: "default"}[quantity.source]


def is_changed(part: Part) -> bool:
    """Whether a value of a part differs from the part at the root of its `extends`."""
    original = part.original
    return original is not None and dict(values_in(part)) != dict(values_in(original))
