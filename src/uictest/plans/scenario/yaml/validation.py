"""Validation of a tree against a model: every error as a diagnostic at its place, with a hint."""

import re
from collections.abc import Iterator
from decimal import Decimal
from typing import Annotated, Any, Final, Generic, TypeVar, get_args, get_origin

from pydantic import BaseModel, ValidationError

from uictest.plans import library
from uictest.plans.scenario.yaml.diagnostics import (
    EXAMPLE_LENGTH,
    Diagnostic,
    ScenarioErrors,
    diagnose,
    longer_name,
    quoted,
    short_example,
    suggestion,
    visible,
)
from uictest.plans.scenario.yaml.model import (
    Key,
    PartReference,
    accepted_keys,
    adapter_of,
    fields_named,
    models_at,
    models_in,
)
from uictest.plans.scenario.yaml.quantities import NUMBER_PATTERN
from uictest.plans.scenario.yaml.tree import List, Node, Scalar, as_written, describe, entry_at, plain

_FEWEST_LETTERS: Final = 3
"""Letters from which on the beginning of a name is taken for it; chosen."""
_DEEPEST: Final = 3
"""Levels of sections that are searched for a key; chosen."""
_WRITTEN = re.compile(rf"\s*({NUMBER_PATTERN})(.*)", re.DOTALL)
_MEANT_BY_WORD: Final = {
    **dict.fromkeys(("on", "true", "yes", "enabled"), ("active", "full", "true")),
    **dict.fromkeys(("off", "false", "no", "disabled"), ("bypassed", "none", "false")),
}


def hint_for_key(model: Any, key: Key, written: Key, node: Node) -> str:
    """Hint for an unknown ``key`` of ``model`` with the value ``node``.

    ``written`` is the key without tags: another member of the union there may have it, which is no place.
    """
    name = str(key[-1])
    accepted = accepted_keys(model, key[:-1])
    radius = name.replace("diameter", "radius")
    halves = (f"half_{name}", *((radius, radius.partition("_")[2]) if radius != name else ()))
    if half := next((half for half in halves if half in accepted), ""):
        number = _WRITTEN.fullmatch(node.text) if isinstance(node, Scalar) else None
        value = "" if number is None else visible(f": {Decimal(number[1]) / 2:f}{number[2]}")
        return f"write `{half}{value}`, half the {visible(name.replace('_', ' '))}"
    longer = longer_name(name, accepted)
    if longer is not None:
        return f"did you mean '{longer}'?"
    places = [".".join(other) for other in _paths_of_key(model, name) if other != written]
    if len(places) == 1:
        return f"did you mean {places[0]}?"
    return f"keys of that name: {', '.join(places)}" if places else suggestion(name, accepted)


def _paths_of_key(model: Any, name: str) -> list[tuple[str, ...]]:
    level: list[tuple[tuple[str, ...], Any]] = [((), each) for each in models_in(model)]
    for _ in range(_DEEPEST):
        paths = [(*above, name) for above, each in level if name in each.model_fields]
        if paths:
            return list(dict.fromkeys(paths))
        level = [
            ((*above, inner), below)
            for above, each in level
            for inner, field in each.model_fields.items()
            if get_origin(field.annotation) not in (dict, tuple)
            for below in models_in(field.annotation)
        ]
    return []


def hint_for_mapping(model: Any, key: Key, name: str, node: Node) -> str:
    """Hint for ``node`` in place of the mapping ``name``: a key that takes the value."""
    named = [*fields_named(model, key[:-1], str(key[-1]))] if key else []
    if named and not any(models_in(field.annotation) for field in named):
        return named[0].description or ""  # its keys are free
    value = as_written(node)
    if value and len(value) <= EXAMPLE_LENGTH:
        for each in models_at(model, key):
            for inner, field in each.model_fields.items():
                if _accepts(field, node):
                    item = "- " if name.isdecimal() else f"{name}: "
                    return visible(f"write `{item}{{{inner}: {value}}}`")
    keys = accepted_keys(model, key)
    return "a mapping of " + ", ".join(sorted(keys)) if keys else ""


_Type = TypeVar("_Type")


class _Alone(BaseModel, Generic[_Type]):
    """A field on its own, in a model since its validators may look at the fields before it."""

    field: _Type


def _accepts(field: Any, node: Node) -> bool:
    """Whether a field accepts a value; free text, which accepts everything, does not count."""
    references = [mark for mark in field.metadata if isinstance(mark, PartReference)]
    if references:
        folder = models_in(references[0].model)[0].folder
        return isinstance(node, Scalar) and node.text in library.names(folder)
    if field.annotation is str or node == Scalar(None, "", node.location):
        return False
    annotation: Any = Annotated[field.annotation, *field.metadata] if field.metadata else field.annotation
    try:
        return _Alone[annotation](field=plain(node)).field is not None
    except ValidationError:
        return False


def validated(model: Any, data: object, tree: Node, prefix: Key = ()) -> Any:
    """``data`` as an instance of ``model``.

    ``tree`` is where ``data`` comes from and ``prefix`` the key of it in the file. Raises ScenarioErrors.
    """
    try:
        return adapter_of(model).validate_python(data)
    except ValidationError as error:
        errors = error.errors(include_url=False)
    raise ScenarioErrors(
        diagnostic for each in errors for diagnostic in _as_diagnostics(each, model, tree, prefix)
    )


def _as_diagnostics(error: Any, model: Any, tree: Node, prefix: Key) -> Iterator[Diagnostic]:
    key: Key = error["loc"]
    context, written = error.get("ctx", {}), _written_key(key, tree)
    if error["type"] == "inconsistency":
        for below, message, hint in context["inconsistencies"]:
            entry, _ = entry_at(tree, (*key, *below))
            yield diagnose(entry.node.location, message, dotted((*prefix, *written, *below)), hint)
    elif error["type"] == "extra_forbidden":
        entry, _ = entry_at(tree, key)
        name, hint = str(key[-1]), hint_for_key(model, key, written, entry.node)
        if "." in name:
            hint = "dotted keys belong in matrix, zip, include, exclude and --set; write nested keys here"
        if name[:1].isdecimal() and entry.node == Scalar(None, "", entry.node.location):
            hint = "numbers have a decimal point: 0.8, not 0,8"
        yield diagnose(entry.key, f"unknown key {quoted(name)}", dotted((*prefix, *written)), hint)
    elif error["type"].startswith("union_tag"):
        yield _unknown_member(key, context, model, tree, prefix)
    elif error["type"] == "missing":
        message = f"missing key {quoted(str(key[-1]))}"
        described = (field.description for field in fields_named(model, key[:-1], str(key[-1])))
        yield _diagnostic_at(key[:-1], message, next(filter(None, described), ""), tree, prefix, key[-1:])
    else:
        node = entry_at(tree, key)[0].node
        message, hint = _message_and_hint(error, context, node)
        hint = _hint_of_shape(error["type"], model, key, (*prefix, *written), node) or hint
        yield _diagnostic_at(key, message, hint, tree, prefix)


def _hint_of_shape(kind: str, model: Any, key: Key, written: Key, node: Node) -> str:
    if kind in _MAPPINGS:
        return hint_for_mapping(model, key, str(written[-1]) if written else "", node)
    if kind == "tuple_type":
        if not written:
            return ""
        return short_example(f"write `{written[-1]}: [{as_written(node)}]`") or "write a list"
    varies = len(written) > len(key) or "matrix" in accepted_keys(model, ())
    if isinstance(node, List) and kind in _SINGLE and varies:
        example = short_example(f": `matrix: {{{dotted(written)}: {as_written(node)}}}`")
        return f"several values go under matrix{example}"
    return ""


def _diagnostic_at(
    key: Key, message: str, hint: str, tree: Node, prefix: Key, beyond: Key = ()
) -> Diagnostic:
    entry, _ = entry_at(tree, key)
    # A missing key is reported at the key of the mapping that lacks it.
    location = entry.key if beyond else entry.node.location
    return diagnose(location, message, dotted((*prefix, *_written_key(key, tree), *beyond)), hint)


def _unknown_member(key: Key, context: dict[str, Any], model: Any, tree: Node, prefix: Key) -> Diagnostic:
    name = context["discriminator"].strip("'")
    choices = sorted(get_args(field.annotation)[0] for field in fields_named(model, key, name))
    if "tag" not in context:
        return _diagnostic_at(
            key, f"missing key {quoted(name)}", f"accepted: {', '.join(choices)}", tree, prefix, (name,)
        )
    tag = str(context["tag"])
    return _diagnostic_at(
        (*key, name), f"unknown {name} {quoted(tag)}", suggestion(tag, choices), tree, prefix
    )


def dotted(key: Key) -> str:
    """The key as written in messages and in ``matrix``: elements joined by dots."""
    return ".".join(map(str, key))


def _written_key(key: Key, tree: Node) -> Key:
    """The key without the tags that a validator puts in for the members of a union."""
    kept: list[str | int] = []
    for count, element in enumerate(key, start=1):
        if entry_at(tree, key[:count])[1] == count:
            kept.append(element)
    return tuple(kept)


def _message_and_hint(error: Any, context: dict[str, Any], node: Node) -> tuple[str, str]:
    kind = error["type"]
    if "message" in context:
        return context["message"], context.get("hint", "")
    if kind == "literal_error":
        choices = context["expected"].replace(" or ", ", ").split(", ")
        return _not_one_of(node, [choice.strip("'") for choice in choices])
    if kind == "string_pattern_mismatch":
        return f"{quoted(str(error['input']))} is not allowed", _pattern_hint(context["pattern"])
    if kind in _BOUNDED:
        bound = context.get("ge", context.get("le"))
        return f"{error['input']} is out of range: it must be {_BOUNDED[kind]} {bound}", ""
    if kind in _COUNTED:
        words, name = _COUNTED[kind]
        return f"{words} {context[name]} {'characters' if 'string' in kind else 'entries'}", ""
    if kind in _EXPECTED:
        text, hint = node.text if isinstance(node, Scalar) else "", ""
        if kind == "string_type" and text:
            # YAML takes 4.2, true and null for what they look like, unless they stand in quotes.
            hint = f'write it in quotes: "{visible(text)}"'
        if kind in ("bool_type", "bool_parsing") and isinstance(node, Scalar):
            hint = _suggested_choices(text, ["true", "false"])
        if kind == "int_type" and text.isdecimal() and node == Scalar(text, text, node.location):
            hint = f"write {text} without quotes"
        shown = f" ({quoted(text)})" if text else ""
        return f"expected {_EXPECTED[kind]}, found {describe(node)}{shown}", hint
    return error["msg"][:1].lower() + error["msg"][1:], ""


def _not_one_of(node: Node, choices: list[str]) -> tuple[str, str]:
    if not isinstance(node, Scalar):
        return f"expected one of {', '.join(choices)}, found {describe(node)}", ""
    hint = _suggested_choices(node.text, choices) or suggestion(node.text, choices)
    message = f"unknown value {quoted(node.text)}, expected one of {', '.join(choices)}"
    return message, hint if hint.startswith("did") else ""


def _suggested_choices(text: str, choices: list[str]) -> str:
    """Return a hint at the choice that a word like `on`, a beginning or a digit means, empty for none."""
    word = text.lower().replace("_", "-").replace("1", "one").replace("4", "four")
    begun = [choice for choice in choices if len(word) >= _FEWEST_LETTERS and choice.startswith(word)]
    meant = (choice for choice in _MEANT_BY_WORD.get(word, ()) if choice in choices)
    choice = next(meant, begun[0] if len(begun) == 1 else "")
    return f"did you mean {quoted(choice)}?" if choice else ""


def _pattern_hint(pattern: str) -> str:
    if pattern.startswith("^[a-z0-9]"):
        return "accepted: a-z, 0-9 and, after the first character, dots, dashes and underscores; at most 100"
    return "control characters are not accepted" if "x00" in pattern else ""


_BOUNDED = {"greater_than_equal": "at least", "less_than_equal": "at most"}
_COUNTED = {
    "too_short": ("too few, at least", "min_length"),
    "too_long": ("too many, at most", "max_length"),
    "string_too_short": ("too short, at least", "min_length"),
    "string_too_long": ("too long, at most", "max_length"),
}
_MAPPINGS = frozenset({"dict_type", "model_type", "model_attributes_type"})
_SINGLE = frozenset({"quantity", "literal_error", "string_type", "int_type"})
"""Kinds of errors of fields that hold one value."""
_EXPECTED = {
    "string_type": "a text",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "tuple_type": "a list",
    "dict_type": "a mapping",
    "model_type": "a mapping",
    "model_attributes_type": "a mapping",
}
