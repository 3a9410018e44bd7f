"""The JSON form of data, as the annotations of their fields say that it is written.

pydantic reads such forms and would write them, too. It makes a validator and a serializer together, of every
class that the data might hold: that takes longer than a stop, whose few classes are written here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Final, NamedTuple, Union, get_args, get_origin, get_type_hints

from pydantic import PlainSerializer, WrapSerializer
from pydantic.fields import FieldInfo

from uictest.judging.evaluation.json_values import finite_or_none

Writer = Callable[[Any], Any]

_UNCHANGED: Final = frozenset({str, int, bool, NoneType})
"""Types of values that are their own form: most of what is written."""


def to_json_form(annotation: Any, value: object) -> Any:
    """Return the JSON form of a value: dicts, lists, text, finite numbers, truth values and None.

    Args:
        annotation: what the value is: a dataclass, a container, an optional value, or one of these with
            pydantic's marks for writing it.
        value: the value.
    """
    return _writer(annotation)(value)


def _writer(annotation: Any) -> Writer:
    """Return what writes a value with this annotation."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _marked(_writer(inner[0]), inner[1:])
    if origin in (Union, UnionType):
        members = [each for each in inner if each is not NoneType]
        return _optional(_writer(members[0])) if len(members) == 1 else _unmarked
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return _mapping(_writer(inner[1]))
    if origin is tuple and inner[1:] != (Ellipsis,):
        return _places(tuple(map(_writer, inner)))
    if isinstance(origin, type) and issubclass(origin, Sequence):
        return _sequence(_writer(inner[0]))
    return _unmarked


def _marked(write: Writer, marks: tuple[Any, ...]) -> Writer:
    for mark in marks:
        if isinstance(mark, PlainSerializer):
            write = mark.func  # type: ignore[assignment]
        elif isinstance(mark, WrapSerializer):
            write = _wrapped(mark.func, write)
    return write


def _wrapped(function: Any, write: Writer) -> Writer:
    return lambda value: function(value, write)


def _optional(write: Writer) -> Writer:
    return lambda value: None if value is None else write(value)


def _mapping(write: Writer) -> Writer:
    return lambda values: {str(key): write(value) for key, value in values.items()}


def _sequence(write: Writer) -> Writer:
    return lambda values: [write(value) for value in values]


def _places(writers: tuple[Writer, ...]) -> Writer:
    return lambda values: [write(value) for write, value in zip(writers, values, strict=True)]


def _unmarked(value: Any) -> Any:
    """Return the form of a value by what it holds."""
    if type(value) in _UNCHANGED:
        return value
    if is_dataclass(value):
        kind: Any = type(value)  # mypy does not take every class for hashable
        return {each.key: each.write(getattr(value, each.name)) for each in _written_fields(kind)}
    if isinstance(value, list | tuple):
        return [_unmarked(item) for item in value]
    if isinstance(value, Mapping):
        return {str(key): _unmarked(item) for key, item in value.items()}
    return finite_or_none(value)


class _WrittenField(NamedTuple):
    name: str
    key: str
    write: Writer


@cache
def _written_fields(record: Any) -> list[_WrittenField]:
    """Return the fields of a dataclass that its form has, in order."""
    annotations = get_type_hints(record, include_extras=True)
    written = []
    for each in fields(record):
        annotation = annotations[each.name]
        marks = [mark for mark in getattr(annotation, "__metadata__", ()) if isinstance(mark, FieldInfo)]
        if not any(mark.exclude for mark in marks):
            key = next((mark.alias for mark in marks if mark.alias), each.name)
            written.append(_WrittenField(each.name, key, _writer(annotation)))
    return written
