"""Validation of a tree against a model: every error as a diagnostic at its place."""

from collections.abc import Iterator
from functools import cache
from typing import Any, get_args

from pydantic import TypeAdapter, ValidationError

from uictest.plans.scenario.yaml.diagnostics import Diagnostic, ScenarioErrors, diagnose
from uictest.plans.scenario.yaml.hints import (
    hint_for_item,
    hint_for_key,
    hint_for_list,
    hint_for_mapping,
    meant_choice,
)
from uictest.plans.scenario.yaml.model import Key, accepted_keys, fields_named
from uictest.plans.scenario.yaml.tree import (
    Node,
    Scalar,
    Sequence,
    describe,
    entry_at,
    quoted,
    suggestion,
    visible,
)


@cache
def _adapter(model: Any) -> TypeAdapter[Any]:
    return TypeAdapter(model)


def validated(model: Any, data: object, tree: Node, prefix: Key = ()) -> Any:
    """``data`` as an instance of ``model``.

    ``tree`` is where ``data`` comes from and ``prefix`` the key of it in the file. Raises ScenarioErrors.
    """
    try:
        return _adapter(model).validate_python(data)
    except ValidationError as error:
        errors = error.errors(include_url=False)
    raise ScenarioErrors(
        diagnostic for each in errors for diagnostic in _translated(each, model, tree, prefix)
    )


def _translated(error: Any, model: Any, tree: Node, prefix: Key) -> Iterator[Diagnostic]:
    key: Key = error["loc"]
    context = error.get("ctx", {})
    if error["type"] == "inconsistency":
        for inconsistency in context["inconsistencies"]:
            entry, _ = entry_at(tree, (*key, *inconsistency.key))
            written = dotted((*prefix, *_written_key(key, tree), *inconsistency.key))
            yield diagnose(entry.node.place, inconsistency.message, written, inconsistency.hint)
    elif error["type"] == "extra_forbidden":
        yield _unknown_key(key, model, tree, prefix)
    elif error["type"].startswith("union_tag"):
        yield _unknown_member(key, context, model, tree, prefix)
    elif error["type"] == "missing":
        message = f"missing key {quoted(str(key[-1]))}"
        described = (field.description for field in fields_named(model, key[:-1], str(key[-1])))
        yield _at(key[:-1], message, next(filter(None, described), ""), tree, prefix, key[-1:])
    else:
        node = entry_at(tree, key)[0].node
        message, hint = _worded(error, context, node)
        place = (*prefix, *_written_key(key, tree))
        yield _at(key, message, _hint_of_shape(error["type"], model, key, place, node) or hint, tree, prefix)


def _hint_of_shape(kind: str, model: Any, key: Key, written: Key, node: Node) -> str:
    """What to write where a mapping, a list or a single value is expected and something else stands."""
    if kind in _MAPPINGS:
        return hint_for_mapping(model, key, str(written[-1]) if written else "", node)
    if kind == "tuple_type":
        return hint_for_item(written, node)
    varies = len(written) > len(key) or "matrix" in accepted_keys(model, ())
    if isinstance(node, Sequence) and kind in _SINGLE and varies:
        return hint_for_list(dotted(written), node)
    return ""


def _at(key: Key, message: str, hint: str, tree: Node, prefix: Key, beyond: Key = ()) -> Diagnostic:
    entry, _ = entry_at(tree, key)
    # A missing key is reported at the key of the mapping that lacks it.
    place = entry.key if beyond else entry.node.place
    return diagnose(place, message, dotted((*prefix, *_written_key(key, tree), *beyond)), hint)


def _unknown_key(key: Key, model: Any, tree: Node, prefix: Key) -> Diagnostic:
    entry, _ = entry_at(tree, key)
    name = str(key[-1])
    written = _written_key(key, tree)
    hint = hint_for_key(model, key, written, entry.node)
    if "." in name:
        hint = "dotted keys belong in matrix, zip, include, exclude and --set; write nested keys here"
    return diagnose(entry.key, f"unknown key {quoted(name)}", dotted((*prefix, *written)), hint)


def _unknown_member(key: Key, context: dict[str, Any], model: Any, tree: Node, prefix: Key) -> Diagnostic:
    """The discriminator of a union is missing or unknown."""
    name = context["discriminator"].strip("'")
    choices = sorted(get_args(field.annotation)[0] for field in fields_named(model, key, name))
    if "tag" not in context:
        return _at(
            key, f"missing key {quoted(name)}", f"accepted: {', '.join(choices)}", tree, prefix, (name,)
        )
    tag = str(context["tag"])
    return _at((*key, name), f"unknown {name} {quoted(tag)}", suggestion(tag, choices), tree, prefix)


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


def _worded(error: Any, context: dict[str, Any], node: Node) -> tuple[str, str]:
    """Message and hint for an error of a single value."""
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
            hint = _meant(text, ["true", "false"])
        if kind == "int_type" and text.isdecimal():
            hint = f"write {text} without quotes"
        shown = f" ({quoted(text)})" if text else ""
        return f"expected {_EXPECTED[kind]}, found {describe(node)}{shown}", hint
    return error["msg"][:1].lower() + error["msg"][1:], ""


def _not_one_of(node: Node, choices: list[str]) -> tuple[str, str]:
    if not isinstance(node, Scalar):
        return f"expected one of {', '.join(choices)}, found {describe(node)}", ""
    hint = _meant(node.text, choices) or suggestion(node.text, choices)
    message = f"unknown value {quoted(node.text)}, expected one of {', '.join(choices)}"
    return message, hint if hint.startswith("did") else ""


def _meant(text: str, choices: list[str]) -> str:
    choice = meant_choice(text, choices)
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
