"""The keys that a model accepts, from its annotations: through lists, mappings and unions."""

from collections.abc import Iterator
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel

from uictest.plans.scenario.yaml.model import Key


def accepted_keys(model: Any, key: Key) -> set[str]:
    """The keys that the mapping at ``key`` of a model accepts."""
    names: set[str] = set()
    for each in models_at(model, key):
        names.update(field.alias or name for name, field in each.model_fields.items())
    return names


def fields_named(model: Any, key: Key, name: str) -> Iterator[Any]:
    """Yield the fields called ``name`` of the mapping at ``key`` of a model."""
    for each in models_at(model, key):
        for field_name, field in each.model_fields.items():
            if name in (field_name, field.alias):
                yield field


def models_at(model: Any, key: Key) -> list[Any]:
    """The models that the mapping at ``key`` may be; indices and names in a dict are skipped.

    A tag, which pydantic puts into the key, selects the member of a union.
    """
    here = models_in(model)
    for element in key:
        inner = [
            field.annotation
            for each in here
            for name, field in each.model_fields.items()
            if element in (name, field.alias)
        ]
        within = [inner_model for annotation in inner for inner_model in models_in(annotation)]
        here = within or _members(here, element) or here
    return here


def _members(models: list[Any], tag: str | int) -> list[Any]:
    return [
        each
        for each in models
        if each.tag == tag or any(_is_literal(field.annotation, tag) for field in each.model_fields.values())
    ]


def _is_literal(annotation: Any, value: object) -> bool:
    return get_origin(annotation) is Literal and get_args(annotation) == (value,)


def models_in(annotation: Any) -> list[Any]:
    """The models that an annotation names, however deep."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    if get_origin(annotation) is Literal:
        return []
    return [inner_model for inner in get_args(annotation) for inner_model in models_in(inner)]
