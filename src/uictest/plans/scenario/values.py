"""The values of a part or a section of a scenario that a stop can depend on: numbers and settings."""

from collections.abc import Iterator, Mapping
from typing import Final

from pydantic import BaseModel

from uictest.plans.scenario.parts.program_file import ProgramFile
from uictest.plans.scenario.yaml import DEFAULT_SOURCE, SCENARIO_SOURCE, Key, Part, Quantity, Source

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
