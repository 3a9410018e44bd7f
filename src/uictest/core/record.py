"""Records: the numbers that compiled code steps, declared once as a class with annotated fields.

``class Car(Record): speed: float`` declares the fields for the type checker, and :func:`layout_of` derives
the layout in memory from it. A function annotated with ``Car`` is passed a numpy record, a lane of a block,
a record of compiled code or any object with these attributes: annotations are not evaluated.
"""

from collections.abc import Callable, Mapping
from functools import cache
from inspect import get_annotations
from types import MappingProxyType
from typing import Any, NamedTuple, get_args, get_origin, get_type_hints

Conversion = Callable[[float], float]
_KINDS = {float: "f8", int: "i8"}


class Record:
    """Base of the classes that declare records.

    A field is a ``float``, an ``int``, or ``Annotated[MutableSequence[float], n]`` for a table of n numbers.
    """


class ScenarioValue(NamedTuple):
    """A field that holds the value at a key of the scenario.

    Attributes:
        key: dotted key, such as ``vehicle.body.height``.
        convert: what turns that value, in SI units, into the field's; None leaves it as it is.
    """

    key: str
    convert: Conversion | None = None


def from_scenario(key: str, convert: Conversion | None = None) -> Any:
    """Declare that a field of a record holds the value at ``key`` of the scenario."""
    return ScenarioValue(key, convert)


def scenario_values(record: type[Record]) -> dict[str, ScenarioValue]:
    """Return the fields of a record that are declared by :func:`from_scenario`."""
    declared = {name: getattr(record, name, None) for name in fields_of(record)}
    return {name: value for name, value in declared.items() if isinstance(value, ScenarioValue)}


class FieldCopier:
    """Sets the fields of a record in its first argument to those of its second; the kernel has one, too."""

    def __init__(self, record: type[Record]) -> None:
        self.record, self.fields = record, tuple(fields_of(record))

    def __call__(self, target: Any, source: Any) -> None:
        """Copy the fields."""
        for name in self.fields:
            setattr(target, name, getattr(source, name))


class Start(NamedTuple):
    """The number that a field holds before anything is observed."""

    value: float


def starts_at(value: float) -> Any:
    """Declare the number that a field of a record holds before anything is observed."""
    return Start(value)


class FieldStarter:
    """Sets every field of a record that is declared by :func:`starts_at`; the kernel has one, too."""

    def __init__(self, record: type[Record]) -> None:
        declared = {name: getattr(record, name, None) for name in fields_of(record)}
        self.record = record
        self.values = {name: start.value for name, start in declared.items() if isinstance(start, Start)}

    def __call__(self, target: Any) -> None:
        """Set the fields."""
        for name, value in self.values.items():
            setattr(target, name, value)


def channel(unit: str) -> Any:
    """Declare that a field of a record is a channel of a recording, in ``unit``."""
    return unit


def units_of(record: type[Record]) -> tuple[tuple[str, str], ...]:
    """Return the names of a record's channels and their units."""
    return tuple((name, getattr(record, name)) for name in fields_of(record))


def fields_of(record: type[Record]) -> Mapping[str, Any]:
    """Return the annotated fields of a record in the order of their declaration, those of its bases first."""
    declaration: Any = record  # mypy does not take a class for hashable
    return _fields_of(declaration)


@cache
def _fields_of(record: Any) -> Mapping[str, Any]:
    return MappingProxyType(get_type_hints(record, include_extras=True))


def layout_of(record: type[Record], *additions: type[Record]) -> Any:
    """Return the structured dtype (numpy) of a record with the fields of others added.

    What several additions declare is one field. A field of ``record`` itself can only be in an addition when
    both inherit it.

    Raises:
        TypeError: when an addition declares a field that is there already, or a field is not of a known kind.
    """
    import numpy as np  # what only declares records must not pay for it: `uictest check`, `uictest --help`

    fields = {name: (name, *_number_type(name, annotation)) for name, annotation in fields_of(record).items()}
    owners_before = _declaring_classes(record)
    for addition in additions:
        owners = _declaring_classes(addition)
        for name, annotation in fields_of(addition).items():
            field = (name, *_number_type(name, annotation))
            if owners_before.get(name, owners[name]) is not owners[name] or fields.get(name, field) != field:
                raise TypeError(
                    f"{addition.__module__}.{addition.__qualname__}: {name!r} is a field of the rig "
                    "or of another module already; give this one another name"
                )
            fields[name] = field
    return np.dtype((np.record, list(fields.values())))


def _declaring_classes(record: type[Record]) -> dict[str, type]:
    """Return the class that declares each field of a record."""
    return {name: base for base in reversed(record.__mro__) for name in get_annotations(base)}


def _number_type(name: str, annotation: Any) -> tuple[Any, ...]:
    """Return the type of the numbers of a field and, for a table, its shape."""
    if annotation in _KINDS:
        return (_KINDS[annotation],)
    values, *lengths = get_args(annotation) or (None,)
    if get_args(values) != (float,) or len(lengths) != 1 or get_origin(annotation) is None:
        raise TypeError(f"{name}: a field is a float, an int or a table of floats, not {annotation}")
    return ("f8", (lengths[0],))
