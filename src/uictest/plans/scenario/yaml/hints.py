"""Hints for rejected keys and values: what to write instead."""

import re
from collections.abc import Iterator
from decimal import Decimal
from typing import Annotated, Any, Final, get_origin

from pydantic import ValidationError, create_model

from uictest.plans import library
from uictest.plans.scenario.yaml.model import Key, PartReference, accepted_keys, models_at, models_in
from uictest.plans.scenario.yaml.quantities import NUMBER_PATTERN
from uictest.plans.scenario.yaml.tree import (
    EXAMPLE_LENGTH,
    Node,
    Scalar,
    Sequence as List,
    as_written,
    longer_name,
    plain,
    short_example,
    suggestion,
    visible,
)

_FEWEST_LETTERS: Final = 3
_DEEPEST: Final = 3
"""Levels of sections that are searched for a key."""
_WRITTEN = re.compile(rf"\s*({NUMBER_PATTERN})(.*)", re.DOTALL)
_SWITCHES: Final = {
    "on": ("active", "full", "true"),
    "off": ("bypassed", "none", "false"),
}
_SWITCHED: Final = {
    "true": "on",
    "yes": "on",
    "enabled": "on",
    "false": "off",
    "no": "off",
    "disabled": "off",
}


def hint_for_key(model: Any, key: Key, written: Key, node: Node) -> str:
    """What to write instead of an unknown ``key`` of ``model`` that holds ``node``.

    ``written`` is the key without tags: another member of the union there may have it, which is no place.
    """
    name = str(key[-1])
    accepted = accepted_keys(model, key[:-1])
    half = _half(name, accepted)
    if half:
        value = _halved(node)
        return f"write `{f'{half}: {value}' if value else half}`, half the {visible(name.replace('_', ' '))}"
    longer = longer_name(name, accepted)
    if longer is not None:
        return f"did you mean '{longer}'?"
    places = [".".join(place) for place in _places(model, name) if place != written]
    if len(places) == 1:
        return f"did you mean {places[0]}?"
    return f"keys of that name: {', '.join(places)}" if places else suggestion(name, accepted)


def _half(name: str, accepted: set[str]) -> str:
    """The accepted key that holds half of what ``name`` says: a radius, half a wheelbase."""
    radius = name.replace("diameter", "radius")
    halves = (f"half_{name}", *((radius, radius.partition("_")[2]) if radius != name else ()))
    return next((half for half in halves if half in accepted), "")


def _halved(node: Node) -> str:
    match = _WRITTEN.fullmatch(node.text) if isinstance(node, Scalar) else None
    return "" if match is None else visible(f"{Decimal(match[1]) / 2:f}{match[2]}")


def _places(model: Any, name: str) -> list[tuple[str, ...]]:
    """Where else a model has a key called ``name``: those nearest to its top."""
    level: list[tuple[tuple[str, ...], Any]] = [((), each) for each in models_in(model)]
    for _ in range(_DEEPEST):
        places = [(*above, name) for above, each in level if name in each.model_fields]
        if places:
            return list(dict.fromkeys(places))
        level = [((*above, inner), below) for above, each in level for inner, below in _sections(each)]
    return []


def _sections(model: Any) -> Iterator[tuple[str, Any]]:
    for name, field in model.model_fields.items():
        if get_origin(field.annotation) not in (dict, tuple):
            yield from ((name, each) for each in models_in(field.annotation))


def hint_for_mapping(model: Any, key: Key, name: str, node: Node) -> str:
    """What to write where ``node`` stands in place of the mapping ``name``: a key that takes the value."""
    value = as_written(node)
    if value and len(value) <= EXAMPLE_LENGTH:
        for each in models_at(model, key):
            for inner, field in each.model_fields.items():
                if _accepts(field, node):
                    item = "- " if name.isdecimal() else f"{name}: "
                    return visible(f"write `{item}{{{inner}: {value}}}`")
    keys = accepted_keys(model, key)
    return "a mapping of " + ", ".join(sorted(keys)) if keys else ""


def _accepts(field: Any, node: Node) -> bool:
    """Whether a field accepts a value; free text, which accepts everything, does not count."""
    references = [mark for mark in field.metadata if isinstance(mark, PartReference)]
    if references:
        folder = models_in(references[0].model)[0].folder
        return isinstance(node, Scalar) and node.text in library.names(folder)
    if field.annotation is str or node == Scalar(None, "", node.place):
        return False
    annotation: Any = Annotated[field.annotation, *field.metadata] if field.metadata else field.annotation
    # A model, since validators of fields may look at the fields before theirs.
    alone: Any = create_model("Alone", field=(annotation, ...))
    try:
        return alone(field=plain(node)).field is not None
    except ValidationError:
        return False


def hint_for_list(key: str, node: List) -> str:
    """What to write where several values stand in place of one."""
    return "several values go under matrix" + short_example(f": `matrix: {{{key}: {as_written(node)}}}`")


def hint_for_item(key: Key, node: Node) -> str:
    """What to write where one value stands in place of a list."""
    return (short_example(f"write `{key[-1]}: [{as_written(node)}]`") or "write a list") if key else ""


def meant_choice(text: str, choices: list[str]) -> str:
    """The choice that a word like `on`, a beginning or a digit means, empty where there is none."""
    word = text.lower().replace("_", "-").replace("1", "one").replace("4", "four")
    meant = _SWITCHES.get(_SWITCHED.get(word, word), ())
    begun = [choice for choice in choices if len(word) >= _FEWEST_LETTERS and choice.startswith(word)]
    return next((choice for choice in meant if choice in choices), begun[0] if len(begun) == 1 else "")
